#pragma once

#include <pybind11/pybind11.h>

namespace beltrami::python {

/// Makes None a TypeError for every argument of the module's functions and classes, but for those whose default it is:
/// a shared pointer would be null.
void refuse_none(const pybind11::module_& m);

}  // namespace beltrami::python
