#pragma once

#include "surface.h"

namespace beltrami::python {

/// A surface with the circle domains that it keeps, as a tuple that can be pickled, and back.
py::tuple state_of(const SurfaceObject& surface);
SurfacePtr surface_from_state(const py::tuple& state);

}  // namespace beltrami::python
