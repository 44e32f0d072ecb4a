#include <beltrami/plane/circle_fit.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace beltrami {

double CircleFit::ratio() const {
    return smallest > 0 ? largest / smallest : std::numeric_limits<double>::infinity();
}

CircleFit fit_circle(const std::vector<Complex>& points) {
    // About the mean, for conditioning.
    Complex mean = 0;
    for (const Complex z : points) mean += z;
    mean /= static_cast<double>(points.size());
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
    double scale = 0;
    for (const Complex z : points) scale = std::max(scale, std::abs(z - mean));
    for (const Complex z : points) {
        const Complex p = (z - mean) / scale;
        const Eigen::Vector3d row(2 * p.real(), 2 * p.imag(), 1);
        normal += row * row.transpose();
        rhs += row * std::norm(p);
    }
    const Eigen::Vector3d fit = normal.ldlt().solve(rhs);
    CircleFit result;
    result.centre = mean + scale * Complex(fit[0], fit[1]);
    result.radius = scale * std::sqrt(std::max(0.0, fit[2] + fit[0] * fit[0] + fit[1] * fit[1]));
    result.smallest = std::numeric_limits<double>::infinity();
    for (const Complex z : points) {
        const double distance = std::abs(z - result.centre);
        result.smallest = std::min(result.smallest, distance);
        result.largest = std::max(result.largest, distance);
    }
    return result;
}

}  // namespace beltrami
