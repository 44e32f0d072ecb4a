#include <beltrami/differentials/polynomial_space.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/parallel.h>

namespace beltrami {

PolynomialSpace::PolynomialSpace(int degree, int largest_degree)
    : degree_(degree), largest_degree_(largest_degree), factors_(degree + 1) {
    for (int j = 0; j <= degree; ++j) {
        powers_.push_back({0.0, 1.0, -j});
        factors_[j] = std::sqrt((j + 1) / std::numbers::pi);
    }
}

int PolynomialSpace::largest_degree(int sample_count, int most) {
    // A polynomial of degree d turns d times along the circle, which has about 3.5 √(samples) edges: keep 16 edges a
    // turn.
    return std::clamp(static_cast<int>(0.2 * std::sqrt(static_cast<double>(sample_count))), 4, most);
}

std::unique_ptr<DifferentialSpace> PolynomialSpace::starting_space(int largest_degree) {
    return std::make_unique<PolynomialSpace>(std::min(8, largest_degree), largest_degree);
}

Eigen::MatrixXcd PolynomialSpace::generators(const ChartPoints& points) const {
    Eigen::MatrixXcd values(points.positions.size(), size());
    parallel_for(0, static_cast<int>(points.positions.size()), [&](int begin, int end) {
        const int count = end - begin;
        Eigen::VectorXcd power = points.derivatives.segment(begin, count).array().square();
        for (int j = 0; j <= degree_; ++j) {
            values.col(j).segment(begin, count) = factors_[j] * power;
            power.array() *= points.positions.segment(begin, count).array();
        }
    });
    return values;
}

Eigen::VectorXcd PolynomialSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    const Eigen::VectorXcd values =
        pole_combination(powers_, points.positions, factors_.cast<Complex>().cwiseProduct(coefficients));
    return values.cwiseProduct(points.derivatives.cwiseProduct(points.derivatives));
}

Eigen::MatrixXcd PolynomialSpace::pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const {
    const Eigen::VectorXcd square = points.derivatives.cwiseProduct(points.derivatives);
    return factors_.cast<Complex>().asDiagonal() *
           pole_pairing(powers_, points.positions, square.asDiagonal() * weights);
}

std::unique_ptr<DifferentialSpace> PolynomialSpace::refined() const {
    if (degree_ >= largest_degree_) return nullptr;
    return std::make_unique<PolynomialSpace>(std::min(degree_ + std::max(4, degree_ / 2), largest_degree_),
                                             largest_degree_);
}

}  // namespace beltrami
