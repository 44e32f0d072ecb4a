#include <beltrami/targets/correspondence.h>
#include <beltrami/targets/target_domain.h>
#include <beltrami/targets/target_mesh.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

void bind_targets(py::module_& m) {
    py::class_<TargetCurve>(m, "TargetCurve",
                            "A simple closed curve in the plane by its arc length, in the units of the plane.")
        .def_static("circle", &TargetCurve::circle, py::arg("centre"), py::arg("radius"),
                    "s = 0 at centre + radius.\n\nRaises BadOption unless the radius is positive.")
        .def_static(
            "polygon", [](const py::object& corners) { return TargetCurve::polygon(complex_list(corners, "corners")); },
            py::arg("corners"),
            "n complex or n×2 corners, at least 3, in either direction.\n\nRaises BadOption naming corners that "
            "coincide "
            "and sides that meet.")
        .def_static(
            "spline", [](const py::object& points) { return TargetCurve::spline(complex_list(points, "points")); },
            py::arg("points"), "The closed cubic spline through n complex or n×2 points.\n\nRaises BadOption.")
        .def_property_readonly("length", &TargetCurve::length)
        .def_property_readonly("area", &TargetCurve::area)
        .def_property_readonly("counter_clockwise", &TargetCurve::counter_clockwise)
        .def("reversed", &TargetCurve::reversed)
        .def(
            "point",
            [](const TargetCurve& curve, const py::object& s) {
                const Eigen::VectorXd at = real_numbers(s, "s");
                Eigen::VectorXcd result(at.size());
                for (Eigen::Index i = 0; i < at.size(); ++i) result[i] = curve.point(at[i]);
                return result;
            },
            py::arg("s"), "Points at n arc lengths.")
        .def(
            "nearest",
            [](const TargetCurve& curve, const py::object& points) {
                const Eigen::VectorXcd at = complex_numbers(points, "points");
                Eigen::VectorXd result(at.size());
                for (Eigen::Index i = 0; i < at.size(); ++i) result[i] = curve.nearest(at[i]);
                return result;
            },
            py::arg("points"), "Arc lengths of the places nearest to n points.")
        .def("contains", &TargetCurve::contains, py::arg("point"))
        .def("corners", &TargetCurve::corners, py::arg("min_turn") = 1e-9,
             "Arc lengths of the corners that turn by more than that (radians).")
        .def("__repr__", [](const TargetCurve& curve) {
            const char* const kinds[] = {"circle", "polygon", "spline"};
            return std::string("<beltrami.TargetCurve: ") + kinds[static_cast<int>(curve.kind())] + ", length " +
                   std::to_string(curve.length()) + ">";
        });

    py::class_<TargetDomain>(
        m, "TargetDomain",
        "A bounded domain of the plane between curves, onto which boundaries slide. Curve 0 is the "
        "outer one, curve i + 1 is hole i.")
        .def(py::init([](TargetCurve outer, std::vector<TargetCurve> holes) {
                 return target_domain(std::move(outer), std::move(holes));
             }),
             py::arg("outer"), py::arg("holes") = std::vector<TargetCurve>(),
             "Curves may run in either direction.\n\nRaises BadOption naming the hole that lies outside, or the two "
             "curves that meet.")
        .def_readonly("outer", &TargetDomain::outer)
        .def_property_readonly("holes", [](const TargetDomain& domain) { return domain.holes; })
        .def_property_readonly("curve_count", &TargetDomain::curve_count)
        .def_property_readonly("area", &TargetDomain::area)
        .def("contains", &TargetDomain::contains, py::arg("point"))
        .def("__repr__", [](const TargetDomain& domain) {
            return "<beltrami.TargetDomain: " + std::to_string(domain.holes.size()) + " holes, area " +
                   std::to_string(domain.area()) + ">";
        });
    m.def(
        "target_domain",
        [](TargetCurve outer, std::vector<TargetCurve> holes) {
            return target_domain(std::move(outer), std::move(holes));
        },
        py::arg("outer"), py::arg("holes") = std::vector<TargetCurve>(), "As TargetDomain(outer, holes).");
    m.def(
        "boundary_domain", [](const SurfacePtr& planar) { return boundary_domain(planar->surface); },
        py::arg("surface"),
        "The domain that a planar surface covers: curve l is the polygon of boundary loop l.\n\nRaises BadMesh, "
        "BadBoundary.");
    m.def(
        "nearest_mark",
        [](const TargetDomain& domain, int vertex, Complex point) {
            const Mark mark = nearest_mark(domain, vertex, point);
            const CurveParameter& place = on_curve(mark);
            return py::make_tuple(vertex, place.curve, place.parameter);
        },
        py::arg("domain"), py::arg("vertex"), py::arg("point"),
        "The mark (vertex, curve, arc length) of Constraints that sends a vertex to the nearest point of the nearest "
        "curve.\n\nRaises BadBoundary if the point is not finite.");
    m.def(
        "distance_from",
        [](const TargetDomain& domain, const std::tuple<int, int, double>& mark, Complex point) {
            const auto [vertex, curve, parameter] = mark;
            if (curve < 0 || curve >= domain.curve_count())
                throw Error(Cause::bad_option, "there is no curve " + std::to_string(curve));
            if (!std::isfinite(parameter)) throw Error(Cause::bad_option, "the mark's arc length is not finite");
            return distance_from(domain, Mark(vertex, curve, parameter), point);
        },
        py::arg("domain"), py::arg("mark"), py::arg("point"),
        "How far a mark (vertex, curve, arc length) lies from the point that was meant, as part of its curve's "
        "length.\n\nRaises BadOption.");
    m.def("curve_name", &curve_name, py::arg("curve"),
          "What sentences call a curve of a domain by its number, 0 the outer one.");
    m.def(
        "target_mesh",
        [](const TargetDomain& domain, const py::kwargs& given) {
            TargetMeshOptions options;
            Keywords keywords(given);
            keywords.take("edge_length", options.edge_length);
            keywords.take("hole_edge_length", options.hole_edge_length);
            keywords.take("least_edges", options.least_edges);
            keywords.take("max_turn", options.max_turn);
            keywords.take("min_angle", options.min_angle);
            keywords.take("split_ears", options.split_ears);
            keywords.finish();
            TargetMesh made = without_lock([&] { return target_mesh(domain, options); });
            return py::make_tuple(std::move(made.mesh), index_array(made.curve), made.parameter);
        },
        py::arg("domain"),
        "Triangulates a target domain.\n\nOptions: edge_length (0: about 5000 vertices), hole_edge_length, "
        "least_edges=32, max_turn=0.2 (radians), min_angle=0.489 (radians), split_ears=True.\n\nReturns the mesh, the "
        "curve of every vertex (-1 inside) and its arc length there. Raises BadOption, NotSolved.");
}

}  // namespace beltrami::python
