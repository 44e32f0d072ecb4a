#pragma once

#include <memory>

#include <beltrami/charts/shape.h>
#include <beltrami/operators/surface.h>

#include "arrays.h"

namespace beltrami::python {

/// A surface and its charts, each made once.
struct SurfaceObject {
    Surface surface;
    Shape shape;

    explicit SurfaceObject(Surface made) : surface(std::move(made)), shape(surface) {}
    int vertex_count() const { return surface.mesh.vertex_count(); }
    int sample_count() const { return surface.operators.sample_count(); }
};
using SurfacePtr = std::shared_ptr<SurfaceObject>;

SurfacePtr make_surface(Mesh mesh, std::optional<Positions> metric = {});

/// A mesh whose vertices are finite and whose faces are triangles and quads of vertices that exist.
/// @throw Error bad_mesh naming what is not so
Mesh checked(Mesh mesh);

/// A map of the vertices to the plane. @throw Error bad_option unless there is one number a vertex
Eigen::VectorXcd map_of(const SurfaceObject& surface, const py::object& map, const char* name = "map");
/// #S numbers of the samples, or #F of the faces in the samples' frames.
Eigen::VectorXcd samples_of(const SurfaceObject& surface, const py::object& values, const char* name);
/// The surface, or, where its positions have two coordinates, the same with z = 0.
SurfacePtr in_space(const SurfacePtr& surface);
/// Copies of surfaces that are to be compared. @throw TypeError; Error bad_option unless names are none or one for each
std::vector<Surface> surfaces_of(const std::vector<SurfacePtr>& surfaces, const std::vector<std::string>& names);
/// @throw Error bad_option unless the surface has the loop
void require_loop(const SurfaceObject& surface, int loop);

}  // namespace beltrami::python
