#pragma once

#include <memory>

#include <beltrami/charts/chart.h>

namespace beltrami {

/// The plane of a chart as a metric of the surface: what a map does to the chart's image instead of the surface itself.
///
/// Linear elements near a coarse rim, a few large faces of the chart, have a noise in μ that φ of high degree fits: a
/// surface's own chart, extremal with K = 1 for its boundary values, is then given a K that grows with the degree. In
/// the plane of the chart it has μ = 0 exactly, and holomorphic φ are holomorphic. Where the truth is known both k and
/// the map are more accurate in this metric (docs/extremal-maps.md).
///
/// Samples that the chart turns over or leaves without a shape (unseen, chart.h) keep the one they have on the surface,
/// at the chart's scale, and take no part in finding φ.
class ChartMetric {
  public:
    /// @param source, chart of the source: a chart of it
    ChartMetric(const Surface& source, const Chart& chart);

    /// The surface with the chart's positions as its mesh, and operators of that plane.
    const Surface& plane() const { return plane_; }
    /// The chart of plane(): the identity. Not marked as exact, for what it proves it proves of the plane.
    const Chart& chart() const { return chart_; }
    /// The same with the derivatives of the surface's chart: φ of plane() written down on the surface.
    Chart chart_on_surface() const;
    /// Mean |μ| of the chart on the surface, by area.
    double chart_mean() const { return chart_mean_; }

    /// The coefficients, on the surface, of the maps that have the coefficients @p nu in the plane: the f-step of the
    /// surface for these is that of the plane for those, for the energy is conformally natural.
    Eigen::VectorXcd coefficient_on_surface(const Eigen::VectorXcd& nu) const;
    /// φ pulled back to the samples' frames on the surface.
    Eigen::VectorXcd differential_on_surface(const Eigen::VectorXcd& phi) const;

  private:
    Surface plane_;
    Chart chart_;
    Eigen::VectorXcd mu_;           ///< #S of the chart on the surface; 0 where the surface's shape is kept
    Eigen::VectorXcd derivatives_;  ///< #S ∂ of the chart
    double chart_mean_ = 0;
};

/// k that φ up to a degree sees in a round disk's chart itself, in the surface's metric, as part of the k that it sees
/// in a map: noise, for the truth is 0.
/// @param map   #V
/// @param phase, cluster_count see CoefficientStep
double chart_noise(const Surface& source, const Chart& chart, const Eigen::VectorXcd& map, int degree, double phase,
                   int cluster_count);

}  // namespace beltrami
