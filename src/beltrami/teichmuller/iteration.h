#pragma once

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// One iteration in the history of an extremal map.
struct Iteration {
    double k;            ///< of the c-step
    double change;       ///< of the direction of φ since the last iteration
    int functions;       ///< dimension of the space of differentials
    double largest = 0;  ///< |μ| of the map, above 1 where it is folded; 0 before the first map is known
};

}  // namespace beltrami
