#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// scale^power/(z − centre)^power; power < 0: the polynomial ((z − centre)/scale)^(−power); power 0: 1.
struct Pole {
    Complex centre;
    double scale;
    int power;
};

/// Sums over many poles and points, without a matrix of their values: computing one costs as little as fetching it.
/// Compiled for the vector units of several processors, one of which is chosen when the program starts.
///
/// Successive powers with one centre and scale share their work.

/// Σ_j c_j p_j(z_i), for every point.
/// @param z            #points
/// @param coefficients #poles
Eigen::VectorXcd pole_combination(const std::vector<Pole>& poles, const Eigen::VectorXcd& z,
                                  const Eigen::VectorXcd& coefficients);

/// Σ_i w(i, column) p_j(z_i), for every pole: #poles × #columns.
/// @param weights #points × #columns
Eigen::MatrixXcd pole_pairing(const std::vector<Pole>& poles, const Eigen::VectorXcd& z,
                              const Eigen::MatrixXcd& weights);

/// p_j(z_i): #points × #poles.
Eigen::MatrixXcd pole_values(const std::vector<Pole>& poles, const Eigen::VectorXcd& z);

}  // namespace beltrami
