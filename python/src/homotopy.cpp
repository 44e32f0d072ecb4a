#include <beltrami/homotopy/continuation.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/homotopy/twist.h>

#include "constraints.h"
#include "module.h"

namespace beltrami::python {

namespace {

/// Places in the plane where no face is flipped: a chart's, or the mesh's own.
Eigen::VectorXcd plane_of(const SurfacePtr& surface, const py::object& positions, int outer_loop) {
    if (!positions.is_none()) return map_of(*surface, positions, "positions");
    if (surface->surface.in_plane()) return *surface->surface.coordinate();
    return surface->shape.chart(outer_loop).vertices;
}

}  // namespace

void bind_homotopy(py::module_& m) {
    m.def(
        "homotopy_class",
        [](const SurfacePtr& surface, const py::object& map, const py::object& positions, int outer_loop) {
            require_loop(*surface, outer_loop);
            const Eigen::VectorXcd images = map_of(*surface, map);
            const HomotopyClass found =
                homotopy_class(surface->surface, plane_of(surface, positions, outer_loop), images, outer_loop);
            py::dict turns;
            for (const HoleTurns& hole : found.holes)
                turns[py::int_(hole.loop)] = hole.meaningful ? py::object(py::int_(hole.turns)) : py::none();
            return turns;
        },
        py::arg("surface"), py::arg("map"), py::arg("positions") = py::none(), py::arg("outer_loop") = 0,
        "Turns of a map at every hole, {loop: turns}, None where folds leave them without meaning.\n\npositions: #V "
        "places "
        "in the plane where no face is flipped (None: the mesh's own, or its chart's).\n\nRaises BadMesh, BadOption.");
    m.def(
        "twisted_map",
        [](const SurfacePtr& surface, const py::object& map, const std::vector<int>& extra_turns,
           const py::object& positions, int outer_loop) {
            require_loop(*surface, outer_loop);
            return twisted_map(surface->surface, plane_of(surface, positions, outer_loop), outer_loop,
                               map_of(*surface, map), extra_turns);
        },
        py::arg("surface"), py::arg("map"), py::arg("extra_turns"), py::arg("positions") = py::none(),
        py::arg("outer_loop") = 0,
        "A map with the same boundary values and further turns, one number for each boundary loop: #V "
        "complex.\n\nRaises "
        "BadOption, BadMesh naming a hole without a free ring, NotSolved.");
    m.def(
        "start_in_class",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, const std::vector<int>& turns,
           const py::object& positions, int outer_loop) {
            require_loop(*surface, outer_loop);
            require_whole_boundary(boundary, surface->surface);
            const Eigen::VectorXcd plane = plane_of(surface, positions, outer_loop);
            return without_lock(
                [&] { return start_in_class(surface->surface, plane, outer_loop, boundary, turns).map; });
        },
        py::arg("surface"), py::arg("boundary"), py::arg("turns") = std::vector<int>(),
        py::arg("positions") = py::none(), py::arg("outer_loop") = 0,
        "A map with the boundary values and the wanted turns, not extremal: #V complex.");
    m.def(
        "follow",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, const py::kwargs& given) {
            Correspondence way;
            Keywords keywords(given);
            take_correspondence(keywords, way);
            keywords.finish();
            require_loop(*surface, way.outer_loop);
            validate(boundary, surface->surface);
            const Eigen::VectorXcd plane = plane_of(surface, py::none(), way.outer_loop);
            return without_lock([&] {
                const Continuation continuation(surface->surface, plane, way.outer_loop, boundary,
                                                way.waypoints.value_or(std::vector<Waypoint>()));
                return follow(surface->surface, continuation).map;
            });
        },
        py::arg("surface"), py::arg("boundary"),
        "Leads a domain to prescribed boundary values along waypoints=[(step, loop, position), …], which fixes how "
        "holes "
        "braid: #V complex, without folds.\n\nRaises BadBoundary, BadOption, NotSolved.");
}

}  // namespace beltrami::python
