#include <beltrami/certificate/certificate.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/differentials/zeros_and_poles.h>
#include <beltrami/operators/frames.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// A differential with the surface that it is on.
struct DifferentialObject {
    SurfacePtr surface;
    QuadraticDifferential differential;
};

void require_same(const SurfacePtr& surface, const SurfacePtr& other) {
    if (surface != other)
        throw Error(Cause::bad_option, "the differential is one of another surface", "give the map's own, map.surface");
}

/// Of a function of the plane, or #S values.
QuadraticDifferential differential_from(const SurfacePtr& surface, const py::object& phi, const py::object& at) {
    const std::vector<int> poles = vertex_list(at, "poles", surface->vertex_count());
    if (!PyCallable_Check(phi.ptr())) return differential_of(surface->surface, complex_numbers(phi, "phi"), poles);
    const auto held = std::make_shared<HeldFunction>(phi.cast<py::function>());
    return differential_of(
        surface->surface,
        [held](Complex z) {
            const py::gil_scoped_acquire lock;
            return value_of<Complex>(held->function(z), "phi(z) is to be a complex number");
        },
        poles);
}

/// φ of an extremal map, one at hand, a function, or #S values.
QuadraticDifferential any_differential(const SurfacePtr& surface, const py::object& phi, const py::object& poles) {
    if (py::isinstance<DifferentialObject>(phi)) {
        const auto& object = phi.cast<const DifferentialObject&>();
        require_same(surface, object.surface);
        return object.differential;
    }
    if (py::isinstance<ExtremalObject>(phi)) {
        const ExtremalPtr map = phi.cast<ExtremalPtr>();
        require_same(surface, map->surface());
        return map->result().differential;
    }
    return differential_from(surface, phi, poles);
}

py::dict integrals(const ReichStrebel& found, bool proves) {
    py::dict result;
    result["lower"] = found.lower;
    result["estimate"] = found.estimate;
    result["upper"] = found.upper;
    result["valid"] = found.valid;
    result["resolved"] = found.resolved;
    result["proves"] = proves;
    return result;
}

void bind_class(py::module_& m) {
    py::class_<DifferentialObject>(m, "QuadraticDifferential", "A holomorphic quadratic differential φ on a surface.")
        .def(py::init([](const py::object& map) {
                 const auto of = value_of<ExtremalPtr>(map, "give an ExtremalMap, or use differential_of");
                 return DifferentialObject{of->surface(), of->result().differential};
             }),
             py::arg("map"), "That of an ExtremalMap, on its map.surface.")
        .def_property_readonly("surface", [](const DifferentialObject& o) { return o.surface; })
        .def_property_readonly("zero", [](const DifferentialObject& o) { return o.differential.zero(); })
        .def_property_readonly(
            "tabulated", [](const DifferentialObject& o) { return o.differential.tabulated(); },
            "Whether φ is known at the samples only")
        .def_property_readonly(
            "poles", [](const DifferentialObject& o) { return index_array(o.differential.poles); },
            "Vertices at which φ may have a simple pole")
        .def_property_readonly(
            "coefficients", [](const DifferentialObject& o) { return o.differential.coefficients; },
            "In terms of the space's functions")
        .def(
            "at_samples",
            [](const DifferentialObject& o) {
                return without_lock([&] { return o.differential.at_samples(o.surface->surface); });
            },
            "#S values at the samples in their frames")
        .def(
            "at",
            [](const DifferentialObject& o, const Places& places) {
                require_on(o.surface->surface.mesh, places);
                return without_lock([&] { return o.differential.at(o.surface->surface, places.points); });
            },
            py::arg("places"), "n values at Places, in the frames of the nearest samples of their faces.")
        .def("__repr__", [](const DifferentialObject& o) {
            return "<beltrami.QuadraticDifferential: " +
                   (o.differential.zero()        ? std::string("zero")
                    : o.differential.tabulated() ? std::string("tabulated")
                                                 : std::to_string(o.differential.coefficients.size()) + " functions") +
                   ", " + std::to_string(o.differential.poles.size()) + " poles>";
        });
    m.def(
        "differential_of",
        [](const SurfacePtr& surface, const py::object& phi, const py::object& poles) {
            return DifferentialObject{surface, differential_from(surface, phi, poles)};
        },
        py::arg("surface"), py::arg("phi"), py::arg("poles") = py::list(),
        "φ of one's own: a function phi(z) of a planar surface, holomorphic there, which may be called from any "
        "thread; "
        "or #S values at the samples, in their frames.\n\npoles: vertices at which it has simple poles.\n\nRaises "
        "BadMesh unless the surface lies in the plane, BadOption.");
    m.def(
        "nearest_samples",
        [](const SurfacePtr& surface, const Places& places) {
            require_on(surface->surface.mesh, places);
            return index_array(nearest_samples(surface->surface, places.points));
        },
        py::arg("surface"), py::arg("places"), "The samples nearest to n Places: n.");
}

}  // namespace

