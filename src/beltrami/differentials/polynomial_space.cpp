#include <beltrami/differentials/polynomial_space.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

double norm_factor(int j) {
    return std::sqrt((j + 1) / std::numbers::pi);
}

}  // namespace

PolynomialSpace::PolynomialSpace(int degree, int largest_degree) : degree_(degree), largest_degree_(largest_degree) {}

int PolynomialSpace::largest_degree(int sample_count) {
    // A polynomial of degree d turns d times along the circle, which has about 3.5 √(samples) edges: keep 16 edges a
    // turn, and never more functions than smooth boundary data can ask for.
    return std::clamp(static_cast<int>(0.2 * std::sqrt(static_cast<double>(sample_count))), 4, 40);
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
            values.col(j).segment(begin, count) = norm_factor(j) * power;
            power.array() *= points.positions.segment(begin, count).array();
        }
    });
    return values;
}

Eigen::VectorXcd PolynomialSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    Eigen::VectorXcd scaled = coefficients;
    for (int j = 0; j < size(); ++j) scaled[j] *= norm_factor(j);
    Eigen::VectorXcd values(points.positions.size());
    parallel_for(0, static_cast<int>(points.positions.size()), [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const Complex z = points.positions[i];
            double re = 0, im = 0;
            for (int j = degree_; j >= 0; --j) {
                const double next = re * z.real() - im * z.imag() + scaled[j].real();
                im = re * z.imag() + im * z.real() + scaled[j].imag();
                re = next;
            }
            values[i] = Complex(re, im) * points.derivatives[i] * points.derivatives[i];
        }
    });
    return values;
}

std::unique_ptr<DifferentialSpace> PolynomialSpace::refined() const {
    if (degree_ >= largest_degree_) return nullptr;
    return std::make_unique<PolynomialSpace>(std::min(degree_ + std::max(4, degree_ / 2), largest_degree_),
                                             largest_degree_);
}

}  // namespace beltrami
