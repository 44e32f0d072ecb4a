#pragma once

#include <beltrami/base/public.h>
#include <beltrami/charts/chart.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map of a disk-like surface onto the polygon of its boundary vertices on the unit circle.
struct FoldFreeDisk {
    Eigen::VectorXcd map;       ///< #V
    bool fold_free = false;     ///< false only where rounding leaves no map without folds
    bool changed = false;       ///< the chart had folds, or a boundary that runs backwards
    int moved_boundary = 0;     ///< boundary edges that ran backwards or too short and were given a length
    bool kept_boundary = true;  ///< false: the chart's boundary goes round another number of times than once, and arc
                                ///< length decides where its vertices go
    int factorizations = 0;
};

/// The chart itself where it has no folds and its boundary runs once around 0. Else boundary vertices are put on the
/// circle in their order, at the chart's angles where these grow, and the inside is the map nearest to a conformal one
/// without folds (fold_free.h), from the chart or, where its folds do not open, from convex_embedding.
/// @param chart #V a chart of round_disk.h
/// @pre one component, one boundary loop, genus 0
FoldFreeDisk fold_free_disk(const Surface& source, const Eigen::VectorXcd& chart);

/// The chart for writing differentials down in: where it turns over a part of itself that counts, or its boundary runs
/// backwards somewhere, its boundary vertices are put in their order (as fold_free_disk) and its folds opened where
/// they are; a few that are smaller than rounding may be left. Elsewhere the chart as it is.
/// @pre as fold_free_disk
Chart with_folds_opened(const Surface& source, Chart chart);

}  // namespace beltrami
