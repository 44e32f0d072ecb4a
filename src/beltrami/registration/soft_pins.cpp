#include <beltrami/registration/soft_pins.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart.h>
#include <beltrami/linear/decomposition.h>

namespace beltrami {

namespace {

constexpr double kBoundaryPart = 0.35, kPinPart = 0.6;  // of the distances that the fields' width respects
constexpr double kLongestMove = 0.5;                    // in units of the width

}  // namespace

SoftPins::SoftPins(const Surface& source, Constraints constraints, std::vector<double> weights,
                   const ExtremalOptions& options)
    : source_(source),
      constraints_(std::move(constraints)),
      weights_(std::move(weights)),
      solver_(source, constraints_, options),
      wanted_(constraints_.prescribed.images),
      places_(wanted_),
      map_(solver_.solve()) {}

Eigen::VectorXd SoftPins::coordinates() const {
    Eigen::VectorXd x(2 * static_cast<Eigen::Index>(places_.size()));
    for (std::size_t i = 0; i < places_.size(); ++i)
        x.segment<2>(2 * static_cast<Eigen::Index>(i)) << places_[i].real(), places_[i].imag();
    return x;
}

double SoftPins::value() const {
    double sum = 0.5 * std::log(std::max(map_.K, 1.0));
    for (std::size_t i = 0; i < places_.size(); ++i)
        if (std::isfinite(weights_[i])) sum += weights_[i] * std::norm(places_[i] - wanted_[i]);
    return sum;
}

double SoftPins::width() const {
    double result = 1;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) result = std::min(result, kPinPart * std::abs(places_[i] - places_[j]));
        for (const auto& loop : source_.topology.boundary_loops)
            for (const int v : loop) result = std::min(result, kBoundaryPart * std::abs(places_[i] - map_.map[v]));
    }
    return result;
}

Eigen::VectorXd SoftPins::gradient() const {
    const auto n = static_cast<Eigen::Index>(places_.size());
    const double s = width(), scale = 1 / (2 * s * s);
    // Fields that are 1 at a pin and 0 at the others: Σ exp(−|w − x_j|²/2s²) times the columns of the inverse.
    Eigen::MatrixXd kernel(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) kernel(i, j) = std::exp(-scale * std::norm(places_[i] - places_[j]));
    const Eigen::MatrixXd weights = matrix_inverse(kernel);
    const MapDerivatives map = derivatives(source_.operators, map_.map);
    const Eigen::VectorXcd at = at_samples(source_.operators, map_.map);
    Eigen::VectorXcd moments = Eigen::VectorXcd::Zero(n);  // Σ A φ conj(p)/p ∂̄ of each Gaussian
    double total = 0;
    for (Eigen::Index q = 0; q < at.size(); ++q) {
        const double area = source_.operators.weights[static_cast<std::size_t>(q)];
        total += area * std::abs(map_.phi[q]);
        const Complex factor = area * map_.phi[q] * std::conj(map.dz[q]) / map.dz[q];
        for (Eigen::Index j = 0; j < n; ++j) {
            const Complex from = at[q] - places_[j];
            moments[j] += factor * (-scale * from) * std::exp(-scale * std::norm(from));
        }
    }
    Eigen::VectorXd result = Eigen::VectorXd::Zero(2 * n);
    if (!(total > 0)) return result;
    for (Eigen::Index i = 0; i < n; ++i) {
        if (!std::isfinite(weights_[i])) continue;
        const Complex sum = (moments.transpose() * weights.col(i)).value() / total;
        const Complex off = places_[i] - wanted_[i];
        result.segment<2>(2 * i) << sum.real() + 2 * weights_[i] * off.real(),
            -sum.imag() + 2 * weights_[i] * off.imag();  // Re(sum · i) = −Im sum
    }
    return result;
}

bool SoftPins::move(const Eigen::VectorXd& step) {
    std::vector<Complex> to = places_;
    for (std::size_t i = 0; i < to.size(); ++i) {
        const auto at = 2 * static_cast<Eigen::Index>(i);
        if (std::isfinite(weights_[i])) to[i] += Complex(step[at], step[at + 1]);
    }
    try {
        solver_.update(to);
        ExtremalMap map = solver_.solve();
        if (!map.one_to_one()) {
            solver_.update(places_);
            return false;
        }
        map_before_ = std::move(map_);
        map_ = std::move(map);
    } catch (const Error& error) {
        if (error.cause() != Cause::bad_boundary && error.cause() != Cause::not_solved) throw;
        return false;
    }
    places_before_ = std::move(places_);
    places_ = std::move(to);
    return true;
}

void SoftPins::undo() {
    solver_.update(places_before_);
    places_ = places_before_;
    map_ = map_before_;
}

ExtremalMap SoftPins::settle() {
    const double s = width();
    const auto n = static_cast<Eigen::Index>(places_.size());
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i)
        hessian.diagonal().segment<2>(2 * i).setConstant(1 / (s * s) +
                                                         (std::isfinite(weights_[i]) ? 2 * weights_[i] : 0));
    balance(*this, std::move(hessian), kLongestMove * s, 2);
    return map_;
}

}  // namespace beltrami
