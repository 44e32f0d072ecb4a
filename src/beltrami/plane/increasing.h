#pragma once

#include <vector>

namespace beltrami {

/// Makes the nearly increasing values of a closed loop increasing: where they run backwards they are pooled (isotonic
/// regression), and a pool is spread evenly by arc length between the middles of the gaps on both sides. Pools reach
/// across the start.
/// @param values rise by @p period around the loop
/// @param arc    one more than values: the last is the total
void make_increasing(std::vector<double>& values, double period, const std::vector<double>& arc);

/// Raises the increments of a closed loop that are below a part of the mean of those around them, four on either side
/// or, where these are all 0, as many as it takes. An outline that a conformal map crowds has increments of any size,
/// that of its slots 1e-12 of the others: what is too small is known from the neighbours, never from the whole.
/// @param increments not negative, some positive; their sum grows
void raise_to_neighbours(std::vector<double>& increments, double part);

}  // namespace beltrami
