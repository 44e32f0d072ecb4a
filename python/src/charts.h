#pragma once

#include <beltrami/plane/circle_domain.h>

#include "surface.h"

namespace beltrami::python {

/// (loop, centre, radius).
py::tuple hole_tuple(const RoundHole& hole);
/// Of (loop, centre, radius) or (centre, radius). @throw TypeError; Error bad_option unless it lies within the unit
/// disk
RoundHole hole_from(const py::handle& object);

}  // namespace beltrami::python
