#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <beltrami/base/error.h>
#include <beltrami/baselines/start.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// A map known to have no folds: convex_embedding; or, where nothing is prescribed at all, that with the outer loop on
/// a circle by arc length.
std::optional<Eigen::VectorXcd> convex_start(const Surface& source, const BoundaryCondition& boundary,
                                             int& factorizations) {
    if (source.topology.components != 1 || source.topology.genus != 0) return {};
    if (!boundary.empty()) return convex_embedding(source, boundary, factorizations);
    const auto& loop = source.topology.boundary_loops[0];
    BoundaryCondition ring;
    double along = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        ring.pin(loop[i], std::polar(1.0, 2 * std::numbers::pi * along / source.topology.loop_lengths[0]));
        along += (source.mesh.point(loop[(i + 1) % loop.size()]) - source.mesh.point(loop[i])).norm();
    }
    ++factorizations;
    return convex_combination_map(source, ring, ConvexWeights::uniform);
}

}  // namespace

BaselineMap mips_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    BaselineMap result;
    result.map = detail::linear_map(source, boundary, result.factorizations);
    if (detail::must_fold(source, boundary, result)) return result;

    if (!detail::has_no_folds(source, result.map)) {
        std::optional<Eigen::VectorXcd> convex = convex_start(source, boundary, result.factorizations);
        if (convex && detail::has_no_folds(source, *convex)) {
            result.map = std::move(*convex);
            result.warnings.push_back(
                {WarningKind::start, "the linear start has folds; started from Tutte's map instead"});
        } else {
            result.warnings.push_back({WarningKind::start, "the linear start has folds and was unfolded"});
        }
    }
    FoldFreeOptions descent;
    descent.max_iterations = options.max_iterations;
    descent.tolerance = options.tolerance;
    descent.progress = options.progress;
    FoldFreeMap minimum = fold_free_map(source, freedoms(boundary, source),
                                        Eigen::VectorXcd::Zero(source.operators.sample_count()), result.map, descent);
    result.map = std::move(minimum.map);
    detail::give_true_size(source, boundary, result.map);
    result.iterations = minimum.iterations;
    result.factorizations += minimum.factorizations;
    result.converged = minimum.fold_free && minimum.status == FoldFreeStatus::converged;
    if (!minimum.fold_free)
        result.warnings.push_back(
            {WarningKind::fold_forced,
             "folds remain: the prescribed vertices admit no map without folds, or none was found"});
    else
        detail::warn_of_limit("steps before the gradient vanished", result);
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
