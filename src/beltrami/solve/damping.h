#pragma once

namespace beltrami {

/// The damping of Gauss-Newton steps that move along a surface: raised where a step was shortened to less than kShort,
/// lowered where it went nearly all the way.
inline constexpr double kShort = 0.3, kNearlyFull = 0.9;
inline constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-5, kDampingFactor = 4;

}  // namespace beltrami
