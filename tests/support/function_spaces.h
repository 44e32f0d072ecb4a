#pragma once

// Distances between spaces of functions known at points.

#include <cmath>
#include <vector>

#include <beltrami/linear/decomposition.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami::test {

/// Orthonormal columns that span the real combinations of given complex columns, in the mean square with weights.
inline Eigen::MatrixXd orthonormal(const Eigen::MatrixXcd& values, const Eigen::VectorXd& weights) {
    Eigen::MatrixXd columns(2 * values.rows(), values.cols());
    const Eigen::VectorXd roots = weights.cwiseSqrt();
    columns << roots.asDiagonal() * values.real(), roots.asDiagonal() * values.imag();
    return orthonormal_columns(columns);
}

/// Sine of the largest principal angle between real combinations of two sets of columns.
inline double angle_between(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b, const Eigen::VectorXd& weights) {
    const Eigen::MatrixXd A = orthonormal(a, weights), B = orthonormal(b, weights);
    return singular_values(A - B * (B.transpose() * A))[0];
}

/// Areas, falling to 0 within a distance of the marks: the square of 1/z is not integrable.
inline Eigen::VectorXd weights_of(const std::vector<double>& areas, const Eigen::VectorXcd& positions,
                                  const std::vector<Complex>& marks, double distance = 0.3) {
    Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(areas.data(), static_cast<Eigen::Index>(areas.size()));
    for (Eigen::Index s = 0; s < weights.size(); ++s)
        for (const Complex p : marks) weights[s] *= std::min(1.0, std::abs(positions[s] - p) / distance);
    return weights;
}

}  // namespace beltrami::test
