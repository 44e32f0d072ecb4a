#include <beltrami/teichmuller/finish.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/parallel.h>
#include <beltrami/evening/even_dilatation.h>
#include <beltrami/teichmuller/hamilton.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// A map that is farther than this part of k from |μ| = k is evened out: where φ is singular, and elsewhere.
constexpr double kUnevenAtSingularities = 0.02, kUneven = 0.1, kUnevenAtAll = 2e-3;
/// Merits that differ by less, as part of them, do not tell which of two bounds is the larger one.
constexpr double kCloseMerit = 0.01;

/// √ of the mean of |μ − k conj(φ)/|φ||², |μ| held at 1: how far a map is from the coefficient that the theory
/// promises.
double deviation(const Operators& operators, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi, double k) {
    const Eigen::Array2d sums =
        parallel_sum<Eigen::Array2d>(operators.sample_count(), Eigen::Array2d::Zero(), [&](int begin, int end) {
            double sum = 0, area = 0;
            for (int s = begin; s < end; ++s) {
                const double size = std::sqrt(std::norm(phi[s])), of_mu = std::sqrt(std::norm(mu[s]));
                if (!(size > 0) || !std::isfinite(of_mu)) continue;
                const Complex m = of_mu > 1 ? mu[s] / of_mu : mu[s];
                sum += operators.weights[s] * std::norm(m - k * std::conj(phi[s]) / size);
                area += operators.weights[s];
            }
            return Eigen::Array2d(sum, area);
        });
    return sums[1] > 0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}

}  // namespace

int folded_samples(const Eigen::VectorXcd& mu) {
    return static_cast<int>(std::count_if(mu.begin(), mu.end(), [](Complex value) { return !(std::norm(value) < 1); }));
}

Finish::Finish(const Surface& source, const ChartMetric* chart_metric, CoefficientStep& coefficient_step,
               std::vector<Freedom> freedoms)
    : source_(source),
      chart_metric_(chart_metric),
      coefficient_step_(coefficient_step),
      freedoms_(std::move(freedoms)) {
    std::replace(freedoms_.begin(), freedoms_.end(), Freedom::sliding, Freedom::fixed);
}

const Operators& Finish::operators() const {
    return chart_metric_ ? chart_metric_->plane().operators : source_.operators;
}

Eigen::VectorXcd Finish::on_source(const Eigen::VectorXcd& phi) const {
    return chart_metric_ ? chart_metric_->differential_on_surface(phi) : phi;
}

bool Finish::folded(const FoundMap& found) const {
    return folded_samples(beltrami_coefficient(source_.operators, found.map)) > 0;
}

bool Finish::uneven(const FoundMap& found, bool singular) const {
    const Eigen::VectorXcd mu = beltrami_coefficient(operators(), found.map);
    if (folded_samples(mu) > 0) return true;
    const double part = singular ? kUnevenAtSingularities : kUneven;
    return !chart_metric_ &&
           deviation(operators(), mu, found.step.phi, found.step.k) > std::max(kUnevenAtAll, part * found.step.k);
}

bool Finish::even_out(FoundMap& found, int steps) {
    const auto update = [&](const Eigen::VectorXcd& at, Eigen::VectorXcd& phi, double& k) {
        found.step = coefficient_step_.solve(beltrami_coefficient(operators(), at), found.step.direction,
                                             kFinishingStep, kFinishingSteps);
        phi = on_source(found.step.phi);
        k = found.step.k;
        return true;
    };
    EvenDilatationOptions options;
    options.steps = steps;
    EvenDilatation even =
        even_dilatation(source_, freedoms_, found.map, found.step.k, on_source(found.step.phi), update, options);
    factorizations_ += even.factorizations;
    if (!even.improved) return false;
    found.map = std::move(even.map);
    return true;
}

bool Finish::open_folds(FoundMap& found, const BoundaryCondition& boundary) {
    if (!folded(found)) return false;
    const Eigen::VectorXcd in_metric = teichmueller_coefficient(found.step.k, found.step.phi),
                           nu = chart_metric_ ? chart_metric_->coefficient_on_surface(in_metric) : in_metric;
    const auto open = [&](const Eigen::VectorXcd& start) {
        FoldFreeMap opened = fold_free_map(source_, freedoms_, nu, start);
        factorizations_ += opened.factorizations;
        return opened;
    };
    FoldFreeMap opened = open(found.map);
    if (!opened.fold_free)
        if (const auto embedding = convex_embedding(source_, boundary, factorizations_)) opened = open(*embedding);
    if (opened.fold_free) {
        found.map = std::move(opened.map);
        return true;
    }
    // In crowded parts, smaller than what the solver leaves over of the whole, each by itself.
    LocalUnfolding by_parts = unfold_locally(source_, freedoms_, found.map);
    factorizations_ += by_parts.factorizations;
    if (by_parts.fold_free) found.map = std::move(by_parts.map);
    return by_parts.fold_free;
}

void Finish::follow(FoundMap& found, double step, int newton_steps) const {
    found.step =
        coefficient_step_.solve(beltrami_coefficient(operators(), found.map), found.step.direction, step, newton_steps);
}

MeasuredMap better_for_bounds(const FoundMap& now, const std::optional<FoundMap>& before,
                              const std::function<MeasuredMap(const FoundMap&)>& measure) {
    if (!before || before->step.merit < (1 - kCloseMerit) * now.step.merit) return measure(now);
    MeasuredMap earlier = measure(*before);
    if (earlier.integrals.valid && before->step.merit > (1 + kCloseMerit) * now.step.merit) return earlier;
    MeasuredMap last = measure(now);
    const auto lower = [](const ReichStrebel& integrals) { return integrals.valid ? integrals.lower : 1; };
    return lower(earlier.integrals) >= lower(last.integrals) ? earlier : last;
}

}  // namespace beltrami
