#include "module.h"

#include <beltrami/base/parallel.h>
#include <beltrami/version.h>

#include "arrays.h"

PYBIND11_MODULE(_core, m) {
    using namespace beltrami::python;
    m.doc() = "The library in C++, as Python sees it.";
    m.attr("__version__") = BELTRAMI_VERSION_TEXT;
    bind_errors(m);
    bind_places(m);
    bind_mesh(m);
    bind_surface(m);
    bind_edits(m);
    bind_generate(m);
    bind_targets(m);
    bind_files(m);
    bind_constraints(m);
    bind_boundary(m);
    bind_distortion(m);
    bind_maps(m);
    bind_extremal(m);
    bind_solver(m);
    bind_baselines(m);
    bind_charts(m);
    bind_flow(m);
    bind_distance(m);
    bind_grids(m);
    bind_homotopy(m);
    bind_sphere(m);
    bind_tori(m);
    bind_registration(m);
    bind_differentials(m);
    m.def("set_thread_count", &beltrami::set_thread_count, pybind11::arg("count"),
          "How many threads the library may use. Results do not depend on it, to the last bit.\n\n"
          "Raises BadOption if count < 1.");
    m.def("thread_count", &beltrami::thread_count, "Threads that the library uses.");
}
