#pragma once

#include <beltrami/registration/transfer.h>

#include "space_map.h"

namespace beltrami::python {

/// A surface of genus 0 carried onto another one.
class RegistrationObject final : public CarriedObject {
  public:
    RegistrationObject(const SurfacePtr& source, const CarriedSurface& carried, Distortion distortion, Record record)
        : CarriedObject(source, "registration", carried, std::move(distortion), std::move(record)) {}

    Eigen::VectorXcd phi;
    std::shared_ptr<SurfaceCorrespondence> correspondence;  ///< of closed surfaces
};
using RegistrationPtr = std::shared_ptr<RegistrationObject>;

/// Values of the vertices, or faces, of one surface at the other. @throw Error bad_option unless there is one for each
Positions transferred_values(const SurfaceCorrespondence& map, const py::object& values, bool to_source, bool of_faces);
/// @throw Error bad_option naming places that are not on the mesh
Places carried_places(const SurfaceCorrespondence& map, const Places& places, bool to_source);

}  // namespace beltrami::python
