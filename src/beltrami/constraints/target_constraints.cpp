#include <beltrami/constraints/target_constraints.h>

#include <limits>
#include <string>
#include <utility>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

Eigen::Vector3d point_of(const Positions& points, int v) {
    return {points(v, 0), points(v, 1), points.cols() > 2 ? points(v, 2) : 0.0};
}

/// The curve of least mean squared distance from the vertices of a loop.
int nearest_curve(const SlideCurves& curves, const std::vector<int>& loop, const Positions& start) {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < curves.size(); ++c) {
        double sum = 0;
        for (const int v : loop) {
            const Eigen::Vector3d point = point_of(start, v);
            sum += (curves[c]->point(curves[c]->nearest(point)) - point).squaredNorm();
        }
        if (sum < least) {
            least = sum;
            best = static_cast<int>(c);
        }
    }
    return best;
}

}  // namespace

void TargetConstraints::slide(const std::vector<int>& loop, std::shared_ptr<const SlideCurve> curve) {
    const auto index = static_cast<int>(curves.size());
    curves.push_back(std::move(curve));
    for (const int v : loop) sliding.push_back({v, index});
}

void validate(const TargetConstraints& constraints, const Surface& source) {
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    const auto hold = [&](int vertex) {
        const std::string name = "vertex " + std::to_string(vertex);
        if (vertex < 0 || vertex >= source.mesh.vertex_count())
            throw Error(Cause::bad_boundary, name + " is held, but the source has only " +
                                                 std::to_string(source.mesh.vertex_count()) + " vertices");
        if (held[vertex]++)
            throw Error(Cause::bad_boundary, name + " is held twice", "let it stay or slide along one curve",
                        {Things::vertices, {vertex}});
    };
    for (const int v : constraints.fixed) hold(v);
    for (const TargetConstraints::Slide& slide : constraints.sliding) {
        hold(slide.vertex);
        if (slide.curve < 0 || slide.curve >= static_cast<int>(constraints.curves.size()))
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(slide.vertex) + " is to slide along curve " +
                            std::to_string(slide.curve) + " of " + std::to_string(constraints.curves.size()),
                        {}, {Things::vertices, {slide.vertex}});
    }
}

void slide_boundary(TargetConstraints& constraints, const Surface& source, const Target& target,
                    const Positions& start) {
    const SlideCurves curves = target.boundary();
    const auto& loops = source.topology.boundary_loops;
    if (curves.empty() && !loops.empty())
        throw Error(Cause::bad_boundary, "the target has no boundary along which that of the source could slide");
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : constraints.fixed) held[v] = 1;
    for (const TargetConstraints::Slide& slide : constraints.sliding) held[slide.vertex] = 1;
    std::vector<int> loop_of(curves.size(), -1);
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const int c = nearest_curve(curves, loops[l], start);
        if (loop_of[c] >= 0)
            throw Error(
                Cause::bad_boundary,
                "boundary loops " + std::to_string(loop_of[c]) + " and " + std::to_string(l) +
                    " of the source are nearest to the same curve of the target's boundary, " + std::to_string(c),
                "give a start that takes them to different ones", {Things::loops, {loop_of[c], static_cast<int>(l)}});
        loop_of[c] = static_cast<int>(l);
        std::vector<int> free;
        for (const int v : loops[l])
            if (!held[v]) free.push_back(v);
        constraints.slide(free, curves[c]);
    }
}

TargetMap target_map(const Surface& source, const Target& target, const TargetConstraints& constraints,
                     const Positions& start) {
    validate(constraints, source);
    if (start.rows() != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(start.rows()) + " points, the source " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    TargetMap map{nearest_points(target, start), {}};
    for (const TargetConstraints::Slide& slide : constraints.sliding) {
        const SlideCurve& curve = *constraints.curves[slide.curve];
        const double s = curve.nearest(map.points[slide.vertex].position);
        map.points[slide.vertex] = target.nearest(curve.point(s));
        map.parameters.push_back(s);
    }
    return map;
}

}  // namespace beltrami
