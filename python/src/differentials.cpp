#include <beltrami/certificate/certificate.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/differentials/zeros_and_poles.h>
#include <beltrami/operators/frames.h>

#include "extremal_map.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// φ of an extremal map, or #S values.
QuadraticDifferential differential_from(const SurfacePtr& surface, const py::object& phi,
                                        const std::vector<int>& poles) {
    if (py::isinstance<ExtremalObject>(phi)) {
        const ExtremalPtr map = phi.cast<ExtremalPtr>();
        if (map->surface() != surface)
            throw Error(Cause::bad_option, "the map is one of another surface", "give the map's own, map.surface");
        return map->result().differential;
    }
    for (const int v : poles)
        if (v < 0 || v >= surface->vertex_count())
            throw Error(Cause::bad_option, "there is no vertex " + std::to_string(v), {}, {Things::vertices, {v}});
    return differential_of(surface->surface, complex_numbers(phi, "phi"), poles);
}

}  // namespace

void bind_differentials(py::module_& m) {
    m.def(
        "reich_strebel",
        [](const SurfacePtr& surface, const py::object& phi, const py::object& map, const std::vector<int>& poles) {
            const QuadraticDifferential differential = differential_from(surface, phi, poles);
            const MapDerivatives of_map = derivatives(surface->surface.operators, map_of(*surface, map));
            const ReichStrebel found =
                without_lock([&] { return reich_strebel(surface->surface, differential, of_map); });
            py::dict result;
            result["lower"] = found.lower;
            result["estimate"] = found.estimate;
            result["upper"] = found.upper;
            result["valid"] = found.valid;
            result["resolved"] = found.resolved;
            result["proves"] = found.valid && found.resolved && proves(surface->surface, differential);
            return result;
        },
        py::arg("surface"), py::arg("phi"), py::arg("map"), py::arg("poles") = std::vector<int>(),
        "The Reich-Strebel integrals of any map (#V) and φ: lower ≤ K* in the map's class where proves is True, an "
        "estimate "
        "of K*, upper.\n\nphi: an ExtremalMap, whose differential is taken, or #S values at the samples in their "
        "frames, with "
        "simple poles at the vertices poles.\n\nRaises BadOption. Source: Reich & Strebel 1974.");
    m.def(
        "zeros_and_poles",
        [](const SurfacePtr& surface, const py::object& phi, const std::vector<int>& poles) {
            const QuadraticDifferential differential = differential_from(surface, phi, poles);
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
        py::arg("surface"), py::arg("phi"), py::arg("poles") = std::vector<int>(),
        "Zeros and simple poles of φ: Places, their orders (-1: a simple pole), and whether each lies on the "
        "boundary.\n\n"
        "phi: as of reich_strebel.");
    m.def(
        "phi_along_first_edge",
        [](const SurfacePtr& surface, const py::object& phi) {
            return phi_along_first_edge(surface->surface,
                                        complex_numbers(phi, "phi", surface->sample_count(), "samples"));
        },
        py::arg("surface"), py::arg("phi"), "φ (#S) in the frames whose real axis is the first edge of their face.");
}

}  // namespace beltrami::python
