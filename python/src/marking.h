#pragma once

#include <beltrami/registration/register_handles.h>

#include "surface.h"

namespace beltrami::python {

/// alignment, start, paths and images, twists: the class of maps between closed surfaces with handles.
HandleMarking take_marking(Keywords& keywords, const SurfaceObject& source, const SurfaceObject& target);
Alignment alignment_from(const py::object& word);
extern const char* const kMarking;

}  // namespace beltrami::python
