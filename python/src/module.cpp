#include "module.h"

#include <beltrami/base/effort.h>
#include <beltrami/base/parallel.h>
#include <beltrami/version.h>

#include "calls.h"
#include "none.h"

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
    bind_least_maximum(m);
    bind_between(m);
    bind_solver(m);
    bind_baselines(m);
    bind_charts(m);
    bind_flow(m);
    bind_distance(m);
    bind_grids(m);
    bind_pictures(m);
    bind_homotopy(m);
    bind_locate(m);
    bind_moebius(m);
    bind_beltrami_solver(m);
    bind_bounds(m);
    bind_space_maps(m);
    bind_sphere(m);
    bind_forms(m);
    bind_tori(m);
    bind_hyperbolic_shapes(m);
    bind_hyperbolic(m);
    bind_transfer(m);
    bind_registration(m);
    bind_space_targets(m);
    bind_surface_flow(m);
    bind_remeshing(m);
    bind_least_squares(m);
    bind_deform(m);
    bind_differentials(m);
    m.def("set_thread_count", &beltrami::set_thread_count, pybind11::arg("count"),
          "How many threads the library may use. Results do not depend on it, to the last bit.\n\n"
          "Raises BadOption if count < 1.");
    m.def(
        "effort",
        [] {
            pybind11::dict counts;
            counts["domain_chart"] = beltrami::effort(beltrami::Work::domain_chart);
            counts["circle_chart"] = beltrami::effort(beltrami::Work::circle_chart);
            counts["factorization"] = beltrami::effort(beltrami::Work::factorization);
            return counts;
        },
        "How often costly things have been done since the program began, by all threads together: {\"domain_chart\", "
        "\"circle_chart\", \"factorization\"}.");
    m.def("thread_count", &beltrami::thread_count, "Threads that the library uses.");
    refuse_none(m);
}
