#include <beltrami/registration/natural_start.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/flow/flow_start.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/registration/nearest_places.h>
#include <beltrami/registration/register_curves.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami {

namespace {

/// A source whose vertices are no further from the target, in parts of its size, lies on it.
constexpr double kOnTarget = 1e-6;
constexpr int kLeastLevel = 4, kMostLevel = 6;  // of the mesh of the sphere on which curves are cut

bool lies_on(const Mesh& source, const Target& target) {
    const Target::Points nearest = nearest_points(target, source.positions);
    const Positions& points = source.positions;
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    for (int v = 0; v < source.vertex_count(); ++v)
        if ((nearest[v].position - source.point(v)).norm() > kOnTarget * size) return false;
    return true;
}

/// Of a surface of genus 1 on a torus: the shorter loop of its lattice goes around the small circle.
Positions around(const ParametricTarget& torus, const FlatTorus& flat) {
    Positions start(flat.lattice.rows(), 3);
    for (Eigen::Index v = 0; v < start.rows(); ++v)
        start.row(v) = torus.at(-flat.lattice(v, 1), flat.lattice(v, 0)).position;
    return start;
}

Positions in_plane(const Eigen::VectorXcd& map) {
    Positions start(map.size(), 2);
    start << map.real(), map.imag();
    return start;
}

bool is_sphere(const Topology& topology) {
    return topology.components == 1 && topology.genus == 0 && topology.boundary_loops.empty();
}

bool has_holes(const Topology& topology) {
    return topology.components == 1 && topology.genus == 0 && !topology.boundary_loops.empty();
}

/// Curves of a target as those of a mesh that lies on it.
std::vector<CurvePair> pairs_on(const Mesh& mesh, std::span<const CurveOnto> curves) {
    std::vector<CurvePair> pairs;
    for (const CurveOnto& curve : curves) {
        CurvePair pair{curve.source, {{}, curve.source.closed}, curve.slides};
        Positions points(static_cast<Eigen::Index>(curve.target.size()), 3);
        for (std::size_t i = 0; i < curve.target.size(); ++i)
            points.row(static_cast<Eigen::Index>(i)) = curve.target[i].position;
        for (const NearestPlace& near : nearest_places(mesh, points)) pair.target.points.push_back(near.place);
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

/// The map of least L² norm that takes curves to curves, by way of the target's sphere or circle domain, of the source
/// divided along them; nothing where it stays folded.
std::optional<NaturalStart> cut_along(const Surface& source, const Surface& target, const std::vector<CurvePair>& pairs,
                                      const char* name) {
    try {
        LpRegistration found = register_least_lp(source, target, {}, pairs);
        return NaturalStart{positions_on(target.mesh, found.divided), name, std::move(found.source)};
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
        return {};
    }
}

std::optional<NaturalStart> of_sphere(const Surface& source, const Target& target, const TargetKind& kind,
                                      std::span<const CurveOnto> curves) {
    const bool round = dynamic_cast<const SphereTarget*>(&target) != nullptr;
    if (kind.surface && is_sphere(kind.surface->topology)) {
        if (!curves.empty())
            if (auto cut = cut_along(source, *kind.surface, pairs_on(kind.surface->mesh, curves), "cut along curves"))
                return cut;
        return NaturalStart{register_spheres(source, *kind.surface, {}).positions, "conformal"};
    }
    const std::optional<Eigen::Vector3d> axes = round ? std::optional(Eigen::Vector3d(1, 1, 1)) : kind.half_axes;
    if (!axes) return {};
    if (!curves.empty()) {
        int level = kLeastLevel;
        while (level < kMostLevel && (20 << (2 * level)) < source.mesh.face_count()) ++level;
        Mesh mesh = icosahedral_sphere(level);
        mesh.positions = mesh.positions * axes->asDiagonal();
        const Surface sphere(std::move(mesh));
        if (auto cut = cut_along(source, sphere, pairs_on(sphere.mesh, curves), "cut along curves")) return cut;
    }
    return NaturalStart{sphere_map(source).positions * axes->asDiagonal(), "conformal"};
}

/// Of a ring, on a cylinder: by the logarithm of its conformal annulus.
Positions rolled_up(const ParametricTarget& cylinder, const Surface& source) {
    const CircleDomainChart chart = circle_domain_chart(source);
    const double module = -std::log(chart.holes[0].radius);
    const SlideCurves rims = cylinder.boundary();
    const Eigen::Vector3d low = rims[0]->point(0), high = rims[1]->point(0);
    Positions start(source.mesh.vertex_count(), 3);
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        const Complex z = chart.chart.vertices[v] - chart.holes[0].centre;
        const double part = std::clamp(std::log(std::abs(z)) / -module, 0.0, 1.0), angle = std::arg(z);
        const double radius = low.head<2>().norm();
        start.row(v) << radius * std::cos(angle), radius * std::sin(angle), low.z() + part * (high.z() - low.z());
    }
    return start;
}

std::optional<NaturalStart> of_holes(const Surface& source, const Target& target, const TargetKind& kind,
                                     std::span<const CurveOnto> curves) {
    const std::size_t loops = source.topology.boundary_loops.size();
    if (kind.surface && has_holes(kind.surface->topology) && kind.surface->topology.boundary_loops.size() == loops) {
        if (!curves.empty())
            if (auto led = cut_along(source, *kind.surface, pairs_on(kind.surface->mesh, curves), "led along curves"))
                return led;
        return NaturalStart{register_open(source, *kind.surface, {}).positions, "conformal"};
    }
    if (kind.domain) {
        if (kind.domain->curve_count() != static_cast<int>(loops)) return {};
        return NaturalStart{in_plane(flow_start(source, *kind.domain).map), "harmonic"};
    }
    if (dynamic_cast<const PlaneTarget*>(&target))
        return NaturalStart{in_plane(circle_domain_chart(source).chart.vertices), "conformal"};
    const auto* cylinder = dynamic_cast<const ParametricTarget*>(&target);
    if (cylinder && cylinder->boundary().size() == 2 && loops == 2)
        return NaturalStart{rolled_up(*cylinder, source), "conformal"};
    return {};
}

}  // namespace

NaturalStart natural_start(const Surface& source, const Target& target, const TargetKind& kind,
                           std::span<const CurveOnto> curves) {
    const Topology& topology = source.topology;
    if (lies_on(source.mesh, target)) return {source.mesh.positions, "identity"};
    std::optional<NaturalStart> start;
    if (is_sphere(topology)) start = of_sphere(source, target, kind, curves);
    if (has_holes(topology)) start = of_holes(source, target, kind, curves);
    const auto* torus = dynamic_cast<const ParametricTarget*>(&target);
    if (topology.components == 1 && topology.genus == 1 && topology.boundary_loops.empty() && torus &&
        torus->boundary().empty())
        start = NaturalStart{around(*torus, flat_torus(source)), "lattice"};
    if (start) return std::move(*start);
    throw Error(Cause::bad_option,
                "the flow needs a start: the source does not lie on the target, and has not its topology where one is "
                "known",
                "give a start map: a mesh of the source's faces whose vertices stand near their images");
}

HeldCurves held_curves(const Mesh& source, const Target& target, std::span<const CurveOnto> curves,
                       NaturalStart start) {
    return start.source ? held_curves(std::move(*start.source), target, curves, start.positions)
                        : held_curves(source, target, curves, start.positions);
}

}  // namespace beltrami
