#pragma once

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Corners of the faces (#corners×3) in the surface's metric, triangles that are flatter than a part of their longest
/// side raised to it: what is conformal on a needle decides about nothing.
Positions raised_corners(const Surface& source, double part = 0.01);

}  // namespace beltrami
