#pragma once

#include <vector>

namespace beltrami {

/// Makes the nearly increasing values of a closed loop increasing: where they run backwards they are pooled (isotonic
/// regression), and a pool is spread evenly by arc length between the middles of the gaps on both sides. Pools reach
/// across the start.
/// @param values rise by @p period around the loop
/// @param arc    one more than values: the last is the total
void make_increasing(std::vector<double>& values, double period, const std::vector<double>& arc);

}  // namespace beltrami
