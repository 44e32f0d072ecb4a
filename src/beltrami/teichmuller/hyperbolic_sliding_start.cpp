#include <beltrami/teichmuller/hyperbolic_sliding_start.h>

#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/forms/homology.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/hyperbolic_places.h>
#include <beltrami/hyperbolic/marking.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/starts/given_start.h>
#include <beltrami/targets/target_mesh.h>

namespace beltrami {

namespace {

/// Of the largest displacement in a step: a start need not be exact.
constexpr double kHyperbolicSlidingTolerance = 1e-3;

Positions in_space(const Eigen::VectorXcd& points) {
    Positions result = Positions::Zero(points.size(), 3);
    result.col(0) = points.real();
    result.col(1) = points.imag();
    return result;
}

/// The harmonic map onto a mesh of the target in the class of a map to points near it.
Eigen::VectorXcd harmonic_onto(const Surface& source, const Surface& target, const Eigen::VectorXcd& near) {
    const HyperbolicSurface to = hyperbolic_surface(target), from = hyperbolic_surface(source);
    const HomologyBasis homology = homology_basis(target);
    const EdgeGroup group{to.original, to.steps, target.topology, homology};
    const Marking marking = marking_by_vertices(
        source, from.original, group,
        nearest_vertices(source.topology, target.topology, target.mesh, to.metric.triangles, in_space(near)));
    EquivariantMapStep step(source, marking.map);
    step.relax(kHyperbolicSlidingTolerance);
    const std::vector<MeshPoint> places = places_of(to, step.map());
    Eigen::VectorXcd result = Eigen::VectorXcd::Zero(near.size());
    for (std::size_t v = 0; v < places.size(); ++v)
        for (int k = 0; k < 3; ++k) {
            const auto corner = target.mesh.positions.row(places[v].vertices[k]);
            result[static_cast<Eigen::Index>(v)] += places[v].barycentric[k] * Complex(corner[0], corner[1]);
        }
    return result;
}

}  // namespace

std::optional<SlidingStart> hyperbolic_sliding_start(const Surface& source, const TargetModel& target,
                                                     const SlidingStart& even, double edge_length) {
    if (source.topology.boundary_loops.size() < 3) return {};
    for (int f = 0; f < source.mesh.face_count(); ++f)
        if (source.mesh.faces.degree(f) != 3) return {};
    try {
        const Surface onto(target_mesh(target.domain(), {.edge_length = edge_length}).mesh);
        Correspondence pairs;
        for (std::size_t l = 0; l < even.curves.size(); ++l)
            pairs.loops.push_back({static_cast<int>(l), even.curves[l]});
        SlidingStart result = given_start(source, target.domain(), harmonic_onto(source, onto, even.map), pairs);
        if (!distortion(source.operators, result.map).flipped.empty()) return {};
        result.move = even.move;
        result.flips = even.flips;
        result.factorizations = even.factorizations;
        return result;
    } catch (const Error& error) {
        if (error.cause() == Cause::cancelled) throw;
        return {};  // folds have spoiled the class, or the meshes are too coarse
    }
}

}  // namespace beltrami
