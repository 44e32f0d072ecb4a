#include "constraints.h"

#include "module.h"

namespace beltrami::python {

namespace {

Mark mark_of(const py::handle& object) {
    const auto tuple = object.cast<py::tuple>();
    if (tuple.size() == 2) return {tuple[0].cast<int>(), TargetVertex{tuple[1].cast<int>()}};
    if (tuple.size() == 3) return {tuple[0].cast<int>(), tuple[1].cast<int>(), tuple[2].cast<double>()};
    throw py::type_error("a mark is (vertex, curve, arc length), or (vertex, vertex of the target)");
}

Waypoint waypoint_of(const py::handle& object) {
    const auto tuple = object.cast<py::tuple>();
    if (tuple.size() != 3) throw py::type_error("a waypoint is (step, loop, position)");
    return {tuple[0].cast<int>(), tuple[1].cast<int>(), tuple[2].cast<Complex>()};
}

/// Lists of Python objects, read one by one; what does not fit is a TypeError that says what would.
template <class T>
std::vector<T> list_of(const py::object& object, T (*read)(const py::handle&), const char* what) {
    try {
        std::vector<T> result;
        for (const py::handle item : object) result.push_back(read(item));
        return result;
    } catch (const py::cast_error&) {
        throw py::type_error(what);
    }
}

ConstraintsObject make(const py::object& prescribed, const py::object& target, int target_outer_loop,
                       const py::kwargs& how) {
    ConstraintsObject result;
    Correspondence correspondence;
    Keywords keywords(how);
    take_correspondence(keywords, correspondence);
    keywords.finish();
    if (!prescribed.is_none()) result.constraints.prescribed = prescribed.cast<BoundaryCondition>();
    if (py::isinstance<TargetDomain>(target)) {
        result.constraints.target = target.cast<TargetDomain>();
    } else if (py::isinstance<SurfaceObject>(target)) {
        result.target = target.cast<SurfacePtr>();
        require_loop(*result.target, target_outer_loop);
        result.constraints.target = SurfaceTarget{&result.target->surface, target_outer_loop};
    } else if (!target.is_none()) {
        throw py::type_error("a target is a TargetDomain or a Surface");
    }
    result.constraints.correspondence = std::move(correspondence);
    return result;
}

}  // namespace

void take_correspondence(Keywords& keywords, Correspondence& correspondence) {
    keywords.take("outer_loop", correspondence.outer_loop);
    keywords.take("loops", correspondence.loops);
    keywords.choose<MatchBy>("match_by", correspondence.match_by,
                             {{"position", MatchBy::position}, {"size", MatchBy::size}});
    if (const py::object marks = keywords.taken("marks"))
        correspondence.marks =
            list_of<Mark>(marks, &mark_of, "marks are (vertex, curve, arc length), or (vertex, vertex of the target)");
    keywords.take("turns", correspondence.turns);
    if (const py::object waypoints = keywords.taken("waypoints"); waypoints && !waypoints.is_none())
        correspondence.waypoints = list_of<Waypoint>(waypoints, &waypoint_of, "waypoints are (step, loop, position)");
}

ConstraintsObject constraints_of(const py::object& object) {
    if (py::isinstance<ConstraintsObject>(object)) return object.cast<ConstraintsObject>();
    if (py::isinstance<BoundaryCondition>(object)) return {Constraints(object.cast<BoundaryCondition>()), nullptr};
    if (py::isinstance<TargetDomain>(object)) return {Constraints(object.cast<TargetDomain>()), nullptr};
    if (py::isinstance<SurfaceObject>(object)) {
        ConstraintsObject result;
        result.target = object.cast<SurfacePtr>();
        result.constraints.target = SurfaceTarget{&result.target->surface, 0};
        return result;
    }
    throw py::type_error(
        "constraints are Constraints, a BoundaryCondition, or a TargetDomain or Surface onto which the boundary "
        "slides");
}

void bind_constraints(py::module_& m) {
    py::class_<BoundaryCondition>(m, "BoundaryCondition",
                                  "What is prescribed about a map to the plane: vertices with their images, and "
                                  "vertices whose images are to lie on "
                                  "lines. Two of them are added with +.")
        .def(py::init([](const py::object& vertices, const py::object& images) {
                 BoundaryCondition boundary;
                 boundary.vertices = whole_numbers(vertices, "vertices");
                 boundary.images = complex_list(images, "images");
                 if (boundary.vertices.size() != boundary.images.size())
                     throw Error(Cause::bad_option,
                                 "there are " + std::to_string(boundary.vertices.size()) + " vertices and " +
                                     std::to_string(boundary.images.size()) + " images",
                                 "give an image for each");
                 return boundary;
             }),
             py::arg("vertices") = py::list(), py::arg("images") = py::list(),
             "vertices: n indices. images: n complex or n×2.")
        .def_property_readonly("vertices",
                               [](const BoundaryCondition& boundary) { return index_array(boundary.vertices); })
        .def_property_readonly("images",
                               [](const BoundaryCondition& boundary) { return complex_array(boundary.images); })
        .def_property_readonly(
            "lines",
            [](const BoundaryCondition& boundary) {
                py::list lines;
                for (const BoundaryCondition::Line& line : boundary.lines)
                    lines.append(py::make_tuple(line.vertex, line.point, line.direction));
                return lines;
            },
            "(vertex, point, direction) of each")
        .def(
            "pin",
            [](BoundaryCondition& boundary, int vertex, Complex image) -> BoundaryCondition& {
                boundary.pin(vertex, image);
                return boundary;
            },
            py::arg("vertex"), py::arg("image"), py::return_value_policy::reference, "Prescribes one more vertex.")
        .def(
            "pin_to_line",
            [](BoundaryCondition& boundary, int vertex, Complex point, Complex direction) -> BoundaryCondition& {
                boundary.pin_to_line(vertex, point, direction);
                return boundary;
            },
            py::arg("vertex"), py::arg("point"), py::arg("direction"), py::return_value_policy::reference,
            "Holds the image of a vertex inside to a line.")
        .def("__add__",
             [](BoundaryCondition a, const BoundaryCondition& b) {
                 a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
                 a.images.insert(a.images.end(), b.images.begin(), b.images.end());
                 a.lines.insert(a.lines.end(), b.lines.begin(), b.lines.end());
                 return a;
             })
        .def("__len__", [](const BoundaryCondition& boundary) { return boundary.vertices.size(); })
        .def("__repr__", [](const BoundaryCondition& boundary) {
            return "<beltrami.BoundaryCondition: " + std::to_string(boundary.vertices.size()) + " vertices, " +
                   std::to_string(boundary.lines.size()) + " lines>";
        });

    py::class_<ConstraintsObject>(m, "Constraints",
                                  "An extremal problem: what is prescribed of the map and what may slide. With a "
                                  "target, loops of which nothing is "
                                  "prescribed slide along its curves.")
        .def(py::init(&make), py::arg("prescribed") = py::none(), py::arg("target") = py::none(),
             py::arg("target_outer_loop") = 0,
             "prescribed: a BoundaryCondition. target: a TargetDomain, or a Surface.\n\n"
             "How they correspond: outer_loop=0 (the loop of the source around the others), loops=[(loop, curve), …], "
             "match_by=\"position\" or \"size\", marks=[(vertex, curve, arc length) or (vertex, vertex of the target), "
             "…], turns=[n of every loop] and waypoints=[(step, loop, position), …], which choose the homotopy class.")
        .def(
            "pin",
            [](ConstraintsObject& object, int vertex, Complex image) -> ConstraintsObject& {
                object.constraints.pin(vertex, image);
                return object;
            },
            py::arg("vertex"), py::arg("image"), py::return_value_policy::reference,
            "Prescribes the image of a vertex.")
        .def(
            "line",
            [](ConstraintsObject& object, int vertex, Complex point, Complex direction) -> ConstraintsObject& {
                object.constraints.line(vertex, point, direction);
                return object;
            },
            py::arg("vertex"), py::arg("point"), py::arg("direction"), py::return_value_policy::reference,
            "Holds the image of a vertex inside to a line.")
        .def(
            "slide",
            [](ConstraintsObject& object, int first, int last, std::optional<TargetCurve> along) -> ConstraintsObject& {
                object.constraints.slide(first, last, std::move(along));
                return object;
            },
            py::arg("first"), py::arg("last"), py::arg("along") = py::none(), py::return_value_policy::reference,
            "The arc of a loop from one vertex to another slides, along a curve or that of its loop in the target.")
        .def_property_readonly("prescribed",
                               [](const ConstraintsObject& object) { return object.constraints.prescribed; })
        .def("__repr__", [](const ConstraintsObject& object) {
            const Constraints& constraints = object.constraints;
            return "<beltrami.Constraints: " + std::to_string(constraints.prescribed.vertices.size()) +
                   " vertices prescribed, " +
                   (constraints.domain()    ? "loops slide onto a domain"
                    : constraints.surface() ? "loops slide onto a surface"
                                            : "no loop slides") +
                   ">";
        });
}

}  // namespace beltrami::python
