#include <beltrami/teichmuller/record.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/counted.h>
#include <beltrami/certificate/attained_dilatation.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/mixed_space.h>

namespace beltrami {

namespace {

/// Where the deviation exceeds this part of k, k is no more than a rough estimate; a smaller k says nothing.
constexpr double kRough = 0.6, kLeastRoughK = 1e-3;
/// Faces with a larger |μ| are crushed where k is smaller than that.
constexpr double kCrushed = 0.9, kMildK = 0.67;
/// A map whose K is above every lower bound by more than this part is not confirmed.
constexpr double kUnconfirmed = 0.1;
/// Residuals below are rounding.
constexpr double kLeastResidual = 1e-16;

}  // namespace

void record_residual(const BoundaryCondition& boundary, ExtremalMap& result) {
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        result.boundary_residual =
            std::max(result.boundary_residual, std::abs(result.map[boundary.vertices[i]] - boundary.images[i]));
}

void record_attained(const Surface& source, const Eigen::VectorXcd& map, ExtremalMap& result) {
    const AttainedDilatation attained = attained_dilatation(source, map, result.distortion);
    result.K_max = attained.K;
    if (std::isfinite(result.K_max))
        result.bounds.push_back({Bound::Kind::attained, result.K_max, Bound::Of::extremal, attained.rigorous});
}

void record_sliding_bounds(const Surface& source, const Eigen::VectorXcd& map, const ReichStrebel& integrals, double k,
                           ExtremalMap& result) {
    result.K = std::min(integrals.valid ? integrals.estimate : dilatation(k), result.distortion.K_max());
    result.k = k_of(result.K);
    if (integrals.valid) {
        result.K_lower = std::max(1.0, integrals.lower);
        result.K_upper = integrals.upper;
        // φ is real along circles, the mesh ends at their chords, and μ is not tangential to them: an error of
        // second order that no quadrature sees.
        result.bounds.push_back({Bound::Kind::reich_strebel, result.K_lower, Bound::Of::extremal, false});
        result.bounds.push_back({Bound::Kind::reich_strebel_estimate, result.K, Bound::Of::extremal, false});
        result.bounds.push_back({Bound::Kind::reich_strebel_upper, result.K_upper, Bound::Of::extremal, false});
    }
    record_attained(source, map, result);
}

void record_space(const DifferentialSpace& space, std::optional<int> expected_dimension, ExtremalMap& result) {
    result.dimension = space.size();
    result.expected_dimension = expected_dimension.value_or(result.dimension);
    if (const auto* mixed = dynamic_cast<const MixedSpace*>(&space)) {
        result.dimension_gap = mixed->fit().next / std::max(mixed->fit().last, kLeastResidual);
        result.reality = mixed->fit().residual;
    } else if (const auto* laurent = dynamic_cast<const LaurentSpace*>(&space)) {
        result.dimension_gap = laurent->fit().next / std::max(laurent->fit().residual, kLeastResidual);
        result.reality = laurent->fit().residual;
    }
    if (result.dimension != result.expected_dimension)
        result.warnings.push_back({WarningKind::differentials, "the space of differentials has dimension " +
                                                                   std::to_string(result.dimension) + ", theory says " +
                                                                   std::to_string(result.expected_dimension)});
}

void warn_of_crushed_faces(ExtremalMap& result) {
    if (!result.distortion.flipped.empty() || !(result.k < kMildK)) return;
    std::vector<int> crushed;
    const Eigen::VectorXd& abs_mu = result.distortion.face_abs_mu;
    for (Eigen::Index f = 0; f < abs_mu.size(); ++f)
        if (abs_mu[f] > kCrushed) crushed.push_back(static_cast<int>(f));
    if (crushed.empty()) return;
    result.warnings.push_back({WarningKind::rough,
                               counted(crushed.size(), "face has", "faces have") +
                                   " |mu| above 0.9, the first is face " + std::to_string(crushed[0]) +
                                   ": the map leaves next to no room there, at notches and slots of the outline, and "
                                   "linear faces cannot follow it; a finer mesh there can",
                               {Things::faces, crushed}});
}

void withdraw_unconfirmed(ExtremalMap& result) {
    if (result.termination != Termination::converged) return;
    const bool wide = result.K > (1 + kUnconfirmed) * result.K_lower;
    if (wide || !result.distortion.flipped.empty()) result.termination = Termination::unconfirmed;
    if (!wide) return;
    const std::string bound = result.K_lower > 1 ? "the largest lower bound is " + std::to_string(result.K_lower)
                                                 : std::string("there is no lower bound");
    result.warnings.push_back(
        {WarningKind::rough, "K has settled at " + std::to_string(result.K) + ", but nothing confirms it: " + bound +
                                 ". Where boundary values crowd, at corners, and where conditions change along the "
                                 "boundary, the mesh may be too coarse for the differential; a finer mesh tells"});
}

void record_shortcomings(ExtremalMap& result) {
    warn_of_folds_and_limit(std::to_string(result.iterations) + " iterations before k and φ settled", result,
                            result.K_lower > 1 ? "" : " and no lower bound can be given");
    if (result.k > kLeastRoughK &&
        std::hypot(result.distortion.standard_deviation, result.distortion.mean - result.k) > kRough * result.k)
        result.warnings.push_back({WarningKind::rough,
                                   "the map is far from constant dilatation: the mesh is too coarse for its shape, or "
                                   "the extremal map is not smooth; K is a rough estimate and K_lower may be far below "
                                   "K*"});
}

}  // namespace beltrami
