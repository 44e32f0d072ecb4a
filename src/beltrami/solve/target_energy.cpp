#include <beltrami/solve/target_energy.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

constexpr double kQuantile = 0.9;         // of ψ: its unit for p > 2
constexpr double kFloorOfSquares = 0.02;  // of p = 2 beside p > 2

std::vector<double> of_unit_sum(std::vector<double> weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

}  // namespace

double ResidualEnergy::value(const ImageFrame& frame, int sample) const {
    return weights_[sample] * std::norm(frame.q - sigma_[sample] * frame.p);
}

SampleTerm ResidualEnergy::term(const ImageFrame& frame, int sample) const {
    const double weight = weights_[sample];
    const Complex sigma = sigma_[sample];
    return {1, -sigma, weight * (frame.q - sigma * frame.p), weight, weight};
}

double PerturbationEnergy::value(const ImageFrame& frame, int sample) const {
    return areas_[sample] * std::norm(frame.q - sigma_[sample] * frame.p);
}

/// J V_w̄ = p δq − q δp with the Jacobian J = |p|² − |q|², and J ρ = p (σp − q).
SampleTerm PerturbationEnergy::term(const ImageFrame& frame, int sample) const {
    const Complex p = frame.p, q = frame.q;
    const double size = std::norm(p) + std::norm(q);
    const double jacobian = std::max(std::abs(std::norm(p) - std::norm(q)), 1e-12 * size);
    const double weight = jacobian > 0 ? areas_[sample] / jacobian : 0;
    return {p, -q, weight * p * (q - sigma_[sample] * p), weight, weight};
}

BarrierEnergy::BarrierEnergy(Eigen::VectorXcd sigma, std::vector<double> weights, double power)
    : sigma_(std::move(sigma)), weights_(of_unit_sum(std::move(weights))), power_(power) {}

/// The hyperbolic distance of the coefficient from the one wanted, as tanh of half of it.
struct BarrierEnergy::Distance {
    Complex quotient;        // T
    Complex denominator;     // 1 − conj(σ) μ
    double psi = kInfinity;  // |T|²/(1 − |T|²)
};

BarrierEnergy::Distance BarrierEnergy::distance(const ImageFrame& frame, int sample) const {
    Distance result;
    if (!frame.upright || !(std::norm(frame.q) < std::norm(frame.p))) return result;
    const Complex mu = frame.q / frame.p, sigma = sigma_[sample];
    result.denominator = 1.0 - std::conj(sigma) * mu;
    result.quotient = (mu - sigma) / result.denominator;
    const double square = std::norm(result.quotient);
    if (square < 1) result.psi = square / (1 - square);
    return result;
}

double BarrierEnergy::value(const ImageFrame& frame, int sample) const {
    const double psi = distance(frame, sample).psi;
    if (!std::isfinite(psi) || power_ == 2) return weights_[sample] * psi;
    return weights_[sample] * (std::pow(psi / unit_, 0.5 * power_) + kFloorOfSquares * psi / unit_);
}

SampleTerm BarrierEnergy::term(const ImageFrame& frame, int sample) const {
    const Distance at = distance(frame, sample);
    const double d = std::abs(at.quotient), rest = 1 - d * d;
    Complex factor = (1 - std::norm(sigma_[sample])) / (at.denominator * at.denominator * rest * frame.p);
    if (d > 1e-14) factor *= std::conj(at.quotient) / d;
    double slope = 1, bend = 1;  // of ψ^{p/2} by ψ; its second derivative along the gradient, relatively
    if (power_ > 2) {
        slope = (0.5 * power_ * std::pow(at.psi / unit_, 0.5 * power_ - 1) + kFloorOfSquares) / unit_;
        bend = power_ - 1;
    }
    const double weight = slope * weights_[sample] / rest;
    const Complex mu = frame.q / frame.p;
    return {factor, -mu * factor, weight * d, bend * weight, rest * rest * weight};
}

void BarrierEnergy::prepare(const Operators& operators, const Positions& points, const Positions& normals) {
    if (power_ == 2) return;
    std::vector<double> psi(static_cast<std::size_t>(operators.sample_count()));
    parallel_for(0, operators.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s) psi[s] = distance(image_frame(operators, s, points, normals), s).psi;
    });
    const auto at = psi.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(psi.size() - 1));
    std::nth_element(psi.begin(), at, psi.end());
    unit_ = std::isfinite(*at) && *at > 0 ? *at : 1;
}

}  // namespace beltrami
