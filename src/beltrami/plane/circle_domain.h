#pragma once

#include <span>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A hole of a circle domain: the unit disk less round holes.
struct RoundHole {
    int loop = -1;  ///< the boundary loop of the surface that goes to its circle; −1 if there is no surface
    Complex centre = 0;
    double radius = 0;
};

/// The least distance between two circles of a circle domain, the unit circle among them, relative to the radius of the
/// smaller one: negative where two circles cross or a hole reaches out of the unit disk. 1 without holes.
double least_gap(std::span<const RoundHole> holes);

}  // namespace beltrami
