#include "space_targets.h"

#include <cmath>

#include <beltrami/mesh/diagnosis.h>
#include <beltrami/targets/implicit_target.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>

#include "module.h"

namespace beltrami::python {

namespace {

Eigen::Vector3d vector_of(const py::handle& object, const char* what) {
    const auto numbers = value_of<std::array<double, 3>>(object, what);
    return {numbers[0], numbers[1], numbers[2]};
}

py::sequence returned(const py::object& object, std::size_t size, const char* what) {
    if (!py::isinstance<py::sequence>(object) || py::len(object) != size) throw py::type_error(what);
    return py::reinterpret_borrow<py::sequence>(object);
}

TargetPtr implicit(py::function function) {
    constexpr const char* kWanted = "the function of an ImplicitTarget returns (value, (x, y, z) of its gradient)";
    auto held = std::make_shared<HeldFunction>(std::move(function));
    return std::make_shared<ImplicitTarget>([held](const Eigen::Vector3d& point) {
        const py::gil_scoped_acquire lock;
        const py::sequence answer = returned(held->function(py::make_tuple(point[0], point[1], point[2])), 2, kWanted);
        return ImplicitTarget::Jet{value_of<double>(answer[0], kWanted), vector_of(answer[1], kWanted)};
    });
}

ParametricTarget::Range range_of(const py::object& object, const char* name) {
    const auto [first, last, periodic] =
        value_of<std::tuple<double, double, bool>>(object, "a range is (first, last, periodic)");
    if (!(std::isfinite(first) && std::isfinite(last) && first < last))
        throw Error(Cause::bad_option, std::string("the range of ") + name + " is empty");
    return {first, last, periodic};
}

TargetPtr parametric(py::function function, const py::object& u, const py::object& v, const SlideCurves& boundary) {
    constexpr const char* kWanted = "the function of a ParametricTarget returns three points of space: X, X_u, X_v";
    const auto held = std::make_shared<HeldFunction>(std::move(function));
    const ParametricTarget::Range first = range_of(u, "u"), second = range_of(v, "v");
    const auto jet = [held](double s, double t) {
        const py::gil_scoped_acquire lock;
        const py::sequence answer = returned(held->function(s, t), 3, kWanted);
        return ParametricTarget::Jet{vector_of(answer[0], kWanted), vector_of(answer[1], kWanted),
                                     vector_of(answer[2], kWanted)};
    };
    return without_lock(
        [&]() -> TargetPtr { return std::make_shared<ParametricTarget>(jet, first, second, boundary); });
}

/// Values of a curve at many parameters.
template <class Value>
Positions along(const py::object& s, const Value& value) {
    const Eigen::VectorXd at = real_numbers(s, "s");
    if (!at.allFinite()) throw Error(Cause::bad_option, "s has numbers that are not finite");
    Positions result(at.size(), 3);
    for (Eigen::Index i = 0; i < at.size(); ++i) result.row(i) = value(at[i]);
    return result;
}

void bind_curves(py::module_& m) {
    using CurvePtr = std::shared_ptr<SlideCurve>;
    py::class_<SlideCurve, CurvePtr>(m, "SlideCurve", "A curve in space by its arc length, along which vertices slide.")
        .def_property_readonly("length", &SlideCurve::length)
        .def_property_readonly("closed", &SlideCurve::closed)
        .def(
            "point",
            [](const SlideCurve& curve, const py::object& s) {
                return along(s, [&](double t) { return curve.point(t); });
            },
            py::arg("s"), "n×3 points at n arc lengths.")
        .def(
            "tangent",
            [](const SlideCurve& curve, const py::object& s) {
                return along(s, [&](double t) { return curve.tangent(t); });
            },
            py::arg("s"), "n×3 directions there, of length 1.")
        .def(
            "nearest",
            [](const SlideCurve& curve, const py::object& points) {
                const Positions at = points_of(points, "points", 3);
                Eigen::VectorXd result(at.rows());
                for (Eigen::Index i = 0; i < at.rows(); ++i) result[i] = curve.nearest(at.row(i).transpose());
                return result;
            },
            py::arg("points"), "Arc lengths of the places nearest to n×3 points.")
        .def("__repr__", [](const SlideCurve& curve) {
            return std::string("<beltrami.SlideCurve: ") + (curve.closed() ? "closed" : "open") + ", length " +
                   std::to_string(curve.length()) + ">";
        });
    py::class_<PolylineCurve, SlideCurve, std::shared_ptr<PolylineCurve>>(m, "PolylineCurve", "A polyline in space.")
        .def(py::init([](const py::object& points, bool closed) {
                 return std::make_shared<PolylineCurve>(points_of(points, "points", 3), closed);
             }),
             py::arg("points"), py::arg("closed"),
             "points: n×3, at least 2, or 3 of a closed one, which does not repeat the first.\n\nRaises BadOption "
             "naming "
             "neighbours that coincide.");
    py::class_<LevelCircle, SlideCurve, std::shared_ptr<LevelCircle>>(m, "LevelCircle",
                                                                      "A circle around the z-axis, z = height.")
        .def(py::init([](double radius, double height) {
                 if (!(radius > 0 && std::isfinite(radius) && std::isfinite(height)))
                     throw Error(Cause::bad_option, "the radius is not positive, or a number is not finite");
                 return std::make_shared<LevelCircle>(radius, height);
             }),
             py::arg("radius"), py::arg("height"), "Raises BadOption unless the radius is positive.");
    py::class_<PlanarSlideCurve, SlideCurve, std::shared_ptr<PlanarSlideCurve>>(m, "PlanarSlideCurve",
                                                                                "A TargetCurve in the plane z = 0.")
        .def(py::init<TargetCurve>(), py::arg("curve"));
}

void bind_target_classes(py::module_& m) {
    py::class_<Target, TargetPtr>(m, "Target", "An oriented surface in space that maps go to, along which they move.")
        .def(
            "nearest",
            [](const Target& target, const py::object& points) {
                const Positions at = points_of(points, "points", 3);
                return TargetMap{without_lock([&] { return nearest_points(target, at); }), {}};
            },
            py::arg("points"), "The points of the surface nearest to n×3 points, as a TargetMap.")
        .def_property_readonly(
            "boundary",
            [](const Target& target) {
                py::list curves;
                for (const auto& curve : target.boundary())
                    curves.append(py::cast(std::const_pointer_cast<SlideCurve>(curve)));
                return curves;
            },
            "The curves that bound it")
        .def("__repr__", [](const py::object& self) {
            return "<beltrami." + py::type::of(self).attr("__name__").cast<std::string>() + ">";
        });
    py::class_<SphereTarget, Target, std::shared_ptr<SphereTarget>>(m, "SphereTarget",
                                                                    "The unit sphere, seen from outside.")
        .def(py::init<>());
    py::class_<PlaneTarget, Target, std::shared_ptr<PlaneTarget>>(m, "PlaneTarget", "The plane z = 0, seen from above.")
        .def(py::init<>());
    py::class_<DomainTarget, PlaneTarget, std::shared_ptr<DomainTarget>>(m, "DomainTarget",
                                                                         "A domain of the plane z = 0 with its curves.")
        .def(py::init<const TargetDomain&>(), py::arg("domain"));
    py::class_<MeshTarget, Target, std::shared_ptr<MeshTarget>>(m, "MeshTarget", "A mesh as a surface.")
        .def(py::init([](const Mesh& mesh) {
                 require_sound(mesh);
                 return std::make_shared<MeshTarget>(mesh);
             }),
             py::arg("mesh"), "A Mesh or Surface, copied.\n\nRaises BadMesh.")
        .def(
            "at",
            [](const MeshTarget& target, const Places& places) {
                require_on(*target.mesh(), places);
                TargetMap map;
                for (const MeshPoint& place : places.points) map.points.push_back(target.at(place));
                return map;
            },
            py::arg("places"), "The points at Places of the mesh, as a TargetMap.");
    py::class_<ImplicitTarget, Target, std::shared_ptr<ImplicitTarget>>(m, "ImplicitTarget",
                                                                        "A surface F = 0, seen from where F > 0.")
        .def(py::init([](py::function function) {
                 return std::static_pointer_cast<ImplicitTarget>(implicit(std::move(function)));
             }),
             py::arg("function"),
             "function((x, y, z)) returns F and its gradient, which is not 0 near the surface. It may be called from "
             "any "
             "thread.");
    py::class_<ParametricTarget, Target, std::shared_ptr<ParametricTarget>>(m, "ParametricTarget",
                                                                            "A surface given by two parameters.")
        .def(py::init([](py::function function, const py::object& u, const py::object& v,
                         const std::vector<std::shared_ptr<SlideCurve>>& boundary) {
                 return std::static_pointer_cast<ParametricTarget>(
                     parametric(std::move(function), u, v, SlideCurves(boundary.begin(), boundary.end())));
             }),
             py::arg("function"), py::arg("u"), py::arg("v"),
             py::arg("boundary") = std::vector<std::shared_ptr<SlideCurve>>(),
             "function(u, v) returns the place and its derivatives by u and v, three points of space each; the normal "
             "is "
             "along X_u × X_v. u, v: (first, last, periodic). boundary: the curves that bound it, where a range is not "
             "periodic.\n\nRaises BadOption for empty ranges.");
    m.def(
        "ellipsoid_target",
        [](const std::array<double, 3>& half_axes) {
            return std::make_shared<ImplicitTarget>(ellipsoid_target({half_axes[0], half_axes[1], half_axes[2]}));
        },
        py::arg("half_axes"), "The ellipsoid with three half-axes, seen from outside.\n\nRaises BadOption.");
    const auto made = [](ParametricTarget target) { return std::make_shared<ParametricTarget>(std::move(target)); };
    m.def(
        "torus_target", [made](double major, double minor) { return made(torus_target(major, minor)); },
        py::arg("major"), py::arg("minor"),
        "The torus of revolution about the z-axis, u along the large circle, v along the small one, both with period "
        "1.\n\nRaises BadOption unless major > minor > 0.");
    m.def(
        "first_modified_torus", [made] { return made(first_modified_torus()); },
        "The first modified torus of Wong & Zhao 2014, section 5.4.");
    m.def(
        "second_modified_torus", [made] { return made(second_modified_torus()); },
        "The second modified torus of Wong & Zhao 2014, section 5.4.");
    m.def(
        "cylinder_target", [made](double radius, double height) { return made(cylinder_target(radius, height)); },
        py::arg("radius"), py::arg("height"), "The cylinder about the z-axis, 0 ≤ z ≤ height.\n\nRaises BadOption.");
    m.def(
        "nearest_points",
        [](const py::object& target, const py::object& points) {
            const TargetPtr to = target_of(target);
            const Positions at = points_of(points, "points", 3);
            return TargetMap{without_lock([&] { return nearest_points(*to, at); }), {}};
        },
        py::arg("target"), py::arg("points"), "As Target.nearest.");
}

void bind_target_maps(py::module_& m) {
    py::class_<TargetMap>(m, "TargetMap", "Points of a target, one for each vertex of a map to it.")
        .def_property_readonly(
            "positions", [](const TargetMap& map) { return positions_of(map.points); }, "n×3")
        .def_property_readonly(
            "normals", [](const TargetMap& map) { return normals_of(map.points); },
            "n×3 of length 1, on the target's outer side")
        .def_property_readonly(
            "places", [](const TargetMap& map) { return Places{places_of(map.points)}; },
            "Places on the mesh of a MeshTarget; face -1 elsewhere")
        .def_property_readonly(
            "uv",
            [](const TargetMap& map) {
                Positions result(map.points.size(), 2);
                for (std::size_t i = 0; i < map.points.size(); ++i)
                    result.row(static_cast<Eigen::Index>(i)) = map.points[i].parameters;
                return result;
            },
            "n×2 parameters on a ParametricTarget; 0 elsewhere")
        .def_property_readonly(
            "parameters", [](const TargetMap& map) { return number_array(map.parameters); },
            "Arc lengths of the vertices that slide, on their curves")
        .def("__len__", [](const TargetMap& map) { return map.points.size(); })
        .def("__repr__", [](const TargetMap& map) {
            return "<beltrami.TargetMap: " + std::to_string(map.points.size()) + " points>";
        });
    py::class_<TargetConstraints>(
        m, "TargetConstraints", "What a map to a target keeps while it moves along it; the rest is free on the target.")
        .def(py::init([](const py::object& fixed) {
                 TargetConstraints constraints;
                 constraints.fixed = whole_numbers(fixed, "fixed");
                 return constraints;
             }),
             py::arg("fixed") = py::list(), "fixed: vertices that stay where the start has them.")
        .def_property_readonly("fixed", [](const TargetConstraints& c) { return index_array(c.fixed); })
        .def_property_readonly(
            "sliding",
            [](const TargetConstraints& c) {
                std::vector<int> vertices;
                for (const TargetConstraints::Slide& slide : c.sliding) vertices.push_back(slide.vertex);
                return index_array(vertices);
            },
            "Vertices that slide along curves")
        .def(
            "slide",
            [](TargetConstraints& c, const py::object& loop,
               const std::shared_ptr<SlideCurve>& curve) -> TargetConstraints& {
                if (!curve) throw py::type_error("curve is a SlideCurve");
                c.slide(whole_numbers(loop, "loop"), curve);
                return c;
            },
            py::arg("loop"), py::arg("curve"), py::return_value_policy::reference,
            "Lets vertices slide along a SlideCurve.")
        .def("__repr__", [](const TargetConstraints& c) {
            return "<beltrami.TargetConstraints: " + std::to_string(c.fixed.size()) + " fixed, " +
                   std::to_string(c.sliding.size()) + " sliding>";
        });
    m.def(
        "slide_boundary",
        [](const TargetConstraints& constraints, const SurfacePtr& source, const py::object& target,
           const py::object& start) {
            const TargetPtr to = target_of(target);
            TargetConstraints result = constraints;
            const Positions at =
                start.is_none() ? source->surface.mesh.positions : points_of(start, "start", source->vertex_count(), 3);
            return without_lock([&] {
                slide_boundary(result, source->surface, *to, at);
                return result;
            });
        },
        py::arg("constraints"), py::arg("source"), py::arg("target"), py::arg("start") = py::none(),
        "Constraints by which every boundary loop slides along the curve of the target's boundary that it is nearest "
        "to "
        "as well.\n\nstart: #V×3 points near the target (None: the source's own).\n\nRaises BadBoundary if the target "
        "has no boundary, or two loops are nearest to one curve.");
    m.def(
        "target_map",
        [](const SurfacePtr& source, const py::object& target, const py::object& constraints, const py::object& start) {
            const TargetPtr to = target_of(target);
            return start_on(source, *to, target_constraints_of(constraints), start);
        },
        py::arg("source"), py::arg("target"), py::arg("constraints") = py::none(), py::arg("start") = py::none(),
        "The map whose vertices are at the nearest points of the target, those that slide at the nearest of their "
        "curves.\n\nstart: #V×3 points near the target (None: the source's own).\n\nRaises BadOption, BadBoundary.");
}

}  // namespace

std::shared_ptr<MeshTarget> mesh_target_of(const py::object& object) {
    if (py::isinstance<MeshTarget>(object)) return object.cast<std::shared_ptr<MeshTarget>>();
    if (py::isinstance<SurfaceObject>(object))
        return std::make_shared<MeshTarget>(object.cast<const SurfaceObject&>().surface.mesh);
    if (!py::isinstance<Mesh>(object)) throw py::type_error("give a MeshTarget, a Surface or a Mesh");
    require_sound(object.cast<const Mesh&>());
    return std::make_shared<MeshTarget>(object.cast<const Mesh&>());
}

TargetPtr target_of(const py::object& object) {
    if (py::isinstance<Target>(object)) return object.cast<TargetPtr>();
    if (py::isinstance<TargetDomain>(object)) return std::make_shared<DomainTarget>(object.cast<const TargetDomain&>());
    if (py::isinstance<SurfaceObject>(object) || py::isinstance<Mesh>(object)) return mesh_target_of(object);
    throw py::type_error("a target is a Target, a Surface, a Mesh or a TargetDomain");
}

TargetConstraints target_constraints_of(const py::object& object) {
    if (object.is_none()) return {};
    return value_of<TargetConstraints>(object, "constraints are TargetConstraints, or None");
}

TargetMap start_on(const SurfacePtr& source, const Target& target, const TargetConstraints& constraints,
                   const py::object& start) {
    validate(constraints, source->surface);
    if (py::isinstance<TargetMap>(start)) {
        auto map = start.cast<TargetMap>();
        if (static_cast<int>(map.points.size()) != source->vertex_count() ||
            map.parameters.size() != constraints.sliding.size())
            throw Error(Cause::bad_option, "the start is not one of this source and these constraints",
                        "make it with target_map(source, target, constraints, positions)");
        return map;
    }
    const Positions at =
        start.is_none() ? source->surface.mesh.positions : points_of(start, "start", source->vertex_count(), 3);
    return without_lock([&] { return target_map(source->surface, target, constraints, at); });
}

void bind_space_targets(py::module_& m) {
    bind_curves(m);
    bind_target_maps(m);
    bind_target_classes(m);
}

}  // namespace beltrami::python
