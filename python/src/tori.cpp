#include <beltrami/forms/flat_torus.h>
#include <beltrami/forms/harmonic_basis.h>
#include <beltrami/forms/homology.h>
#include <beltrami/forms/period_matrix.h>
#include <beltrami/teichmuller/torus_map.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

struct TorusObject {
    SurfacePtr surface;
    FlatTorus flat;
};
using TorusPtr = std::shared_ptr<TorusObject>;

py::list loop_list(const std::vector<std::vector<int>>& loops) {
    py::list list;
    for (const std::vector<int>& loop : loops) list.append(index_array(loop));
    return list;
}

TorusPtr flat(const SurfacePtr& surface) {
    return without_lock([&] {
        return std::make_shared<TorusObject>(TorusObject{surface, flat_torus(surface->surface)});
    });
}

TorusMap map_of_tori(const TorusPtr& source, const TorusPtr& target, const std::optional<Eigen::Matrix2i>& marking,
                     const std::array<int, 2>& vertices) {
    TorusMapOptions options;
    options.marking = marking;
    options.vertices = vertices;
    return without_lock([&] {
        return torus_map(source->surface->surface, source->flat, target->surface->surface, target->flat, options);
    });
}

}  // namespace

void bind_tori(py::module_& m) {
    py::class_<HomologyBasis>(m, "HomologyBasis", "Loops that generate the first homology of a surface.")
        .def_property_readonly(
            "loops", [](const HomologyBasis& basis) { return loop_list(basis.loops); }, "Vertices of every loop")
        .def_readonly("lengths", &HomologyBasis::lengths)
        .def_readonly("intersections", &HomologyBasis::intersections)
        .def_readonly("cochains", &HomologyBasis::cochains, "#E×#loops closed 1-forms dual to the loops")
        .def("__repr__", [](const HomologyBasis& basis) {
            return "<beltrami.HomologyBasis: " + std::to_string(basis.size()) + " loops>";
        });
    m.def(
        "homology_basis", [](const SurfacePtr& surface) { return homology_basis(surface->surface); },
        py::arg("surface"),
        "The shortest loops through a vertex (Erickson, Whittlesey 2005).\n\nRaises BadMesh unless there is one "
        "component.");
    m.def(
        "homology_class",
        [](const SurfacePtr& surface, const HomologyBasis& basis, const py::object& path) {
            const std::vector<int> vertices = whole_numbers(path, "path");
            for (const int v : vertices)
                if (v < 0 || v >= surface->vertex_count())
                    throw Error(Cause::bad_option, "there is no vertex " + std::to_string(v));
            if (basis.cochains.rows() != surface->surface.topology.edge_count())
                throw Error(Cause::bad_option, "the basis is that of another surface");
            return homology_class(surface->surface.topology, basis, vertices);
        },
        py::arg("surface"), py::arg("basis"), py::arg("path"),
        "The class of a closed path of vertices in terms of the loops.\n\nRaises BadOption naming two without an "
        "edge.");
    m.def(
        "harmonic_basis",
        [](const SurfacePtr& surface) {
            HarmonicBasis basis = without_lock([&] { return harmonic_basis(surface->surface); });
            return py::make_tuple(std::move(basis.forms), std::move(basis.energies), std::move(basis.homology));
        },
        py::arg("surface"), "The harmonic 1-forms dual to a homology basis: #E×n forms, n×n energies, the basis.");
    m.def(
        "period_matrix",
        [](const SurfacePtr& surface) {
            return without_lock(
                [&] { return period_matrix(surface->surface, harmonic_basis(surface->surface)).periods; });
        },
        py::arg("surface"),
        "g×g periods of the holomorphic 1-forms of a closed surface of genus g.\n\nRaises BadMesh if it has a boundary "
        "or "
        "genus 0.");
    py::class_<TorusObject, TorusPtr>(m, "FlatTorus", "A closed surface of genus 1 on the plane modulo ℤ + τℤ.")
        .def_property_readonly(
            "tau", [](const TorusObject& o) { return o.flat.tau; }, "In the fundamental domain")
        .def_property_readonly("tau_error", [](const TorusObject& o) { return o.flat.tau_error; })
        .def_property_readonly(
            "lattice", [](const py::object& self) { return view(self.cast<const TorusObject&>().flat.lattice, self); },
            "#V×2 (α, β) of the place α + τβ")
        .def_property_readonly("homology", [](const TorusObject& o) { return o.flat.homology; })
        .def_property_readonly("generators", [](const TorusObject& o) { return o.flat.generators; })
        .def_property_readonly("distortion", [](const TorusObject& o) { return o.flat.distortion; })
        .def(
            "places",
            [](const TorusObject& o, const py::object& points) {
                const Positions at = python::points(points, "points");
                if (at.cols() != 2) throw Error(Cause::bad_option, "points are n×2 (α, β)");
                return Places{places_on_torus(o.flat, at)};
            },
            py::arg("points"), "Places on the surface of n×2 (α, β).")
        .def("__repr__", [](const TorusObject& o) {
            return "<beltrami.FlatTorus: tau " + std::to_string(o.flat.tau.real()) + " + " +
                   std::to_string(o.flat.tau.imag()) + "i>";
        });
    m.def("flat_torus", &flat, py::arg("surface"),
          "The flat metric of a torus.\n\nRaises BadMesh unless it is one component, closed, of genus 1; NotSolved.");
    py::class_<TorusMap>(m, "TorusMap", "The extremal map between two tori: affine between their flat metrics.")
        .def_readonly("K", &TorusMap::K)
        .def_readonly("k", &TorusMap::k)
        .def_readonly("K_lower", &TorusMap::K_lower)
        .def_readonly("K_upper", &TorusMap::K_upper)
        .def_readonly("mu", &TorusMap::mu)
        .def_readonly("marking", &TorusMap::marking)
        .def_property_readonly(
            "map", [](const py::object& self) { return view(self.cast<const TorusMap&>().map, self); },
            "#V in the flat coordinate of the target, lifted")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const TorusMap&>().positions, self); },
            "#V×3 on the target")
        .def_property_readonly("places", [](const TorusMap& map) { return Places{map.places}; })
        .def("__repr__", [](const TorusMap& map) { return "<beltrami.TorusMap: K " + std::to_string(map.K) + ">"; });
    m.def("torus_map", &map_of_tori, py::arg("source"), py::arg("target"), py::arg("marking") = py::none(),
          py::arg("vertices") = std::array<int, 2>{-1, -1},
          "The extremal map between two FlatTorus.\n\nmarking: 2×2 integers of determinant 1, where the generators go "
          "(None: "
          "the nearest). vertices: one of the source and the one of the target it goes to.\n\nRaises BadOption.");
    m.def("tau_in_basis", &tau_in_basis, py::arg("tau"), py::arg("basis"), "τ in another basis of the lattice.");
    m.def("hyperbolic_distance", &hyperbolic_distance, py::arg("a"), py::arg("b"), "In the upper half-plane.");
    m.def(
        "reducing_basis",
        [](Complex tau) {
            if (!(tau.imag() > 0) || !std::isfinite(std::abs(tau)))
                throw Error(Cause::bad_option, "tau does not lie above the real axis");
            return reducing_basis(tau);
        },
        py::arg("tau"), "The basis in which τ lies in the fundamental domain of the modular group.");
    m.def(
        "torus_distances",
        [](const std::vector<SurfacePtr>& surfaces, const std::vector<std::string>& names) {
            std::vector<Surface> list;
            for (const SurfacePtr& surface : surfaces) {
                if (!surface) throw py::type_error("surfaces are Surface objects");
                list.push_back(surface->surface);
            }
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
