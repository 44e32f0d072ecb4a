#include <beltrami/teichmuller/coefficient_step.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/mesh/parallel.h>
#include <beltrami/teichmuller/differential_quadrature.h>

namespace beltrami {

namespace {

constexpr double kClip = 0.95;
/// δ of the rounded |φ| as part of its mean, per edge length of a sample in a domain of diameter 2: about |φ| at a
/// fraction of an edge from a simple zero.
constexpr double kRounding = 0.4;
/// Without a start, Newton's method begins with these values of δ.
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
    soft_ = !singularities.curves.empty();
    SamplePoints means = points_near(singularities, source, chart);
    set_quadrature(means);
    sampled_.set_means(std::move(means));
    double area = 0;
    for (const double a : clusters_.squared) area += a;
    edge_ = std::sqrt(area / static_cast<double>(source.operators.sample_count()));
}

/// The clusters' points, or those of a cluster's only sample where it has several.
void CoefficientStep::set_quadrature(const SamplePoints& means) {
    const auto clusters = clusters_.points.positions.size();
    std::vector<int> samples(clusters, 0);
    std::vector<double> area(clusters, 0.0);
    for (std::size_t s = 0; s < clusters_.cluster.size(); ++s)
        if (clusters_.cluster[s] >= 0) {
            ++samples[clusters_.cluster[s]];
            area[clusters_.cluster[s]] += clusters_.squared[s];
        }
    std::vector<Complex> places;
    std::vector<double> parts, weights;
    std::vector<char> divided(clusters, 0);
    for (std::size_t i = 0; i < means.samples.size(); ++i) {
        const int cluster = clusters_.cluster[means.samples[i]];
        if (cluster < 0 || samples[cluster] != 1) continue;
        divided[cluster] = 1;
        cluster_means_.samples.push_back(cluster);
        places.push_back(means.points.positions[static_cast<Eigen::Index>(i)]);
        parts.push_back(means.weights[static_cast<Eigen::Index>(i)]);
        weights.push_back(parts.back() * area[cluster]);
    }
    const auto count = static_cast<Eigen::Index>(places.size());
    cluster_means_.points.positions = Eigen::Map<const Eigen::VectorXcd>(places.data(), count);
    cluster_means_.points.derivatives = Eigen::VectorXcd::Ones(count);
    cluster_means_.weights = Eigen::Map<const Eigen::VectorXd>(parts.data(), count);
    for (Eigen::Index q = 0; q < clusters; ++q)
        if (!divided[q]) {
            places.push_back(clusters_.points.positions[q]);
            weights.push_back(area[q]);
        }
    const auto all = static_cast<Eigen::Index>(places.size());
    quadrature_ = {Eigen::Map<const Eigen::VectorXcd>(places.data(), all),
                   Eigen::Map<const Eigen::VectorXd>(weights.data(), all)};
}

void CoefficientStep::set_space(const DifferentialSpace& space) {
    sampled_.set(space);
    problem_.basis = space.generators(clusters_.points);
    if (!cluster_means_.samples.empty())
        take_means(cluster_means_, space.generators(cluster_means_.points), problem_.basis);
    if (space.transform()) problem_.basis = complex_product(problem_.basis, *space.transform());
    problem_.complex_coefficients = space.complex_coefficients();
}

Eigen::VectorXcd CoefficientStep::coefficient(double k, const Eigen::VectorXcd& phi) const {
    double delta = 0;
    if (soft_) {
        double sum = 0, area = 0;
        for (Eigen::Index s = 0; s < phi.size(); ++s) {
            if (chart_.excluded[s]) continue;
            sum += source_.operators.weights[s] * std::abs(phi[s]);  // |ψ| by area in the domain
            area += clusters_.squared[s];
        }
        delta = area > 0 ? std::max(least_rounding_, kRounding * edge_) * sum / area : 0.0;
    }
    Eigen::VectorXcd nu(phi.size());
    for (Eigen::Index s = 0; s < phi.size(); ++s) {
        const double rounded = delta * std::norm(chart_.derivatives[s]);
        const double size = std::sqrt(std::norm(phi[s]) + rounded * rounded);
        nu[s] = size > 0 ? k * std::conj(phi[s]) / size : 0.0;
    }
    return nu;
}

namespace {

/// N on every sample of the mesh, and on the points of samples that have several. Values of φ: those of the samples,
/// then those of the points.
class SampleNorm final : public DualNorm {
  public:
    /// @param weights #S A a, 0 where the chart excludes the sample
    SampleNorm(const SampledSpace& space, const Chart& chart, const Eigen::VectorXd& weights) : space_(space) {
        const SamplePoints& means = space.means();
        const Eigen::Index samples = weights.size(), points = means.weights.size();
        weights_.resize(samples + points);
        scales_.resize(samples + points);
        weights_.head(samples) = weights;
        scales_.head(samples) = chart.derivatives.cwiseAbs2();
        weights_.tail(points) = means.weights;
        scales_.tail(points) = means.points.derivatives.cwiseAbs2();
        for (Eigen::Index i = 0; i < points; ++i) weights_[samples + i] *= weights[means.samples[i]];
        for (const int s : means.samples) weights_[s] = 0;
        samples_ = samples;
    }
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override {
        Eigen::VectorXcd all(weights_.size());
        all.head(samples_) = space_.combination(c);
        if (all.size() > samples_) all.tail(all.size() - samples_) = space_.combination_at_means(c);
        return all;
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
        Eigen::VectorXcd result = space_.pair(direction.topRows(samples_));
        if (phi.size() > samples_) result += space_.pair_at_means(direction.bottomRows(phi.size() - samples_));
        return result;
    }

  private:
    double square(Complex phi, int s, double delta) const {
        const double rounded = delta * scales_[s];
        return std::norm(phi) + rounded * rounded;
    }
    const SampledSpace& space_;
    Eigen::VectorXd weights_, scales_;  // of samples and points: scales |derivative|²
    Eigen::Index samples_;
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
    const SampleNorm norm(sampled_, chart_, norm_weight);
    Eigen::VectorXcd at = start;
    if (at.size() == 0)
        for (const double rounding : kColdRoundings) {
            problem_.rounding = rounding;
            at = solve_dual(problem_, at, {.step = kColdStep, .norm = &norm}).coefficients;
        }
    problem_.rounding = std::max(least_rounding_, kRounding * edge_);
    const DualSolution dual = solve_dual(problem_, at, {.max_steps = newton_steps, .step = step, .norm = &norm});

    Result result;
    result.converged = dual.converged;
    result.newton_steps = dual.newton_steps;
    const double length = dual.coefficients.norm();
    result.direction = length > 0 ? Eigen::VectorXcd(dual.coefficients / length) : dual.coefficients;
    const Eigen::VectorXcd phi = length > 0 ? Eigen::VectorXcd(dual.phi / length) : dual.phi;
    result.phi = phi.head(samples);
    const double size = norm.norm(phi, 0);
    if (!(size > 0)) return result;
    const double pairing = dual.pairing / length;
    result.k = dilatation_of_pairing(2 * pairing / size);
    Eigen::VectorXd plain(samples);
    for (int s = 0; s < samples; ++s) plain[s] = chart_.excluded[s] ? 0.0 : source_.operators.weights[s];
    result.merit = SampleNorm(sampled_, chart_, plain).norm(phi, 0) / (size - 2 * pairing);
    return result;
}

}  // namespace beltrami