void bind_differentials(py::module_& m) {
    bind_class(m);
    m.def(
        "reich_strebel",
        [](const SurfacePtr& surface, const py::object& phi, const py::object& map, const py::object& poles) {
            const QuadraticDifferential differential = any_differential(surface, phi, poles);
            const MapDerivatives of_map = derivatives(surface->surface.operators, map_of(*surface, map));
            const ReichStrebel found =
                without_lock([&] { return reich_strebel(surface->surface, differential, of_map); });
            return integrals(found, found.valid && found.resolved && proves(surface->surface, differential));
        },
        py::arg("surface"), py::arg("phi"), py::arg("map"), py::arg("poles") = py::list(),
        "The Reich-Strebel integrals of any map (#V) and φ: lower ≤ K* in the map's class where proves is True, an "
        "estimate "
        "of K*, upper.\n\nphi: an ExtremalMap, whose differential is taken, or #S values at the samples in their "
        "frames, with "
        "simple poles at the vertices poles.\n\nRaises BadOption. Source: Reich & Strebel 1974.");
    m.def(
        "zeros_and_poles",
        [](const SurfacePtr& surface, const py::object& phi, const py::object& poles) {
            const QuadraticDifferential differential = any_differential(surface, phi, poles);
            const std::vector<CriticalPoint> found =
                without_lock([&] { return zeros_and_poles(surface->surface, differential); });
            Places places;
            std::vector<int> orders;
            std::vector<char> on_boundary;
            for (const CriticalPoint& point : found) {
                places.points.push_back(point.place);
                orders.push_back(point.order);
                on_boundary.push_back(point.on_boundary ? 1 : 0);
            }
            return py::make_tuple(std::move(places), index_array(orders), flag_array(on_boundary));
        },
        py::arg("surface"), py::arg("phi"), py::arg("poles") = py::list(),
        "Zeros and simple poles of φ: Places, their orders (-1: a simple pole), and whether each lies on the "
        "boundary.\n\n"
        "phi: as of reich_strebel.");
    m.def(
        "reich_strebel_of",
        [](double total, double norm, double pairing, double unresolved) {
            return integrals(reich_strebel_of(total, norm, pairing, unresolved), false);
        },
        py::arg("total"), py::arg("norm"), py::arg("pairing"), py::arg("unresolved") = 0.0,
        "The same from the integrals ∫|φ|, ∫|φ|(1+|μ|²)/(1−|μ|²) and 2 Re ∫μφ/(1−|μ|²); unresolved: part of ∫|φ| of "
        "which the quadrature is not sure.");
    m.def(
        "averaged_estimate",
        [](const SurfacePtr& surface, const py::object& phi, const py::object& map, int outer_loop) {
            require_loop(*surface, outer_loop);
            const Eigen::VectorXcd values = complex_numbers(phi, "phi", surface->sample_count(), "samples");
            const Eigen::VectorXcd images = map_of(*surface, map);
            return without_lock([&] {
                return averaged_estimate(surface->surface, surface->shape.chart(outer_loop), values, images).lower;
            });
        },
        py::arg("surface"), py::arg("phi"), py::arg("map"), py::arg("outer_loop") = 0,
        "An estimate of K*, no bound, from the coefficient averaged over vertex stars, where K is large: phi #S, map "
        "#V.\n\nRaises BadOption, BadMesh, NotSolved.");
    m.def(
        "phi_along_first_edge",
        [](const SurfacePtr& surface, const py::object& phi) {
            return phi_along_first_edge(surface->surface,
                                        complex_numbers(phi, "phi", surface->sample_count(), "samples"));
        },
        py::arg("surface"), py::arg("phi"), "φ (#S) in the frames whose real axis is the first edge of their face.");
}

}  // namespace beltrami::python
