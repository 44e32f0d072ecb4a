#include <beltrami/forms/flat_torus.h>
#include <beltrami/report/record_json.h>
#include <beltrami/teichmuller/torus_map.h>

#include "extremal_map.h"
#include "marking.h"
#include "module.h"
#include "space_map.h"

namespace beltrami::python {

namespace {

struct TorusObject {
    SurfacePtr surface;
    FlatTorus flat;
};
using TorusPtr = std::shared_ptr<TorusObject>;

TorusPtr flat(const SurfacePtr& surface) {
    return without_lock([&] {
        return std::make_shared<TorusObject>(TorusObject{surface, flat_torus(surface->surface)});
    });
}

/// An extremal map between tori.
class TorusMapObject final : public CarriedObject {
  public:
    TorusMapObject(const SurfacePtr& source, TorusMap found, Record record)
        : CarriedObject(source, "registration", found, found.distortion, std::move(record)), found_(std::move(found)) {}
    const TorusMap& found() const { return found_; }

  private:
    TorusMap found_;
};
using TorusMapPtr = std::shared_ptr<TorusMapObject>;

TorusMapPtr object_of(const SurfacePtr& source, TorusMap found, double begun) {
    Record record = space_record(source, "register", map_record(found), found.warnings);
    record.solve = solve_record(found, seconds() - begun);
    record.registration = registration_record(found, "");
    return std::make_shared<TorusMapObject>(source, std::move(found), std::move(record));
}

TorusMapPtr map_of_tori(const TorusPtr& source, const TorusPtr& target, const std::optional<Eigen::Matrix2i>& marking,
                        const std::array<int, 2>& vertices) {
    TorusMapOptions options;
    options.marking = marking;
    options.vertices = vertices;
    const double begun = seconds();
    return without_lock([&] {
        return object_of(
            source->surface,
            torus_map(source->surface->surface, source->flat, target->surface->surface, target->flat, options), begun);
    });
}

TorusMapPtr registered(const SurfacePtr& source, const SurfacePtr& target, bool search, const py::kwargs& given) {
    Keywords keywords(given);
    std::optional<HandleMarking> marking = take_marking(keywords, *source, *target);
    keywords.finish();
    if (search) marking.reset();
    const double begun = seconds();
    return without_lock(
        [&] { return object_of(source, register_tori(source->surface, target->surface, marking), begun); });
}

std::array<std::vector<int>, 2> two_paths(const py::object& object, const char* name, const TorusObject& torus) {
    std::vector<std::vector<int>> paths = vertex_lists(object, name, torus.surface->vertex_count());
    if (paths.size() != 2) throw Error(Cause::bad_option, std::string(name) + " are not two closed paths of vertices");
    return {std::move(paths[0]), std::move(paths[1])};
}

void require_above(Complex tau, const char* name) {
    if (!(tau.imag() > 0) || !std::isfinite(std::abs(tau)))
        throw Error(Cause::bad_option, std::string(name) + " does not lie above the real axis");
}

}  // namespace

void bind_tori(py::module_& m) {
    py::class_<TorusObject, TorusPtr>(m, "FlatTorus", "A closed surface of genus 1 on the plane modulo ℤ + τℤ.")
        .def_property_readonly(
            "tau", [](const TorusObject& o) { return o.flat.tau; }, "In the fundamental domain")
        .def_property_readonly(
            "surface", [](const TorusObject& o) { return o.surface; }, "That was given")
        .def_property_readonly(
            "tau_error", [](const TorusObject& o) { return o.flat.tau_error; },
            "The polyhedron's own τ is no farther away, in hyperbolic distance")
        .def_property_readonly(
            "layout", [](const TorusObject& o) { return texture_tuple(o.flat.layout); },
            "The faces in one piece of the plane, cut along edges: n×2 points and one for each corner")
        .def_property_readonly(
            "lattice", [](const py::object& self) { return view(self.cast<const TorusObject&>().flat.lattice, self); },
            "#V×2 (α, β) of the place α + τβ")
        .def_property_readonly(
            "homology", [](const TorusObject& o) { return o.flat.homology; }, "A HomologyBasis")
        .def_property_readonly(
            "generators", [](const TorusObject& o) { return o.flat.generators; },
            "2×2: a and b in terms of its loops (columns)")
        .def_property_readonly(
            "distortion", [](const TorusObject& o) { return o.flat.distortion; }, "Of the map to the layout")
        .def(
            "places",
            [](const TorusObject& o, const py::object& points) {
                return Places{places_on_torus(o.flat, points_of(points, "points", 2))};
            },
            py::arg("points"), "Places on the surface of n×2 (α, β).")
        .def(
            "to_json",
            [](const TorusObject& o) {
                Record record = space_record(o.surface, "uniformize", map_record(o.flat.distortion), {});
                record.torus = torus_record(o.flat);
                return to_json(record);
            },
            "The record as JSON (docs/json.md).")
        .def("__repr__", [](const TorusObject& o) {
            return "<beltrami.FlatTorus: tau " + std::to_string(o.flat.tau.real()) + " + " +
                   std::to_string(o.flat.tau.imag()) + "i>";
        });
    m.def("flat_torus", &flat, py::arg("surface"),
          "The flat metric of a torus.\n\nRaises BadMesh unless it is one component, closed, of genus 1; NotSolved.");
    m.def(
        "places_on_torus",
        [](const TorusObject& torus, const py::object& points) {
            return Places{places_on_torus(torus.flat, points_of(points, "points", 2))};
        },
        py::arg("torus"), py::arg("points"), "As FlatTorus.places.");
    m.def(
        "flat_areas",
        [](const TorusObject& torus) {
            return number_array(flat_areas(torus.flat, torus.surface->surface.mesh.faces));
        },
        py::arg("torus"),
        "#F areas of the faces in the flat metric, |φ| of its quadratic differential: weights by which the least L² "
        "map is extremal.");
    m.def(
        "torus_class",
        [](const TorusObject& torus, const py::object& path) {
            return torus_class(torus.surface->surface, torus.flat,
                               vertex_list(path, "path", torus.surface->vertex_count()));
        },
        py::arg("torus"), py::arg("path"),
        "The class of a closed path of vertices in terms of the generators a and b: 2 integers.\n\nRaises BadOption "
        "naming two vertices without an edge.");
    m.def(
        "marking_of_paths",
        [](const TorusObject& from, const py::object& paths_from, const TorusObject& to, const py::object& paths_to) {
            return marking_of_paths(from.surface->surface, from.flat, two_paths(paths_from, "paths_from", from),
                                    to.surface->surface, to.flat, two_paths(paths_to, "paths_to", to));
        },
        py::arg("torus_from"), py::arg("paths_from"), py::arg("torus_to"), py::arg("paths_to"),
        "The marking (2×2 integers) that sends two closed paths of vertices on one torus to two on another.\n\nRaises "
        "BadOption unless the classes determine it, in integers and keeping the orientation.");

    const auto field = [](auto member) { return [member](const TorusMapObject& o) { return o.found().*member; }; };
    py::class_<TorusMapObject, CarriedObject, TorusMapPtr>(
        m, "TorusMap", "The extremal map between two tori: affine between their flat metrics.")
        .def_property_readonly("K", field(&TorusMap::K))
        .def_property_readonly("k", field(&TorusMap::k))
        .def_property_readonly("K_lower", field(&TorusMap::K_lower), "K* of the class, of the two polyhedra, is above")
        .def_property_readonly("K_upper", field(&TorusMap::K_upper), "… and below")
        .def_property_readonly("constant_mu", field(&TorusMap::mu), "μ in the flat coordinate of the source")
        .def_property_readonly("marking", field(&TorusMap::marking),
                               "2×2: where the source's generators go, in those of the target")
        .def_property_readonly("target_tau", field(&TorusMap::target_tau),
                               "τ of the target in the images of the source's generators")
        .def_property_readonly(
            "map", [](const py::object& self) { return view(self.cast<const TorusMapObject&>().found().map, self); },
            "#V in the flat coordinate of the target, lifted");
    m.def("torus_map", &map_of_tori, py::arg("source"), py::arg("target"), py::arg("marking") = py::none(),
          py::arg("vertices") = std::array<int, 2>{-1, -1},
          "The extremal map between two FlatTorus.\n\nmarking: 2×2 integers of determinant 1, where the generators go "
          "(None: the nearest). vertices: one of the source and the one of the target it goes to.\n\nRaises BadOption. "
          "Source: Teichmüller's theorem for genus 1 (Grötzsch's problem on the torus).");
    m.def("register_tori", &registered, py::arg("source"), py::arg("target"), py::arg("search") = false,
          (std::string(
               "The extremal map between two tori in the class that a marking tells, or, search=True, that of least "
               "dilatation.\n\n") +
           kMarking + "\n\nRaises BadMesh, BadOption, NotSolved.")
              .c_str());
    m.def(
        "tau_in_basis",
        [](Complex tau, const Eigen::Matrix2i& basis) {
            require_above(tau, "tau");
            return tau_in_basis(tau, basis);
        },
        py::arg("tau"), py::arg("basis"), "τ in another basis of the lattice, 2×2 integers.\n\nRaises BadOption.");
    m.def(
        "hyperbolic_distance",
        [](Complex a, Complex b) {
            require_above(a, "a");
            require_above(b, "b");
            return hyperbolic_distance(a, b);
        },
        py::arg("a"), py::arg("b"), "In the upper half-plane, of curvature -1.\n\nRaises BadOption.");
    m.def(
        "nearest_marking",
        [](Complex from, Complex to) {
            for (const Complex tau : {from, to}) {
                require_above(tau, "tau");
                if (!(std::abs(tau) < 1e6 && tau.imag() > 1e-6))
                    throw Error(Cause::bad_option, "tau is too near the boundary of the upper half-plane",
                                "reduce it first, reducing_basis");
            }
            return nearest_marking(from, to);
        },
        py::arg("from_tau"), py::arg("to_tau"),
        "The marking (2×2 integers) for which the tori of two τ are nearest.\n\nRaises BadOption.");
    m.def(
        "reducing_basis",
        [](Complex tau) {
            require_above(tau, "tau");
            return reducing_basis(tau);
        },
        py::arg("tau"), "The basis in which τ lies in the fundamental domain of the modular group.");
    m.def(
        "torus_distances",
        [](const std::vector<SurfacePtr>& surfaces, const std::vector<std::string>& names) {
            const std::vector<Surface> list = surfaces_of(surfaces, names);
            TorusDistances found = without_lock([&] { return torus_distances(list, names); });
            return py::make_tuple(std::move(found.matrix.distance), std::move(found.matrix.lower),
                                  std::move(found.matrix.upper), std::move(found.tau));
        },
        py::arg("surfaces"), py::arg("names") = std::vector<std::string>(),
        "All distances of some tori, the least over all markings: n×n distances, lower and upper bounds, and n "
        "τ.\n\nRaises "
        "BadOption for fewer than two, BadMesh naming the shape.");
}

}  // namespace beltrami::python
