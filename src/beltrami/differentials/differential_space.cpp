#include <beltrami/differentials/differential_space.h>

#include <beltrami/linear/dense.h>

// Here and not in the header: as virtual functions these would be compiled in every file that sees the class.

namespace beltrami {

Eigen::VectorXcd DifferentialSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    return generators(points) * of_generators(coefficients);
}

Eigen::MatrixXcd DifferentialSpace::pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const {
    return from_generators(generators(points).transpose() * weights);
}

Eigen::MatrixXcd DifferentialSpace::evaluate(const ChartPoints& points) const {
    return transform() ? complex_product(generators(points), *transform()) : generators(points);
}

Eigen::VectorXcd DifferentialSpace::of_generators(const Eigen::VectorXcd& coefficients) const {
    return transform() ? Eigen::VectorXcd(*transform() * coefficients) : coefficients;
}

Eigen::MatrixXcd DifferentialSpace::from_generators(const Eigen::MatrixXcd& of_generators) const {
    return transform() ? Eigen::MatrixXcd(transform()->transpose() * of_generators) : of_generators;
}

}  // namespace beltrami
