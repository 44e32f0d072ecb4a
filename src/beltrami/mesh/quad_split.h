#pragma once

#include <Eigen/Core>
#include <array>

#include <beltrami/base/complex.h>

namespace beltrami {

/// The two triangles, as corners 0 … 3, that stand for a quad where only triangles will do: (a, b, c), (a, c, d) along
/// its shorter diagonal (of equals, the one from corner 0), or along the other one if the shorter folds the quad, as it
/// may beside a reflex corner. Both run around as the quad does.
std::array<std::array<int, 3>, 2> split_quad(const std::array<Eigen::Vector3d, 4>& corners);

/// The same of a quad in the plane along the diagonal that lies inside it (of two, the one from corner 0), also where a
/// corner is reflex.
std::array<std::array<int, 3>, 2> split_inside(const std::array<Complex, 4>& corners);

}  // namespace beltrami
