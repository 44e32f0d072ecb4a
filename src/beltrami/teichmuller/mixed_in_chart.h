#pragma once

#include <memory>

#include <beltrami/teichmuller/chart_metric.h>
#include <beltrami/teichmuller/extremal_mixed.h>
#include <beltrami/teichmuller/prepared_problem.h>
#include <beltrami/teichmuller/problem_solver.h>

namespace beltrami {

/// Mixed conditions on a disk in space, solved in the plane of its chart (chart_metric.h) and measured on the surface:
/// near the ends of sliding arcs, where φ is singular, the noise of linear elements on a coarse rim otherwise passes
/// for φ, whatever the degree.
class MixedInChart final : public ProblemSolver {
  public:
    /// @param source, prepared of the problem; source is kept by reference
    /// @param chart   that can_be_metric
    /// @param marks   see MixedProblem
    MixedInChart(const Surface& source, PreparedProblem prepared, Chart chart, const MixedConditions& conditions,
                 ExtremalOptions options, std::size_t marks);

    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) override {
        return in_plane_->update(images, max_iterations);
    }
    ExtremalMap solve() override;

  private:
    PreparedProblem prepared_;
    const Surface& source_;  // of prepared_, or that given
    Chart chart_;
    ChartMetric metric_;
    std::unique_ptr<ProblemSolver> in_plane_;
};

/// A solver for a mixed problem: in the plane of the chart where that can be the metric, and the options do not forbid
/// it; else in the source's own.
/// @param marks see MixedProblem
/// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
std::unique_ptr<ProblemSolver> mixed_solver(const Surface& source, const MixedConditions& conditions,
                                            const ExtremalOptions& options, std::size_t marks = 0);

}  // namespace beltrami
