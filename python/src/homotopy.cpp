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
    m.def(
        "loop_paths",
        [](const SurfacePtr& surface, const py::object& positions, int outer_loop) {
            require_loop(*surface, outer_loop);
            py::dict paths;
            for (const LoopPath& path :
                 loop_paths(surface->surface, plane_of(surface, positions, outer_loop), outer_loop))
                paths[py::int_(path.loop)] = index_array(path.vertices);
            return paths;
        },
        py::arg("surface"), py::arg("positions") = py::none(), py::arg("outer_loop") = 0,
        "The paths of edges along which the turns of holes are counted, {loop: vertices from the outer loop to the "
        "hole's}.\n\nRaises BadMesh, BadOption.");
    m.def(
        "hole_ring",
        [](const SurfacePtr& surface, int loop, const py::object& positions, int outer_loop) {
            require_loop(*surface, loop);
            require_loop(*surface, outer_loop);
            const HoleRing ring = hole_ring(surface->surface, plane_of(surface, positions, outer_loop), loop);
            return py::make_tuple(ring.centre, ring.inner, ring.outer);
        },
        py::arg("surface"), py::arg("loop"), py::arg("positions") = py::none(), py::arg("outer_loop") = 0,
        "The widest ring around the centre of a hole, free of all other loops: centre, inner and outer radius (empty "
        "unless inner < outer).");
    m.def(
        "logarithmic_map",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, int turns, const py::object& positions,
           int outer_loop) {
            require_loop(*surface, outer_loop);
            require_genus_zero(surface->surface);
            if (surface->surface.topology.boundary_loops.size() != 2)
                throw Error(Cause::bad_mesh, "the surface has not two boundary loops");
            require_whole_boundary(boundary, surface->surface);
            if (std::abs(turns) > 100000) throw Error(Cause::bad_option, "so many turns are not resolved");
            const Eigen::VectorXcd plane = plane_of(surface, positions, outer_loop);
            return without_lock([&] { return logarithmic_map(surface->surface, plane, outer_loop, boundary, turns); });
        },
        py::arg("surface"), py::arg("boundary"), py::arg("turns") = 0, py::arg("positions") = py::none(),
        py::arg("outer_loop") = 0,
        "The map of a ring that is harmonic in the logarithm, with any turns: #V complex. Between concentric circles "
        "it is "
        "the extremal map.\n\nRaises BadMesh, BadBoundary.");
    m.def(
        "continuation_steps",
        [](const SurfacePtr& surface, const BoundaryCondition& boundary, int substeps, const py::kwargs& given) {
            Correspondence way;
            Keywords keywords(given);
            take_correspondence(keywords, way);
            keywords.finish();
            require_loop(*surface, way.outer_loop);
            validate(boundary, surface->surface);
            if (substeps < 1 || substeps > 100000) throw Error(Cause::bad_option, "substeps are not from 1 to 100000");
            const Eigen::VectorXcd plane = plane_of(surface, py::none(), way.outer_loop);
            return continuation_steps(surface->surface, plane, way.outer_loop, boundary,
                                      way.waypoints.value_or(std::vector<Waypoint>()), substeps);
        },
        py::arg("surface"), py::arg("boundary"), py::arg("substeps") = 8,
        "Boundary values at equal steps on the way to prescribed ones, along waypoints=[(step, loop, position), …]: a "
        "list "
        "of BoundaryCondition, the last of which is the prescribed one.\n\nRaises BadBoundary, BadOption.");
    m.def(
        "smallest_angle", [](Complex from, Complex to, Complex centre) { return smallest_angle(from, to, centre); },
        py::arg("from_point"), py::arg("to_point"), py::arg("centre") = Complex(0),
        "The angle in (−π, π] between two points as seen from a third.");
}

}  // namespace beltrami::python
