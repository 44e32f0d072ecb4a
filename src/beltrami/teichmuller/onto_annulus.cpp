#include <beltrami/teichmuller/onto_annulus.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/teichmuller/direct_map.h>

namespace beltrami {

namespace {

/// An edge of a loop with less than this part of the mean increment is crowded.
constexpr double kCrowdedIncrement = 1e-3;
/// Centres of circles that differ by less, as part of the radius, are one.
constexpr double kConcentric = 1e-9;

bool is_ring_of_circles(const TargetDomain& target) {
    return target.curve_count() == 2 && target.outer.kind() == TargetCurve::Kind::circle &&
           target.holes[0].kind() == TargetCurve::Kind::circle;
}

bool is_concentric(const TargetDomain& target) {
    return std::abs(target.outer.centre() - target.holes[0].centre()) < kConcentric * target.outer.radius();
}

/// A ring between two circles as the image of one between concentric ones, the outer one of radius 1, under a Möbius
/// map.
struct ConcentricRing {
    Complex centre, turn = 1;      ///< of the ring, and the direction of its hole
    double size, inner, move = 0;  ///< its outer radius, the concentric ring's inner one, and where its centre goes
    Complex place(Complex w) const { return centre + size * turn * (w + move) / (1.0 + move * w); }
};
ConcentricRing concentric_ring(const TargetDomain& target) {
    const Complex away = (target.holes[0].centre() - target.outer.centre()) / target.outer.radius();
    const double hole = target.holes[0].radius() / target.outer.radius(), distance = std::abs(away);
    ConcentricRing result{target.outer.centre(), 1, target.outer.radius(), hole, 0};
    if (is_concentric(target)) return result;
    // (w − b)/(1 − bw) takes the ends of the hole's diameter to ±inner: b² s − 2b (1 + p) + s = 0.
    const double p = (distance + hole) * (distance - hole), s = 2 * distance;
    result.turn = away / distance;
    result.move = s / (1 + p + std::sqrt((1 + p - s) * (1 + p + s)));
    result.inner = (distance + hole - result.move) / (1 - result.move * (distance + hole));
    return result;
}

bool is_crowded(const AnnulusPotentials& potentials) {
    return std::any_of(potentials.increments.begin(), potentials.increments.end(), [](const auto& loop) {
        const auto crowded = [&](double step) {
            return std::abs(step) * static_cast<double>(loop.size()) < kCrowdedIncrement;
        };
        return std::any_of(loop.begin(), loop.end(), crowded);
    });
}

/// Every vertex' arc length on its circle, ascending, and how much of the curve's area the image encloses.
LoopOnto loop_onto(const Surface& source, int loop, int curve, const TargetCurve& circle, const Eigen::VectorXcd& map) {
    LoopOnto result{loop, curve, {}, 0};
    const std::vector<int>& vertices = source.topology.boundary_loops[loop];
    double at = circle.nearest(map[vertices[0]]), twice = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Complex here = map[vertices[i]] - circle.centre(),
                      next = map[vertices[(i + 1) % vertices.size()]] - circle.centre();
        result.parameters.push_back(at);
        at += std::abs(std::arg(next * std::conj(here))) * circle.radius();
        twice += std::imag(std::conj(here) * next);
    }
    result.area_ratio = std::abs(0.5 * twice) / circle.area();
    return result;
}

std::optional<ExtremalMap> direct_map(const Surface& source, const TargetModel& target, const Correspondence& wanted,
                                      bool only_crowded, const ModulusBracket* of_target) {
    const TargetDomain& ring = target.domain();
    if (source.topology.boundary_loops.size() != 2 || !is_ring_of_circles(ring) || !wanted.marks.empty() ||
        wanted.waypoints)
        return {};
    std::array<int, 2> curves{};  // of the loops
    curves[1 - wanted.outer_loop] = 1;
    for (const auto& [loop, curve] : wanted.loops)
        if (loop < 0 || loop > 1 || curves[loop] != curve) return {};
    const AnnulusPotentials potentials = annulus_potentials(source, wanted.outer_loop);
    if (only_crowded && !is_crowded(potentials)) return {};

    ExtremalMap result;
    const ConcentricRing concentric = concentric_ring(ring);
    const double stretch = -std::log(concentric.inner);
    result.map.resize(source.mesh.vertex_count());
    for (Eigen::Index v = 0; v < result.map.size(); ++v)
        result.map[v] = concentric.place(std::polar(std::exp(-stretch * potentials.u[v]), kTurn * potentials.v[v]));
    result.distortion = distortion(source.operators, result.map);
    if (!result.distortion.flipped.empty()) return {};
    result.start = result.map;
    const ModulusBracket modulus = of_target ? *of_target : ModulusBracket{stretch / kTurn, stretch / kTurn};
    complete_direct(source, potentials.u, modulus.lower / potentials.v_energy, modulus.upper * potentials.u_energy,
                    result);
    result.factorizations = 2 + modulus.factorizations;
    for (const int loop : {0, 1})
        result.loops.push_back(loop_onto(source, loop, curves[loop], ring.curve(curves[loop]), result.map));
    return result;
}

}  // namespace

std::optional<ExtremalMap> crowded_annulus_onto_ring(const Surface& source, const TargetModel& target,
                                                     const Correspondence& wanted) {
    return direct_map(source, target, wanted, true, nullptr);
}

std::optional<ExtremalMap> annulus_onto_ring(const Surface& source, const TargetModel& target,
                                             const Correspondence& wanted, const ModulusBracket* of_target) {
    return direct_map(source, target, wanted, false, of_target);
}

}  // namespace beltrami
