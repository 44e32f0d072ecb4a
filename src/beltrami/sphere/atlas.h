#pragma once

#include <array>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Two holomorphic charts of the sphere side by side in one plane: z, the projection from the south pole, for what lies
/// north of the equator, and kSouth + 1/z for the rest. Beyond the equator each goes on for a little.
namespace atlas {

/// The south pole's place; places with a real part above half of it belong to the southern chart.
constexpr double kSouth = 4;

/// Where a point is in one of the charts.
Complex place(const Eigen::Vector3d& point, bool south);

/// (ξ, η) with ξ/η = z, in which nothing happens at infinity: (z, 1) or (1, 1/z).
std::array<Complex, 2> spinor(Complex place);

/// The same of a point of the sphere, |ξ|² + |η|² = 1.
std::array<Complex, 2> unit_spinor(const Eigen::Vector3d& point);

/// Places of face corners (#corners), every face in the chart in which its middle lies.
/// @param points #V×3 unit vectors
Eigen::VectorXcd corner_places(const FaceList& faces, const Positions& points);

}  // namespace atlas

}  // namespace beltrami
