#include <beltrami/teichmuller/coefficient_step.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

constexpr double kClip = 0.95;
/// δ of the rounded |φ| as part of its mean, per edge length of a sample in a domain of diameter 2: about |φ| at a
/// fraction of an edge from a simple zero.
constexpr double kRounding = 0.4;
/// Without a start, Newton's method begins with these values of δ, on the clusters.
constexpr std::array kColdRoundings{0.3, 0.1, 0.03};
/// … and ends each of them at steps of this length.
constexpr double kColdStep = 0.05;

Complex clipped(Complex mu) {
    const double size = std::abs(mu);
    if (std::isnan(size)) return 0;
    if (std::isinf(size)) return kClip;
    return size > kClip ? mu * (kClip / size) : mu;
}

}  // namespace

CoefficientStep::CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities,
                                 double phase, int cluster_count)
    : source_(source),
      chart_(chart),
      sampled_(chart, singularities, phase),
      clusters_(cluster_samples(source.operators, chart, singularities, phase, cluster_count)) {
    double area = 0;
    for (const double a : clusters_.squared) area += a;
    edge_ = std::sqrt(area / static_cast<double>(source.operators.sample_count()));
}

void CoefficientStep::set_space(const DifferentialSpace& space) {
    sampled_.set(space);
    last_coefficients_.resize(0);
    problem_.basis = space.tabulated() ? means_over_clusters(*space.tabulated(), clusters_, chart_)
                                       : space.evaluate(clusters_.points);
    if (space.tabulated() && space.transform()) problem_.basis = complex_product(problem_.basis, *space.transform());
    problem_.complex_coefficients = space.complex_coefficients();
}

const Eigen::VectorXcd& CoefficientStep::values(const Eigen::VectorXcd& coefficients) {
    if (coefficients.size() != last_coefficients_.size() || coefficients != last_coefficients_) {
        last_values_ = sampled_.combination(coefficients);
        last_coefficients_ = coefficients;
    }
    return last_values_;
}

namespace {

/// N on every sample of the mesh.
class SampleNorm final : public DualNorm {
  public:
    /// @param weights #S A a, 0 where the chart excludes the sample
    /// @param known, values coefficients of which the values are known
    SampleNorm(const SampledSpace& space, const Chart& chart, const Eigen::VectorXd& weights,
               const Eigen::VectorXcd& known, const Eigen::VectorXcd& values)
        : space_(space), chart_(chart), weights_(weights), known_(known), values_(values) {}
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override {
        if (c.size() == known_.size() && c.size() > 0) {
            const double factor = c.norm() / known_.norm();
            if ((c - factor * known_).norm() < 1e-14 * c.norm()) return factor * values_;
        }
        return space_.combination(c);
    }
    double norm(const Eigen::VectorXcd& phi, double delta) const override {
        return parallel_sum<double>(static_cast<int>(phi.size()), 0.0, [&](int first, int last) {
            double sum = 0;
            for (int s = first; s < last; ++s) sum += weights_[s] * std::sqrt(square(phi[s], s, delta));
            return sum;
        });
    }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        Eigen::MatrixXcd direction(phi.size(), 1);
        parallel_for(0, static_cast<int>(phi.size()), [&](int first, int last) {
            for (int s = first; s < last; ++s) {
                const double of = square(phi[s], s, delta);
                direction(s, 0) = of > 0 ? weights_[s] / std::sqrt(of) * std::conj(phi[s]) : 0.0;
            }
        });
        return space_.pair(direction);
    }

  private:
    double square(Complex phi, int s, double delta) const {
        const double rounded = delta * std::norm(chart_.derivatives[s]);
        return std::norm(phi) + rounded * rounded;
    }
    const SampledSpace& space_;
    const Chart& chart_;
    const Eigen::VectorXd& weights_;
    const Eigen::VectorXcd &known_, &values_;
};

}  // namespace

CoefficientStep::Result CoefficientStep::solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start, double step,
                                               int newton_steps) {
    const int samples = source_.operators.sample_count();
    Eigen::MatrixXcd pairing_weight = Eigen::MatrixXcd::Zero(samples, 1);  // A b
    Eigen::VectorXd norm_weight = Eigen::VectorXd::Zero(samples);          // A a
    problem_.weights = Eigen::VectorXd::Zero(problem_.basis.rows());
    for (int s = 0; s < samples; ++s) {
        if (chart_.excluded[s]) continue;
        const Complex m = clipped(mu[s]);
        const double square = std::norm(m), area = source_.operators.weights[s];
        pairing_weight(s, 0) = area / (1 - square) * m;
        norm_weight[s] = area * (1 + square) / (1 - square);
        problem_.weights[clusters_.cluster[s]] += clusters_.squared[s] * (1 + square) / (1 - square);
    }
    problem_.pairing = sampled_.pair(pairing_weight);
    const SampleNorm norm(sampled_, chart_, norm_weight, last_coefficients_, last_values_);
    Eigen::VectorXcd at = start;
    DualOptions cold;
    cold.step = kColdStep;
    if (at.size() == 0)
        for (const double rounding : kColdRoundings) {
            problem_.rounding = rounding;
            at = solve_dual(problem_, at, cold).coefficients;
        }
    problem_.rounding = std::max(least_rounding_, kRounding * edge_);
    DualOptions options;
    options.max_steps = newton_steps;
    options.step = step;
    options.norm = &norm;
    if (start.size() > 0) options.reach = moved_;
    const DualSolution dual = solve_dual(problem_, at, options);
    moved_ = dual.moved;

    Result result;
    result.converged = dual.converged;
    result.newton_steps = dual.newton_steps;
    const double length = dual.coefficients.norm();
    result.direction = length > 0 ? Eigen::VectorXcd(dual.coefficients / length) : dual.coefficients;
    result.phi = length > 0 ? Eigen::VectorXcd(dual.phi / length) : dual.phi;
    const double size = norm.norm(result.phi, 0);
    if (!(size > 0)) return result;
    last_coefficients_ = result.direction;
    last_values_ = result.phi;
    const double pairing = dual.pairing / length;
    result.k = dilatation_of_pairing(2 * pairing / size);
    double plain = 0;
    for (int s = 0; s < samples; ++s)
        if (!chart_.excluded[s]) plain += source_.operators.weights[s] * std::sqrt(std::norm(result.phi[s]));
    result.merit = plain / (size - 2 * pairing);
    return result;
}

}  // namespace beltrami
