#pragma once

#include <beltrami/constraints/target_constraints.h>
#include <beltrami/targets/mesh_target.h>

#include "surface.h"

namespace beltrami::python {

using TargetPtr = std::shared_ptr<Target>;

/// A MeshTarget, or a mesh or surface as one. @throw TypeError, Error bad_mesh
std::shared_ptr<MeshTarget> mesh_target_of(const py::object& object);
/// Any target; a mesh or surface as one, a domain of the plane as one.
TargetPtr target_of(const py::object& object);
/// Constraints, or none at all for None.
TargetConstraints target_constraints_of(const py::object& object);
/// A TargetMap, or the map of points near the target; None: of the source's own vertices.
/// @throw Error bad_option unless it fits the source and the constraints
TargetMap start_on(const SurfacePtr& source, const Target& target, const TargetConstraints& constraints,
                   const py::object& start);

}  // namespace beltrami::python
