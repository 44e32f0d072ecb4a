#include <beltrami/applications/image_domain.h>

#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/plane/circle_fit.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

TargetCurve curve_of(const std::vector<int>& loop, const std::vector<Complex>& points) {
    if (const CircleFit fit = fit_circle(points); points.size() > 4 && fit.exact())
        return TargetCurve::circle(fit.centre, fit.radius);
    try {
        return TargetCurve::polygon(points);
    } catch (const Error& error) {
        throw Error(
            Cause::bad_boundary,
            "the image of the boundary loop of vertex " + std::to_string(loop[0]) + " bounds nothing: " + error.what(),
            "give a map whose boundary does not meet itself", {Things::vertices, loop});
    }
}

}  // namespace

TargetDomain image_domain(const Surface& source, const Eigen::VectorXcd& map) {
    require_genus_zero(source);
    const auto& loops = source.topology.boundary_loops;
    std::vector<std::vector<Complex>> images;
    std::size_t outer = 0;
    for (const auto& loop : loops) {
        auto& points = images.emplace_back();
        for (const int v : loop) points.push_back(map[v]);
        if (std::abs(signed_area(points)) > std::abs(signed_area(images[outer]))) outer = images.size() - 1;
    }
    std::vector<TargetCurve> holes;
    for (std::size_t l = 0; l < loops.size(); ++l)
        if (l != outer) holes.push_back(curve_of(loops[l], images[l]));
    return target_domain(curve_of(loops[outer], images[outer]), std::move(holes));
}

}  // namespace beltrami
