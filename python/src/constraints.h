#pragma once

#include <beltrami/constraints/constraints.h>

#include "surface.h"

namespace beltrami::python {

/// Constraints, and the surface that is their target, if one is.
struct ConstraintsObject {
    Constraints constraints;
    SurfacePtr target;
};

/// From Constraints, BoundaryCondition, TargetDomain or Surface (onto which the boundary slides).
ConstraintsObject constraints_of(const py::object& object);

/// outer_loop, loops, match_by, marks, turns, waypoints.
void take_correspondence(Keywords& keywords, Correspondence& correspondence);

}  // namespace beltrami::python
