#include <beltrami/differentials/polynomial_space.h>

#include <algorithm>
#include <array>
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

namespace {

/// Points worked through side by side, so that the compiler can use vectors.
constexpr int kSide = 32;

/// Real and imaginary parts of some complex numbers.
struct Parts {
    alignas(64) std::array<double, kSide> re, im;
    void set(int i, Complex value) {
        re[i] = value.real();
        im[i] = value.imag();
    }
    void clear() {
        re.fill(0);
        im.fill(0);
    }
    /// this = this · z + c
    void multiply(const Parts& z, Complex c = 0) {
        for (int i = 0; i < kSide; ++i) {
            const double next = re[i] * z.re[i] - im[i] * z.im[i] + c.real();
            im[i] = re[i] * z.im[i] + im[i] * z.re[i] + c.imag();
            re[i] = next;
        }
    }
    Complex sum() const {
        double x = 0, y = 0;
        for (int i = 0; i < kSide; ++i) {
            x += re[i];
            y += im[i];
        }
        return {x, y};
    }
};

}  // namespace

Eigen::VectorXcd PolynomialSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    Eigen::VectorXcd scaled = coefficients;
    for (int j = 0; j < size(); ++j) scaled[j] *= norm_factor(j);
    Eigen::VectorXcd values(points.positions.size());
    parallel_for(0, static_cast<int>(points.positions.size()), [&](int begin, int end) {
        Parts z, value;
        for (int first = begin; first < end; first += kSide) {
            const int count = std::min(kSide, end - first);
            z.clear();
            value.clear();
            for (int i = 0; i < count; ++i) z.set(i, points.positions[first + i]);
            for (int j = degree_; j >= 0; --j) value.multiply(z, scaled[j]);
            for (int i = 0; i < count; ++i) {
                const Complex derivative = points.derivatives[first + i];
                values[first + i] = Complex(value.re[i], value.im[i]) * derivative * derivative;
            }
        }
    });
    return values;
}

Eigen::MatrixXcd PolynomialSpace::pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const {
    const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(size(), weights.cols());
    Eigen::MatrixXcd sums = parallel_sum<Eigen::MatrixXcd>(
        static_cast<int>(points.positions.size()), zero, [&](int begin, int end) -> Eigen::MatrixXcd {
            Eigen::MatrixXcd part = zero;
            Parts z, term;
            for (int first = begin; first < end; first += kSide) {
                const int count = std::min(kSide, end - first);
                z.clear();
                for (int i = 0; i < count; ++i) z.set(i, points.positions[first + i]);
                for (Eigen::Index column = 0; column < weights.cols(); ++column) {
                    term.clear();
                    for (int i = 0; i < count; ++i) {
                        const Complex derivative = points.derivatives[first + i];
                        term.set(i, weights(first + i, column) * derivative * derivative);
                    }
                    for (int j = 0; j <= degree_; ++j, term.multiply(z)) part(j, column) += term.sum();
                }
            }
            return part;
        });
    for (int j = 0; j < size(); ++j) sums.row(j) *= norm_factor(j);
    return sums;
}

std::unique_ptr<DifferentialSpace> PolynomialSpace::refined() const {
    if (degree_ >= largest_degree_) return nullptr;
    return std::make_unique<PolynomialSpace>(std::min(degree_ + std::max(4, degree_ / 2), largest_degree_),
                                             largest_degree_);
}

}  // namespace beltrami
