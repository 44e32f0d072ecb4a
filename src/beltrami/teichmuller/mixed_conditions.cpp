#include <beltrami/teichmuller/mixed_conditions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>

#include <beltrami/base/error.h>
#include <beltrami/mesh/boundary_position.h>
#include <beltrami/starts/loop_partners.h>

namespace beltrami {

namespace {

/// The loop on which a vertex lies.
int loop_of(const Surface& source, int vertex) {
    if (const auto at = boundary_position(source.topology, vertex)) return at->loop;
    throw Error(Cause::bad_boundary, "vertex " + std::to_string(vertex) + ", the end of an arc, is not on the boundary",
                "an arc runs along a boundary loop from one of its vertices to another", {Things::vertices, {vertex}});
}

/// Whether every vertex of a loop is prescribed.
std::vector<char> wholly_prescribed(const Surface& source, const BoundaryCondition& prescribed) {
    std::vector<char> is_prescribed(source.mesh.vertex_count(), 0);
    for (const int v : prescribed.vertices) is_prescribed[v] = 1;
    std::vector<char> result;
    result.reserve(source.topology.boundary_loops.size());
    for (const auto& loop : source.topology.boundary_loops)
        result.push_back(std::all_of(loop.begin(), loop.end(), [&](int v) { return is_prescribed[v]; }));
    return result;
}

/// Holes that are prescribed take the places of the target's holes to which their images are nearest.
std::vector<std::array<int, 2>> nearest_curves(const Surface& source, const TargetDomain& target,
                                               const BoundaryCondition& prescribed, int outer_loop) {
    struct Pair {
        double distance;
        std::array<int, 2> loop_and_curve;
    };
    const std::vector<char> wholly = wholly_prescribed(source, prescribed);
    std::vector<Complex> image(source.mesh.vertex_count());
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i) image[prescribed.vertices[i]] = prescribed.images[i];
    std::vector<Pair> pairs;
    for (std::size_t l = 0; l < wholly.size(); ++l) {
        if (!wholly[l] || static_cast<int>(l) == outer_loop) continue;
        for (int c = 1; c < target.curve_count(); ++c) {
            const TargetCurve& curve = target.curve(c);
            double distance = 0;
            for (const int v : source.topology.boundary_loops[l])
                distance += std::abs(curve.point(curve.nearest(image[v])) - image[v]);
            pairs.push_back(
                {distance / static_cast<double>(source.topology.boundary_loops[l].size()), {static_cast<int>(l), c}});
        }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return std::tie(a.distance, a.loop_and_curve) < std::tie(b.distance, b.loop_and_curve);
    });
    std::vector<std::array<int, 2>> result;
    for (const Pair& pair : pairs) {
        const std::array<int, 2>& next = pair.loop_and_curve;
        if (std::none_of(result.begin(), result.end(),
                         [&](const auto& taken) { return taken[0] == next[0] || taken[1] == next[1]; }))
            result.push_back(next);
    }
    return result;
}

/// The curve of the target for every loop.
std::vector<int> partners(const Surface& source, const TargetDomain& target, const BoundaryCondition& prescribed,
                          const Correspondence& wanted, double edge_length) {
    const std::size_t loops = source.topology.boundary_loops.size();
    if (loops == 1 && target.curve_count() == 1) return {0};
    const auto model = target_model(target, edge_length_for(source, target, edge_length));
    return loop_partners(source, circle_domain_chart(source, wanted.outer_loop), *model, wanted,
                         nearest_curves(source, target, prescribed, wanted.outer_loop))
        .curves;
}

}  // namespace

MixedConditions mixed_conditions(const Surface& source, const Constraints& constraints, double edge_length) {
    require_genus_zero(source);
    validate(constraints, source);
    validate(constraints.prescribed, source);
    const Correspondence& wanted = constraints.correspondence;
    if (constraints.surface())
        throw Error(Cause::bad_option, "conditions mix for targets in the plane only, not for a surface",
                    "give its circle domain as the target");
    if (!wanted.turns.empty() || wanted.waypoints)
        throw Error(Cause::bad_option, "turns and waypoints are given where boundaries slide in part",
                    "the class is that of the start: leave them out");
    MixedConditions result;
    result.outer_loop = wanted.outer_loop;
    result.prescribed = constraints.prescribed;
    result.arcs = constraints.arcs;
    result.curves.resize(source.topology.boundary_loops.size());
    std::vector<char> slides = wholly_prescribed(source, constraints.prescribed);
    for (char& one : slides) one = !one;
    for (const SlidingArc& arc : constraints.arcs) {
        const int loop = loop_of(source, arc.first);
        slides[loop] = 1;
        if (arc.along) result.curves[loop] = arc.along;
    }
    if (const TargetDomain* target = constraints.domain()) {
        const std::vector<int> curves = partners(source, *target, constraints.prescribed, wanted, edge_length);
        for (std::size_t l = 0; l < slides.size(); ++l)
            if (slides[l] && !result.curves[l]) result.curves[l] = target->curve(curves[l]);
        for (const Mark& mark : wanted.marks) {
            const CurveParameter& place = on_curve(mark);
            result.prescribed.pin(mark.vertex, target->curve(place.curve).point(place.parameter));
        }
    }
    for (std::size_t l = 0; l < slides.size(); ++l)
        if (slides[l] && !result.curves[l])
            throw Error(Cause::bad_boundary,
                        "boundary loop " + std::to_string(l) + " slides, in part at least, and has no curve",
                        "give a target, or the curve of its arcs",
                        {Things::vertices, {source.topology.boundary_loops[l][0]}});
    return result;
}

}  // namespace beltrami
