#pragma once

#include <limits>
#include <numbers>

#include <beltrami/base/complex.h>

namespace beltrami {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTurn = 2 * std::numbers::pi;  ///< all the way round, in radians
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr Complex kI(0, 1);

}  // namespace beltrami
