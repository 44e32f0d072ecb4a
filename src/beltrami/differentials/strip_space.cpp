#include <beltrami/differentials/strip_space.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

/// e^{inw}, and e^{−in(w − iY)}: both are 1 along one rim, and have the square π (1 − e^{−2nY})/n.
StripSpace::StripSpace(int degree, double height) : degree_(degree), height_(height), factors_(degree + 1) {
    factors_[0] = 1 / std::sqrt(kTurn * height);
    for (int n = 1; n <= degree; ++n) factors_[n] = std::sqrt(2 * n / (kTurn * -std::expm1(-2 * n * height)));
}

Eigen::MatrixXcd StripSpace::generators(const ChartPoints& points) const {
    Eigen::MatrixXcd values(points.positions.size(), size());
    parallel_for(0, static_cast<int>(points.positions.size()), [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const Complex w = points.positions[i], square = points.derivatives[i] * points.derivatives[i];
            values(i, 0) = factors_[0] * square;
            for (int n = 1; n <= degree_; ++n) {
                const Complex turn = std::polar(factors_[n], n * w.real());
                values(i, 2 * n - 1) = square * turn * std::exp(-n * w.imag());
                values(i, 2 * n) = square * std::conj(turn) * std::exp(n * (w.imag() - height_));
            }
        }
    });
    return values;
}

}  // namespace beltrami
