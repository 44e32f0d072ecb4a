#include <beltrami/charts/boundary_values.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/constraints/prescribed_split.h>

#include "constraints.h"
#include "module.h"

namespace beltrami::python {

namespace {

BoundaryPlacement placement(const SurfacePtr& surface, const std::optional<int>& start, const std::string& speed,
                            int loop) {
    require_loop(*surface, loop);
    return {start,
            Keywords::choice<BoundarySpeed>(
                "speed", py::str(speed),
                {{"arclength", BoundarySpeed::arclength}, {"conformal", BoundarySpeed::conformal}}),
            loop, &surface->shape};
}

constexpr const char* kPlacement =
    "start: the boundary vertex at angle 0, the first corner or point (None: the smallest). speed: \"arclength\", or "
    "\"conformal\", gentle at corners. loop: the boundary loop around the others.\n\nRaises BadOption, BadBoundary.";

CornerOptions corner_options(const py::kwargs& given) {
    CornerOptions options;
    Keywords keywords(given);
    keywords.take("min_turn", options.min_turn);
    keywords.take("min_log_speed", options.min_log_speed);
    keywords.take("min_exponent", options.min_exponent);
    keywords.take("confidence", options.confidence);
    keywords.finish();
    return options;
}

py::tuple split_tuple(SplitProblem split) {
    return py::make_tuple(make_surface(std::move(split.mesh), std::move(split.metric)), parents_array(split.parents),
                          index_array(split.face_parents));
}

}  // namespace

void bind_boundary(py::module_& m) {
    m.def(
        "boundary_to_disk",
        [](const SurfacePtr& surface, double amplitude, const std::optional<int>& start, const std::string& speed,
           int loop) {
            const BoundaryPlacement where = placement(surface, start, speed, loop);
            return without_lock([&] { return boundary_to_disk(surface->surface, amplitude, where); });
        },
        py::arg("surface"), py::arg("amplitude") = 0.0, py::kw_only(), py::arg("start") = py::none(),
        py::arg("speed") = "arclength", py::arg("loop") = 0,
        (std::string(
             "A loop to the unit circle: t = 2π · arc length / total goes to exp(i(t + amplitude·sin t)).\n\n") +
         kPlacement)
            .c_str());
    m.def(
        "boundary_to_rectangle",
        [](const SurfacePtr& surface, double width, double height, const std::optional<std::array<int, 4>>& corners,
           const std::optional<int>& start, const std::string& speed, int loop) {
            const BoundaryPlacement where = placement(surface, start, speed, loop);
            return without_lock([&] { return boundary_to_rectangle(surface->surface, width, height, corners, where); });
        },
        py::arg("surface"), py::arg("width") = 1.0, py::arg("height") = 1.0, py::arg("corners") = py::none(),
        py::kw_only(), py::arg("start") = py::none(), py::arg("speed") = "arclength", py::arg("loop") = 0,
        (std::string("A loop to the rectangle [0,width]×[0,height]; corners: four boundary vertices, counter-clockwise "
                     "(None: as fits the rectangle).\n\n") +
         kPlacement)
            .c_str());
    m.def(
        "boundary_to_polygon",
        [](const SurfacePtr& surface, const py::object& polygon, const std::optional<int>& start,
           const std::string& speed, int loop) {
            const BoundaryPlacement where = placement(surface, start, speed, loop);
            const std::vector<Complex> corners = complex_list(polygon, "polygon");
            return without_lock([&] { return boundary_to_polygon(surface->surface, corners, where); });
        },
        py::arg("surface"), py::arg("polygon"), py::kw_only(), py::arg("start") = py::none(),
        py::arg("speed") = "arclength", py::arg("loop") = 0,
        (std::string("A loop to a simple closed polygon of n complex or n×2 points, counter-clockwise.\n\n") +
         kPlacement)
            .c_str());
    m.def(
        "hole_to_circle",
        [](const SurfacePtr& surface, int loop, Complex centre, double radius, double start_angle) {
            require_loop(*surface, loop);
            return hole_to_circle(surface->surface, loop, centre, radius, start_angle);
        },
        py::arg("surface"), py::arg("loop"), py::arg("centre"), py::arg("radius"), py::arg("start_angle") = 0.0,
        "A hole to a circle by arc length, its smallest vertex at start_angle (radians).\n\nRaises BadOption.");
    m.def(
        "unprescribed_boundary",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary) {
            validate(boundary, surface->surface);
            return index_array(unprescribed_boundary(boundary, surface->surface));
        },
        py::arg("surface"), py::arg("boundary"), "Boundary vertices that are not prescribed, loop by loop.");
    m.def(
        "require_feasible",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, int outer_loop) {
            validate(boundary, surface->surface);
            without_lock([&] {
                require_feasible(surface->surface, boundary, outer_loop);
                return 0;
            });
        },
        py::arg("surface"), py::arg("boundary"), py::arg("outer_loop") = 0,
        "Raises BadBoundary, with the vertices as indices, for boundary values that no one-to-one, "
        "orientation-preserving "
        "map has: loops that cross themselves or each other, run the wrong way round, coinciding images, …");

    py::class_<BoundaryCorner>(m, "BoundaryCorner",
                               "A boundary vertex at which source, image or speed is not smooth; angles in radians.")
        .def_readonly("loop", &BoundaryCorner::loop)
        .def_readonly("position", &BoundaryCorner::position)
        .def_readonly("vertex", &BoundaryCorner::vertex)
        .def_readonly("source_angle", &BoundaryCorner::source_angle)
        .def_readonly("image_angle", &BoundaryCorner::image_angle)
        .def_readonly("speed_out", &BoundaryCorner::speed_out)
        .def_readonly("speed_in", &BoundaryCorner::speed_in)
        .def_readonly("exponent", &BoundaryCorner::exponent)
        .def_readonly("significance", &BoundaryCorner::significance)
        .def_readonly("corner_bound", &BoundaryCorner::corner_bound, "K* ≥ this for the limiting data")
        .def_readonly("safe_bound", &BoundaryCorner::safe_bound)
        .def("__repr__", [](const BoundaryCorner& corner) {
            return "<beltrami.BoundaryCorner: vertex " + std::to_string(corner.vertex) + ", K* ≥ " +
                   std::to_string(corner.corner_bound) + ">";
        });
    m.def("edges_to_next_corner", &edges_to_next_corner, py::arg("corner"), py::arg("corners"), py::arg("loop_size"),
          "Edges from a BoundaryCorner to the nearest other one of its loop, at most half the loop.\n\nloop_size: "
          "vertices of the loop.");
    m.def(
        "find_corners",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, const py::kwargs& given) {
            const CornerOptions options = corner_options(given);
            validate(boundary, surface->surface);
            return find_corners(surface->surface, boundary, options);
        },
        py::arg("surface"), py::arg("boundary"),
        "The corners of all loops, by decreasing significance.\n\nOptions: min_turn=0.1 (radians), min_log_speed=0.1, "
        "min_exponent=0.08, confidence=4 (standard deviations).");
    m.def(
        "measure_boundary_point",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, int loop, int position,
           const py::kwargs& given) {
            const CornerOptions options = corner_options(given);
            validate(boundary, surface->surface);
            return measure_boundary_point(surface->surface, boundary, loop, position, options);
        },
        py::arg("surface"), py::arg("boundary"), py::arg("loop"), py::arg("position"),
        "The same fit at one vertex, significant or not.\n\nRaises BadOption if there is no such loop or position.");
    m.def("corner_bound", &corner_bound, py::arg("source_angle"), py::arg("image_angle"), py::arg("speed_out") = 1.0,
          py::arg("speed_in") = 1.0, py::arg("exponent") = 1.0,
          "The least dilatation of a map of a sector to another (angles in radians) with sides c1 s^p and c2 s^p.");
    m.def(
        "split_prescribed",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary) {
            validate(boundary, surface->surface);
            return split_tuple(split_prescribed(surface->surface, boundary));
        },
        py::arg("surface"), py::arg("boundary"),
        "The surface with edges split that a prescription would nail down, the n×4 old vertices whose mean each added "
        "vertex is (-1: none), and the old face of each face.");
    m.def(
        "split_bridges", [](const SurfacePtr& surface) { return split_tuple(split_bridges(surface->surface)); },
        py::arg("surface"), "The same for the edges inside that join two boundary vertices.");
}

}  // namespace beltrami::python
