#pragma once

#include <cstdint>

#include "problems/problems.h"

namespace beltrami::bench {

/// A random problem that has a solution: smooth and polygonal outlines, 0 to 5 holes, meshes good and bad (jittered,
/// graded, coarse, stretched, thin triangles). The boundary values are those of an explicit homeomorphism of the plane,
/// as wild as it can be while the piecewise linear map between its values at the vertices, the problem's witness, keeps
/// max |μ| below a random bound of at most 0.95 and the images of the loops are simple and disjoint. So a
/// one-to-one piecewise linear map of this mesh exists, and K* ≤ K of the homeomorphism.
///
/// The same seed gives the same problem everywhere, up to the rounding of the C library's functions.
Problem random_problem(std::uint64_t seed);

}  // namespace beltrami::bench
