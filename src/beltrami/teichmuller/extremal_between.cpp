#include <beltrami/teichmuller/extremal_between.h>

#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/shape.h>

namespace beltrami {

PrescribedTarget prescribed_target(const Surface& source, const Surface& target,
                                   std::span<const std::array<int, 2>> pairs, int outer_loop,
                                   const std::vector<const Shape*>& shapes) {
    require_genus_zero(source);
    require_genus_zero(target);
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (outer_loop < 0 || outer_loop >= loops)
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(outer_loop) + ": the source has " +
                                           std::to_string(loops));
    PrescribedTarget result;
    result.correspondence = boundary_correspondence(source, target, pairs);
    result.circles = circle_domain_of(target, result.correspondence.partner[outer_loop], shapes);
    result.boundary = boundary_on_circles(source, target, result.circles, result.correspondence);
    return result;
}

std::vector<MeshPoint> places_on_target(const Surface& source, const Surface& target, const PrescribedTarget& where,
                                        const Eigen::VectorXcd& map) {
    const std::vector<Complex> images(map.begin(), map.end());
    std::vector<MeshPoint> result = locate_in_chart(target, where.circles.chart.vertices, images);
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            result[loops[l][i]] = mesh_point(target, where.correspondence.places[l][i]);
    return result;
}

ExtremalMapBetween extremal_map_between(const Surface& source, const Surface& target,
                                        std::span<const std::array<int, 2>> pairs, const Correspondence& wanted,
                                        const ExtremalOptions& options) {
    options.validate();
    ExtremalMapBetween result;
    result.target = prescribed_target(source, target, pairs, wanted.outer_loop, options.shapes);
    Constraints constraints(result.target.boundary);
    constraints.correspondence = wanted;
    result.plane = extremal_map(source, constraints, options);
    result.plane.factorizations += result.target.circles.factorizations;
    for (Bound& bound : result.plane.bounds) bound.rigorous = false;
    result.plane.K_lower_proved = 1;
    append(result.plane.warnings, result.target.circles.chart.warnings);
    result.places = places_on_target(source, target, result.target, result.plane.map);
    result.positions = positions_on(target.mesh, result.places);
    return result;
}

}  // namespace beltrami
