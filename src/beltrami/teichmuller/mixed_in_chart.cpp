#include <beltrami/teichmuller/mixed_in_chart.h>

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>

#include <beltrami/base/error.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/teichmuller/mixed_problem.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/record.h>
#include <beltrami/teichmuller/rim_degree.h>
#include <beltrami/teichmuller/sliding_solver.h>

namespace beltrami {

namespace {

/// The plane of the chart sees no more than this part of the faces otherwise than they are; where values crowd it sees
/// nothing of legs and horns.
constexpr double kMostExcluded = 0.02;
/// Largest degrees of φ, one after the other, where all that the mesh resolves leads to no map.
constexpr int kLesserDegrees[] = {12, 6};

/// Whether nothing is left to be desired of a map.
bool settled(const ExtremalMap& map) {
    return map.termination == Termination::converged && map.distortion.flipped.empty();
}

/// Whether a map is to be preferred to another: without flips, settled, with a narrower bracket, in this order.
bool better(const ExtremalMap& a, const ExtremalMap& b) {
    const auto rank = [](const ExtremalMap& map) {
        return std::tuple(map.distortion.flipped.size(), map.termination != Termination::converged,
                          map.K / map.K_lower);
    };
    return rank(a) < rank(b);
}

/// Mixed conditions in a metric. At the ends of arcs φ is singular, and on meshes that are not fine there high degrees
/// fit the noise of a few elements: where that leads to no map, φ has a lesser degree.
class MixedSolver final : public ProblemSolver {
  public:
    MixedSolver(const Surface& source, const MixedConditions& conditions, const ExtremalOptions& options,
                std::size_t marks)
        : source_(source), conditions_(conditions), options_(options), marks_(marks), solver_(with_degree({})) {}

    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) override {
        moved_ = true;
        return solver_->update(images, max_iterations);
    }

    ExtremalMap solve() override {
        ExtremalMap best = solver_->solve();
        if (moved_ || !prescribes_arcs_) return best;
        for (const int degree : kLesserDegrees) {
            if (settled(best)) break;
            try {
                ExtremalMap other = with_degree(degree)->solve();
                other.iterations += best.iterations;
                other.factorizations += best.factorizations;
                if (!better(other, best)) continue;
                other.warnings.push_back(
                    {WarningKind::differentials,
                     "with φ of all degrees that the mesh resolves the iteration led to no map, as at the ends of arcs "
                     "it fits the noise of a few faces: φ has degree " +
                         std::to_string(degree) + " at most"});
                best = std::move(other);
            } catch (const Error& error) {
                if (error.cause() != Cause::not_solved) throw;
            }
        }
        return best;
    }

  private:
    std::unique_ptr<SlidingSolver> with_degree(std::optional<int> most) {
        auto problem = std::make_unique<MixedProblem>(source_, conditions_, options_, marks_, most);
        prescribes_arcs_ = problem->prescribes_arcs();
        return std::make_unique<SlidingSolver>(std::move(problem), options_);
    }

    const Surface& source_;
    MixedConditions conditions_;
    ExtremalOptions options_;
    std::size_t marks_;
    bool prescribes_arcs_ = false, moved_ = false;
    std::unique_ptr<SlidingSolver> solver_;
};

}  // namespace

MixedInChart::MixedInChart(const Surface& source, PreparedProblem prepared, Chart chart,
                           const MixedConditions& conditions, ExtremalOptions options, std::size_t marks)
    : prepared_(std::move(prepared)),
      source_(prepared_.surface_of(source)),
      chart_(std::move(chart)),
      metric_(source_, chart_) {
    if (options.start && prepared_.split) options.start = with_parents_means(*options.start, prepared_.split->parents);
    in_plane_ = std::make_unique<MixedSolver>(metric_.plane(), conditions, options, marks);
}

ExtremalMap MixedInChart::solve() {
    ExtremalMap result = in_plane_->solve();
    result.factorizations += chart_.factorizations;
    Warnings warnings = chart_.warnings;
    if (prepared_.split) warnings.push_back(prepared_.split_warning("boundary or prescribed"));
    result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
    result.split = prepared_.split;

    result.in_chart = InChart{metric_.chart_mean(), result.distortion.mean, result.distortion.standard_deviation,
                              degree_of_rim(source_, chart_)};
    result.distortion = distortion(source_.operators, result.map);
    std::erase_if(result.bounds, [](const Bound& bound) { return bound.kind == Bound::Kind::attained; });
    record_attained(source_, result.map, result);

    result.phi = metric_.differential_on_surface(result.phi);
    if (result.differential.chart) {
        Chart on_surface = *result.differential.chart;
        on_surface.derivatives = on_surface.derivatives.cwiseProduct(metric_.chart_on_surface().derivatives);
        on_surface.exact = false;
        on_surface.analytic = {};
        result.differential.chart = std::make_shared<Chart>(std::move(on_surface));
    }
    return result;
}

std::unique_ptr<ProblemSolver> mixed_solver(const Surface& source, const MixedConditions& conditions,
                                            const ExtremalOptions& options, std::size_t marks) {
    if (!source.in_plane() && source.topology.boundary_loops.size() == 1 && options.chart_metric.value_or(true)) {
        PreparedProblem prepared = prepare_mixed(source, conditions, options);
        Chart chart = round_disk_chart(prepared.surface_of(source));
        if (can_be_metric(prepared.surface_of(source), chart) &&
            chart.excluded_faces <= kMostExcluded * prepared.surface_of(source).mesh.face_count())
            return std::make_unique<MixedInChart>(source, std::move(prepared), std::move(chart), conditions, options,
                                                  marks);
    }
    return std::make_unique<MixedSolver>(source, conditions, options, marks);
}

}  // namespace beltrami
