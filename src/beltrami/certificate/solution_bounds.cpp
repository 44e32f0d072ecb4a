#include <beltrami/certificate/solution_bounds.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// From here on face-wise coefficients are too noisy for K.
constexpr double kLargeCoefficient = 0.8;

/// A bracket wider than this part of K is worth a second solve, on meshes that are not very large.
constexpr double kWideGap = 0.01;
constexpr int kMostSharpenedSamples = 100'000;

/// Where faces with less than this part of ∫|φ| change the estimate of K by more than that part, it is theirs: at
/// jagged corners a face has |μ| as near to 1 as it likes.
constexpr double kCrushedPart = 0.01, kCrushes = 0.1;

/// Whether a map has the turns that are wanted, and whether that can be known.
struct SameClass {
    bool same = true, known = true;
};

SameClass same_class(const Solution& s, const QuadraticMap& map) {
    SameClass result;
    if (s.paths.empty()) return result;
    const HomotopyClass wanted = homotopy_class(s.source, s.paths, s.map, s.outer_loop),
                        found = homotopy_class(s.source, s.paths, map.head(s.map.size()), s.outer_loop);
    for (std::size_t i = 0; i < found.holes.size(); ++i) {
        const bool given = !s.turns.empty();
        const int turns = given ? s.turns[found.holes[i].loop] : wanted.holes[i].turns;
        if (turns != found.holes[i].turns) result.same = false;
        if (!given && !wanted.holes[i].meaningful) result.known = false;
    }
    return result;
}

/// √(I⁺/I⁻) with the faces where |μ| is largest, that hold a part of ∫|φ|, held at the |μ| of the next: what a map has
/// that crushes none of them.
double estimate_without_crushed(const Surface& source, const Eigen::VectorXcd& phi, const Eigen::VectorXcd& mu) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(mu.size()));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
        return std::pair(-std::norm(mu[a]), a) < std::pair(-std::norm(mu[b]), b);
    });
    const auto mass = [&](Eigen::Index s) { return source.operators.weights[s] * std::abs(phi[s]); };
    double total = 0, left_out = 0, held = 0;
    for (const Eigen::Index s : order) total += mass(s);
    for (const Eigen::Index s : order) {
        held = std::abs(mu[s]);
        left_out += mass(s);
        if (left_out > kCrushedPart * total) break;
    }
    double norm = 0, pairing = 0;
    for (Eigen::Index s = 0; s < mu.size(); ++s) {
        const double size = std::abs(mu[s]);
        const Complex m = size > held ? Complex(mu[s] * (held / size)) : mu[s];
        norm += mass(s) * (1 + std::norm(m)) / (1 - std::norm(m));
        pairing += source.operators.weights[s] * 2 * std::real(m * phi[s]) / (1 - std::norm(m));
    }
    return norm > pairing ? std::sqrt((norm + pairing) / (norm - pairing)) : 1;
}

/// Whether φ jumps where and as it may. Across edges with pinned ends it may in any way, and in a chart that is a
/// similarity they are straight. Where points slide on a line φ is admissible to first order in their motion only.
bool jumps_are_exact(const Solution& s) {
    std::size_t rim = 0;
    for (const auto& loop : s.source.topology.boundary_loops) rim += loop.size();
    return s.boundary.lines.empty() && (s.outer_loop == 0 || s.boundary.vertices.size() == rim);
}

}  // namespace

SolutionBounds solution_bounds(const Solution& s, std::optional<int> subdivisions) {
    SolutionBounds result;
    const double K_max = s.distortion.K_max();
    const ReichStrebel& own = s.integrals;
    const bool large = s.k >= kLargeCoefficient;
    const bool wide = own.valid && own.estimate > (1 + kWideGap) * own.lower &&
                      s.source.operators.sample_count() <= kMostSharpenedSamples;
    if (!subdivisions && (large || wide)) subdivisions = 0;

    SharpenedBound sharp;
    SameClass same;
    // On a finer mesh the map may fold where it does not on the mesh itself.
    const bool sharpens = s.boundary.lines.empty() && !s.space.tabulated();  // known at the samples of this mesh only
    for (int n = sharpens ? subdivisions.value_or(-1) : -1; n >= 0 && !sharp.integrals.valid; --n) {
        SharpenedBoundOptions options;
        options.subdivisions = n;
        if (s.distortion.flipped.empty()) options.map = s.map;
        try {
            sharp = sharpened_bound(s.source, s.boundary, s.chart, s.space, s.coefficients, s.k, options);
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved && error.cause() != Cause::bad_mesh) throw;
        }
        result.factorizations += sharp.factorizations;
    }
    if (sharp.integrals.valid) same = same_class(s, sharp.map);
    const bool sharpened = sharp.integrals.valid && same.same;
    double lower = 1, estimate = dilatation(s.k);
    bool rigorous = false;
    if (own.valid) {
        lower = std::max(lower, own.lower);
        rigorous = own.resolved && proves(s.source, s.chart) && jumps_are_exact(s);
        estimate = own.estimate;
        if (s.space.tabulated()) {
            const double uncrushed = estimate_without_crushed(s.source, s.phi, s.distortion.mu);
            if (estimate > (1 + kCrushes) * uncrushed || uncrushed > (1 + kCrushes) * estimate)
                estimate = std::max(uncrushed, lower);
        }
    }
    if (sharpened) {
        // Bound and estimate belong together: those of the map that does better.
        if (sharp.lower > lower || !own.valid) {
            lower = std::max(lower, sharp.lower);
            rigorous = sharp.rigorous && same.known && jumps_are_exact(s);
            estimate = sharp.integrals.estimate;
        }
    }
    if (own.valid || sharpened) {
        result.bounds.push_back({Bound::Kind::reich_strebel, lower, Bound::Of::extremal, rigorous});
        // Less than 1 says that φ has nothing to do with the map.
        estimate = std::max(estimate, 1.0);
        result.bounds.push_back({Bound::Kind::reich_strebel_estimate, estimate, Bound::Of::extremal, false});
    }
    if (large) {
        const ReichStrebel averaged = averaged_estimate(s.source, s.chart, s.phi, s.map);
        if (averaged.valid) {
            result.bounds.push_back({Bound::Kind::averaged_estimate, averaged.lower, Bound::Of::extremal, false});
            if (!sharpened && !(s.space.tabulated() && own.valid)) estimate = averaged.lower;
        }
    }
    result.K_lower = lower;
    result.K = std::max(std::min(estimate, K_max), lower);
    result.k = k_of(result.K);
    return result;
}

}  // namespace beltrami
