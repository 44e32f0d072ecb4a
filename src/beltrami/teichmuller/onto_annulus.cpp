#include <beltrami/teichmuller/onto_annulus.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <beltrami/charts/annulus_map.h>
#include <beltrami/teichmuller/direct_map.h>

namespace beltrami {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
/// An edge of a loop with less than this part of the mean increment is crowded.
constexpr double kCrowded = 1e-3;
/// Centres of circles that differ by less, as part of the radius, are one.
constexpr double kConcentric = 1e-9;

bool is_round_ring(const TargetDomain& target) {
    return target.curve_count() == 2 && target.outer.kind() == TargetCurve::Kind::circle &&
           target.holes[0].kind() == TargetCurve::Kind::circle &&
           std::abs(target.outer.centre() - target.holes[0].centre()) < kConcentric * target.outer.radius();
}

bool is_crowded(const AnnulusPotentials& potentials) {
    return std::any_of(potentials.increments.begin(), potentials.increments.end(), [](const auto& loop) {
        const auto crowded = [&](double step) { return std::abs(step) * static_cast<double>(loop.size()) < kCrowded; };
        return std::any_of(loop.begin(), loop.end(), crowded);
    });
}

/// Every vertex' arc length on its circle, ascending, and how much of the curve's area the image encloses.
LoopOnto loop_onto(const Surface& source, int loop, int curve, const TargetCurve& circle,
                   const AnnulusPotentials& potentials, const Eigen::VectorXcd& map) {
    LoopOnto result{loop, curve, {}, 0};
    const std::vector<int>& vertices = source.topology.boundary_loops[loop];
    double at = circle.nearest(map[vertices[0]]), twice = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        result.parameters.push_back(at);
        at += std::abs(potentials.increments[loop][i]) * circle.length();
        twice += std::imag(std::conj(map[vertices[i]] - circle.centre()) *
                           (map[vertices[(i + 1) % vertices.size()]] - circle.centre()));
    }
    result.area_ratio = std::abs(0.5 * twice) / circle.area();
    return result;
}

}  // namespace

std::optional<ExtremalMap> crowded_annulus_onto_ring(const Surface& source, const TargetModel& target,
                                                     const Correspondence& wanted) {
    const TargetDomain& ring = target.domain();
    if (source.topology.boundary_loops.size() != 2 || !is_round_ring(ring) || !wanted.marks.empty() || wanted.waypoints)
        return {};
    std::array<int, 2> curves{};  // of the loops
    curves[1 - wanted.outer_loop] = 1;
    for (const auto& [loop, curve] : wanted.loops)
        if (loop < 0 || loop > 1 || curves[loop] != curve) return {};
    const AnnulusPotentials potentials = annulus_potentials(source, wanted.outer_loop);
    if (!is_crowded(potentials)) return {};

    ExtremalMap result;
    const double outer = ring.outer.radius(), stretch = std::log(outer / ring.holes[0].radius());
    result.map.resize(source.mesh.vertex_count());
    for (Eigen::Index v = 0; v < result.map.size(); ++v)
        result.map[v] =
            ring.outer.centre() + std::polar(outer * std::exp(-stretch * potentials.u[v]), kTwoPi * potentials.v[v]);
    result.distortion = distortion(source.operators, result.map);
    if (!result.distortion.flipped.empty()) return {};
    result.start = result.map;
    complete_direct(source, potentials.u, stretch / (kTwoPi * potentials.v_energy),
                    stretch * potentials.u_energy / kTwoPi, result);
    result.factorizations = 2;
    for (const int loop : {0, 1})
        result.loops.push_back(loop_onto(source, loop, curves[loop], ring.curve(curves[loop]), potentials, result.map));
    return result;
}

}  // namespace beltrami
