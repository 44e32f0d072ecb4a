#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <beltrami/certificate/certificate.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/teichmuller/chart_metric.h>

namespace beltrami {

/// A map and its c-step.
struct FoundMap {
    Eigen::VectorXcd map;  ///< #V
    CoefficientStep::Result step;
};

/// Samples that a map turns over or collapses.
int folded_samples(const Eigen::VectorXcd& mu);

/// Newton step, as part of the whole, to which c-steps are solved after the iteration where φ has been found roughly.
constexpr double kFinishingStep = 2e-3;
constexpr int kFinishingSteps = 20;
/// Gauss-Newton steps of evening out.
constexpr int kEveningSteps = 3;

/// What comes after the iteration of every extremal problem: |μ| is evened out, folds are opened, φ and k follow the
/// map. Vertices that slide stay where they are.
class Finish {
  public:
    /// All are kept by reference.
    /// @param chart_metric in which the c-step sees maps; null: the source's own metric
    /// @param freedoms     #V; those that slide count as fixed
    Finish(const Surface& source, const ChartMetric* chart_metric, CoefficientStep& coefficient_step,
           std::vector<Freedom> freedoms);

    /// Whether the map has folds on the source.
    bool folded(const FoundMap& found) const;
    /// Whether the map is far from |μ| = k, or folded.
    /// @param singular φ may be singular within reach of the mesh: there less is allowed
    bool uneven(const FoundMap& found, bool singular) const;

    /// Evens |μ| out, φ and k following the map (even_dilatation.h); whether the map has changed.
    /// @param steps of Gauss-Newton
    bool even_out(FoundMap& found, int steps = kEveningSteps);
    /// Opens folds, on the way to the coefficient of φ and k (fold_free.h); where all else fails and the boundary goes
    /// to a convex polygon, from a map that never had any. Whether the map has changed: then it has none.
    /// @param boundary what the map is to obey, sliding vertices at their places
    bool open_folds(FoundMap& found, const BoundaryCondition& boundary);
    /// The c-step of a map that has changed.
    /// @param step, newton_steps see CoefficientStep
    void follow(FoundMap& found, double step, int newton_steps = 50) const;

    int factorizations() const { return factorizations_; }

  private:
    const Operators& operators() const;  ///< of the metric in which the c-step sees maps
    Eigen::VectorXcd on_source(const Eigen::VectorXcd& phi) const;

    const Surface& source_;
    const ChartMetric* chart_metric_;
    CoefficientStep& coefficient_step_;
    std::vector<Freedom> freedoms_;
    int factorizations_ = 0;
};

/// A map as its bounds see it.
struct MeasuredMap {
    const FoundMap& found;
    Distortion distortion;  ///< in the metric of the c-step
    ReichStrebel integrals;
};

/// The map, or the one before it was evened out: evening makes the bounds, as a rule, a little worse.
MeasuredMap better_for_bounds(const FoundMap& now, const std::optional<FoundMap>& before,
                              const std::function<MeasuredMap(const FoundMap&)>& measure);

}  // namespace beltrami
