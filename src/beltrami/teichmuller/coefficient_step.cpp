#include <beltrami/teichmuller/coefficient_step.h>

#include <cmath>

namespace beltrami {

namespace {

constexpr double kClip = 0.95;
/// δ of the rounded |φ|, in edge lengths of a quadrature cell: about |φ| at a fifth of a cell from a simple zero.
constexpr double kRounding = 0.2;

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
    problem_.rounding = kRounding * std::sqrt(area / static_cast<double>(clusters_.points.positions.size()));
    fine_rounding_ = kRounding * std::sqrt(area / static_cast<double>(source.operators.sample_count()));
}

void CoefficientStep::set_space(const DifferentialSpace& space) {
    sampled_.set(space);
    problem_.basis = space.evaluate(clusters_.points);
    problem_.complex_coefficients = space.complex_coefficients();
}

CoefficientStep::Result CoefficientStep::solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start,
                                               const Eigen::VectorXcd& known_phi) {
    const int samples = source_.operators.sample_count();
    const int size = static_cast<int>(problem_.basis.cols());
    Eigen::MatrixXcd weights = Eigen::MatrixXcd::Zero(samples, 2);  // A b, and A a conj(φ)/|φ| at the start
    Eigen::VectorXd norm_weight = Eigen::VectorXd::Zero(samples);   // A a
    problem_.weights = Eigen::VectorXd::Zero(problem_.basis.rows());
    for (int s = 0; s < samples; ++s) {
        if (chart_.excluded[s]) continue;
        const Complex m = clipped(mu[s]);
        const double square = std::norm(m), area = source_.operators.weights[s];
        weights(s, 0) = area / (1 - square) * m;
        norm_weight[s] = area * (1 + square) / (1 - square);
        problem_.weights[clusters_.cluster[s]] += clusters_.squared[s] * (1 + square) / (1 - square);
    }
    const auto norm_of = [&](const Eigen::VectorXcd& phi) {
        double norm = 0;
        for (int s = 0; s < samples; ++s) norm += norm_weight[s] * std::sqrt(std::norm(phi[s]));
        return norm;
    };

    Eigen::VectorXcd at = start;
    if (at.size() == 0) {  // a first answer from the clusters alone, about which the norm is then corrected
        problem_.pairing = sampled_.pair(weights.col(0));
        problem_.correction.resize(0);
        at = solve_dual(problem_, {}).coefficients;
    }
    at.conservativeResizeLike(Eigen::VectorXcd::Zero(size));
    const Eigen::VectorXcd phi = known_phi.size() ? known_phi : sampled_.combination(at);
    const double length_at = at.norm(), delta = fine_rounding_ * length_at;
    for (int s = 0; s < samples; ++s) {
        if (!(norm_weight[s] > 0)) continue;
        const double rounded = delta * std::norm(chart_.derivatives[s]), square = std::norm(phi[s]) + rounded * rounded;
        if (square > 0) weights(s, 1) = norm_weight[s] / std::sqrt(square) * std::conj(phi[s]);
    }
    const Eigen::MatrixXcd sums = sampled_.pair(weights);
    problem_.pairing = sums.col(0);
    problem_.correction.resize(0);
    if (length_at > 0)
        problem_.correction = sums.col(1) - dual_gradient(problem_.basis, problem_.weights, problem_.basis * at,
                                                          problem_.rounding * length_at);
    const DualSolution dual = solve_dual(problem_, at);

    Result result;
    result.converged = dual.converged;
    const double length = dual.coefficients.norm();
    result.direction = length > 0 ? Eigen::VectorXcd(dual.coefficients / length) : dual.coefficients;
    result.phi = sampled_.combination(result.direction);
    const double norm = norm_of(result.phi);
    result.k = norm > 0 ? dilatation_of_pairing(2 * dual.pairing / length / norm) : 0.0;
    return result;
}

}  // namespace beltrami
