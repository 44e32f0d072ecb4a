#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/report/record_json.h>

#include "hyperbolic.h"
#include "module.h"
#include "space_map.h"

namespace beltrami::python {

ShapePtr shape_from(const py::object& object) {
    if (py::isinstance<ShapeObject>(object)) return object.cast<ShapePtr>();
    if (!py::isinstance<SurfaceObject>(object)) throw py::type_error("give a HyperbolicShape or a Surface");
    const auto surface = object.cast<SurfacePtr>();
    return without_lock([&] { return std::make_shared<ShapeObject>(surface); });
}

namespace {

/// A fundamental polygon with the surface that it is of.
struct DomainObject {
    SurfacePtr surface;
    HyperbolicDomain domain;
    Record record;
};

}  // namespace

void bind_hyperbolic_shapes(py::module_& m) {
    py::class_<HyperbolicSurface, std::shared_ptr<HyperbolicSurface>>(
        m, "HyperbolicSurface", "A closed surface of genus 2 or more with its metric of curvature -1.")
        .def_readonly("genus", &HyperbolicSurface::genus)
        .def_property_readonly("area", &HyperbolicSurface::area, "4π(genus − 1) up to rounding")
        .def_property_readonly(
            "log_scale",
            [](const py::object& self) { return view(self.cast<const HyperbolicSurface&>().log_scale, self); },
            "#V u of the scale factors: 2 sinh(L_ij/2) = e^{(u_i+u_j)/2} l_ij")
        .def_readonly("residual", &HyperbolicSurface::residual, "Largest angle defect, radians")
        .def_readonly("flatness", &HyperbolicSurface::flatness,
                      "Largest distance from the identity of the product around a triangle")
        .def_property_readonly(
            "inverted", [](const HyperbolicSurface& s) { return index_array(s.inverted); },
            "Faces whose geodesic triangle runs clockwise")
        .def("__repr__", [](const HyperbolicSurface& s) {
            return "<beltrami.HyperbolicSurface: genus " + std::to_string(s.genus) + ", area " +
                   std::to_string(s.area()) + ">";
        });
    m.def(
        "hyperbolic_surface",
        [](const SurfacePtr& surface) { return without_lock([&] { return hyperbolic_surface(surface->surface); }); },
        py::arg("surface"),
        "The metric of curvature -1 that is discretely conformally equivalent to the surface's own.\n\nRaises BadMesh "
        "unless the surface is one component, closed, of genus 2 or more; NotSolved. Source: Bobenko, Pinkall, "
        "Springborn 2015; Gu, Guo, Luo, Sun, Wu 2018.");
    m.def(
        "require_triangles", [](const SurfacePtr& surface) { require_triangles(surface->surface); }, py::arg("surface"),
        "Raises BadMesh naming a face that is not a triangle.");

    py::class_<DomainObject>(m, "HyperbolicDomain",
                             "A hyperbolic surface cut open and laid out in the unit disk, and its group.")
        .def_property_readonly(
            "layout", [](const DomainObject& d) { return texture_tuple(d.domain.layout); },
            "The faces in one piece: n×2 points of the unit disk and one for each corner (a texture of Mesh)")
        .def_property_readonly(
            "surface", [](const DomainObject& d) { return d.surface; },
            "That was cut open: of a surface with a boundary with edges across it between boundary vertices split")
        .def_property_readonly(
            "distortion", [](const DomainObject& d) { return d.domain.distortion; },
            "Of the map to the layout, face by face")
        .def_property_readonly(
            "paths", [](const DomainObject& d) { return index_lists(d.domain.paths); },
            "2g closed paths of vertices through one vertex: generators of the fundamental group")
        .def_property_readonly(
            "generators",
            [](const DomainObject& d) {
                py::list list;
                for (const DiskIsometry& isometry : d.domain.generators) list.append(isometry.on_half_plane());
                return list;
            },
            "2g matrices of determinant 1, 2×2, on the upper half-plane")
        .def_property_readonly(
            "lengths", [](const DomainObject& d) { return d.domain.lengths; },
            "Of the closed geodesics in their classes")
        .def_property_readonly(
            "relation", [](const DomainObject& d) { return d.domain.relation; },
            "How far the product around the cut surface is from the identity")
        .def(
            "to_json", [](const DomainObject& d) { return to_json(d.record); }, "The record as JSON (docs/json.md).")
        .def("__repr__", [](const DomainObject& d) {
            return "<beltrami.HyperbolicDomain: " + std::to_string(d.domain.generators.size()) + " generators>";
        });
    m.def(
        "hyperbolic_domain",
        [](const py::object& surface) {
            const ShapePtr shape = shape_from(surface);
            return without_lock([&] {
                const SurfacePtr cut =
                    shape->shape.split() ? std::make_shared<SurfaceObject>(shape->shape.surface()) : shape->surface;
                HyperbolicDomain domain = hyperbolic_domain(cut->surface, shape->shape.metric());
                Record record = space_record(cut, "uniformize", map_record(domain.distortion), {});
                record.hyperbolic = hyperbolic_record(shape->shape.metric(), domain);
                return DomainObject{cut, std::move(domain), std::move(record)};
            });
        },
        py::arg("surface"),
        "A fundamental polygon of a closed surface of genus 2 or more in the unit disk: its "
        "uniformization.\n\nsurface: "
        "a Surface or HyperbolicShape. Raises BadMesh, NotSolved.");

    py::class_<ShapeObject, ShapePtr>(m, "HyperbolicShape",
                                      "What is worked out once of a closed surface of genus 2 or more, whatever it is "
                                      "mapped to: make it once and pass "
                                      "it on.")
        .def(py::init([](const SurfacePtr& surface) {
                 return without_lock([&] { return std::make_shared<ShapeObject>(surface); });
             }),
             py::arg("surface"), "Raises BadMesh unless it is one component, closed, of genus 2 or more; NotSolved.")
        .def_property_readonly("surface", [](const ShapeObject& o) { return o.surface; })
        .def_property_readonly(
            "metric", [](const ShapeObject& o) { return o.shape.metric(); }, "A HyperbolicSurface")
        .def_property_readonly(
            "homology", [](const ShapeObject& o) { return o.shape.forms().homology; }, "A HomologyBasis")
        .def(
            "differentials",
            [](const ShapePtr& o) {
                return without_lock([&] {
                    const std::lock_guard lock(o->mutex);
                    return Eigen::VectorXd(o->shape.differentials().kernel);
                });
            },
            "Works out the holomorphic quadratic differentials: 3g − 3 eigenvalues that are 0 but for the mesh.")
        .def("__repr__", [](const ShapeObject& o) {
            return "<beltrami.HyperbolicShape: genus " + std::to_string(o.shape.metric().genus) + ", " +
                   std::to_string(o.surface->vertex_count()) + " vertices>";
        });
}

}  // namespace beltrami::python
