#pragma once

#include <pybind11/pybind11.h>

/// The rooms of the module, each with functions and classes of one subject.
namespace beltrami::python {

void bind_places(pybind11::module_& m);
void bind_surface(pybind11::module_& m);
void bind_mesh(pybind11::module_& m);
void bind_edits(pybind11::module_& m);
void bind_files(pybind11::module_& m);
void bind_generate(pybind11::module_& m);
void bind_targets(pybind11::module_& m);
void bind_constraints(pybind11::module_& m);
void bind_boundary(pybind11::module_& m);
void bind_maps(pybind11::module_& m);
void bind_extremal(pybind11::module_& m);
void bind_least_maximum(pybind11::module_& m);
void bind_between(pybind11::module_& m);
void bind_solver(pybind11::module_& m);
void bind_baselines(pybind11::module_& m);
void bind_distortion(pybind11::module_& m);
void bind_differentials(pybind11::module_& m);
void bind_charts(pybind11::module_& m);
void bind_flow(pybind11::module_& m);
void bind_distance(pybind11::module_& m);
void bind_grids(pybind11::module_& m);
void bind_pictures(pybind11::module_& m);
void bind_homotopy(pybind11::module_& m);
void bind_sphere(pybind11::module_& m);
void bind_tori(pybind11::module_& m);
void bind_registration(pybind11::module_& m);
void bind_space_maps(pybind11::module_& m);
void bind_forms(pybind11::module_& m);
void bind_transfer(pybind11::module_& m);
void bind_hyperbolic_shapes(pybind11::module_& m);
void bind_hyperbolic(pybind11::module_& m);
void bind_space_targets(pybind11::module_& m);
void bind_surface_flow(pybind11::module_& m);
void bind_remeshing(pybind11::module_& m);
void bind_least_squares(pybind11::module_& m);
void bind_deform(pybind11::module_& m);
void bind_beltrami_solver(pybind11::module_& m);
void bind_bounds(pybind11::module_& m);
void bind_locate(pybind11::module_& m);
void bind_moebius(pybind11::module_& m);

}  // namespace beltrami::python
