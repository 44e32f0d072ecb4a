#pragma once

#include <algorithm>
#include <cmath>

#include <beltrami/base/complex.h>

namespace beltrami {

/// A place of the unit disk, in which geodesics of the hyperbolic plane are circles, in Klein's model, where they are
/// straight; and back.
inline Complex to_klein(Complex place) {
    return 2.0 * place / (1 + std::norm(place));
}
inline Complex from_klein(Complex place) {
    return place / (1 + std::sqrt(std::max(0.0, 1 - std::norm(place))));
}

}  // namespace beltrami
