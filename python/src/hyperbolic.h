#pragma once

#include <mutex>

#include <beltrami/teichmuller/hyperbolic_map.h>

#include "surface.h"

namespace beltrami::python {

/// A shape with the surface that it refers to.
struct ShapeObject {
    SurfacePtr surface;
    HyperbolicShape shape;
    std::mutex mutex;  // differentials are worked out by one thread

    explicit ShapeObject(const SurfacePtr& of) : surface(of), shape(of->surface) {}
};
using ShapePtr = std::shared_ptr<ShapeObject>;

/// @throw TypeError unless it is a HyperbolicShape or a Surface, of which one is made
ShapePtr shape_from(const py::object& object);

}  // namespace beltrami::python
