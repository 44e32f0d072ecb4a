#include <beltrami/teichmuller/elongation.h>

#include <algorithm>
#include <cmath>

#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// Mean |μ| from which on a map counts as elongated: K about 7.
constexpr double kElongated = 0.75;
/// The least and the largest |μ| at which coefficients are held, and the part of the way to 1 that is room.
constexpr double kLeastElongatedClip = 0.95, kMostElongatedClip = 0.9999, kRoom = 0.5;
constexpr int kDegree = 8;
/// Samples below which so many functions would fit anything.
constexpr int kLeastSamplesOfDegree = 10 * (3 + kDegree + 1);

}  // namespace

bool is_elongated(const Operators& operators, const Eigen::VectorXcd& harmonic) {
    if (operators.sample_count() < kLeastSamplesOfDegree) return false;
    double sum = 0;
    const Eigen::VectorXcd mu = beltrami_coefficient(operators, harmonic);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const double size = std::abs(mu[s]);
        if (size < 1) sum += operators.weights[s] * size;  // what is turned over tells nothing
    }
    return sum > kElongated * operators.area();
}

double clip_of_elongated(const Operators& operators, const Eigen::VectorXcd& harmonic) {
    double largest = 0;
    for (const Complex mu : beltrami_coefficient(operators, harmonic))
        if (std::abs(mu) < 1) largest = std::max(largest, std::abs(mu));
    return std::clamp(1 - kRoom * (1 - largest), kLeastElongatedClip, kMostElongatedClip);
}

std::unique_ptr<DifferentialSpace> harmonic_square_space(const Surface& source, const Chart& chart,
                                                         const Eigen::VectorXcd& harmonic) {
    const int samples = source.operators.sample_count();
    Eigen::MatrixXcd values(samples, 3 + kDegree + 1);
    values.rightCols(kDegree + 1) = PolynomialSpace(kDegree, kDegree).evaluate({chart.positions, chart.derivatives});
    for (int s = 0; s < samples; ++s) {
        const auto [dz, dzbar] = source.operators.derivatives(s, harmonic);
        const Complex of_u = 0.5 * (dz + std::conj(dzbar)), of_v = Complex(0, -0.5) * (dz - std::conj(dzbar));
        values.row(s).head(3) << of_u * of_u, of_u * of_v, of_v * of_v;
        if (chart.excluded[s]) values.row(s).setZero();
    }
    for (Eigen::Index j = 0; j < values.cols(); ++j) {  // to one size, ∫|φ_j| = 1
        double size = 0;
        for (int s = 0; s < samples; ++s) size += source.operators.weights[s] * std::abs(values(s, j));
        if (size > 0) values.col(j) /= size;
    }
    return std::make_unique<TabulatedSpace>(std::move(values), Coefficients::complex);
}

}  // namespace beltrami
