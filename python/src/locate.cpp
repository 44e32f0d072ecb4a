#include <cmath>

#include <beltrami/applications/reached_corners.h>
#include <beltrami/charts/boundary_correspondence.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/curves/surface_curve.h>
#include <beltrami/locate/corner_weights.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/registration/surface_landmarks.h>

#include "constraints.h"
#include "module.h"
#include "planar_map.h"

namespace beltrami::python {

namespace {

std::vector<Complex> finite_points(const py::object& points) {
    const std::vector<Complex> list = complex_list(points, "points");
    for (std::size_t i = 0; i < list.size(); ++i)
        if (!std::isfinite(list[i].real()) || !std::isfinite(list[i].imag()))
            throw Error(Cause::bad_option, "points are not finite, the first is point " + std::to_string(i), {},
                        {Things::points, {static_cast<int>(i)}});
    return list;
}

Places located(const PlanarLocator& locator, const py::object& points) {
    Places places;
    for (const Complex point : finite_points(points))
        places.points.push_back(locator.locate(point).value_or(MeshPoint()));
    return places;
}

Places nearest(const PlanarLocator& locator, const py::object& points) {
    Places places;
    for (const Complex point : finite_points(points)) places.points.push_back(locator.nearest(point));
    return places;
}

py::tuple with_curves(const Mesh& mesh, const py::object& given) {
    if (!py::isinstance<py::sequence>(given)) throw py::type_error("curves are a list of (points, closed)");
    require_sound(mesh);
    std::vector<CurveThrough> curves;
    for (const py::handle item : given) {
        if (!py::isinstance<py::sequence>(item) || py::len(item) != 2)
            throw py::type_error("a curve is (Places or vertices, closed)");
        const py::sequence pair = py::reinterpret_borrow<py::sequence>(item);
        const py::object points = pair[0];
        CurveThrough curve;
        if (py::isinstance<Places>(points)) {
            require_on(mesh, points.cast<const Places&>());
            curve.points = points.cast<const Places&>().points;
        } else {
            for (const int v : vertex_list(points, "a curve", mesh.vertex_count()))
                curve.points.push_back(place_of_vertex(mesh, v));
        }
        curve.closed = value_of<bool>(pair[1], "closed is True or False");
        curves.push_back(std::move(curve));
    }
    MeshWithCurves made = without_lock([&] { return mesh_with_curves(mesh, curves); });
    py::list chains;
    for (const MeshWithCurves::Chain& chain : made.curves)
        chains.append(py::make_tuple(index_array(chain.vertices), number_array(chain.lengths), chain.length));
    return py::make_tuple(std::move(made.mesh), Places{std::move(made.places)}, index_array(made.faces), chains);
}

/// Loops of a map whose boundary slid, as ExtremalMap.loops has them, and its map.
std::vector<LoopOnto> loops_from(const SurfacePtr& surface, const TargetDomain& domain, const py::object& given) {
    constexpr const char* kWanted = "loops are (loop, curve, arc lengths), as ExtremalMap.loops";
    if (!py::isinstance<py::sequence>(given)) throw py::type_error(kWanted);
    std::vector<LoopOnto> loops;
    for (const py::handle item : given) {
        if (!py::isinstance<py::sequence>(item) || py::len(item) != 3) throw py::type_error(kWanted);
        const py::sequence tuple = py::reinterpret_borrow<py::sequence>(item);
        LoopOnto loop;
        loop.loop = value_of<int>(tuple[0], kWanted);
        loop.curve = value_of<int>(tuple[1], kWanted);
        require_loop(*surface, loop.loop);
        if (loop.curve < 0 || loop.curve >= domain.curve_count())
            throw Error(Cause::bad_option, "there is no curve " + std::to_string(loop.curve));
        const Eigen::VectorXd parameters = real_numbers(tuple[2], "arc lengths");
        if (!parameters.allFinite() ||
            parameters.size() != static_cast<Eigen::Index>(surface->surface.topology.boundary_loops[loop.loop].size()))
            throw Error(Cause::bad_option,
                        "arc lengths are not one for each vertex of loop " + std::to_string(loop.loop));
        loop.parameters.assign(parameters.begin(), parameters.end());
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace

void bind_locate(py::module_& m) {
    py::class_<PlanarLocator>(m, "PlanarLocator", "Finds the faces of a planar mesh that contain given points.")
        .def(py::init([](const Mesh& mesh) { return std::make_unique<PlanarLocator>(mesh); }), py::arg("mesh"),
             "A planar Mesh or Surface; quads are read as two triangles.\n\nRaises BadMesh.")
        .def("locate", &located, py::arg("points"),
             "Places of n complex or n×2 points: the first face that contains each; face -1 outside.")
        .def("nearest", &nearest, py::arg("points"),
             "Places nearest to n points: themselves inside, else on the boundary.")
        .def_property_readonly("diameter", &PlanarLocator::diameter, "Diagonal of the bounding box")
        .def("__repr__", [](const PlanarLocator& locator) {
            return "<beltrami.PlanarLocator: diameter " + std::to_string(locator.diameter()) + ">";
        });
    m.def(
        "corner_weights",
        [](const Mesh& mesh, const Places& places) {
            require_on(mesh, places);
            py::list weights;
            for (const MeshPoint& place : places.points) weights.append(number_array(corner_weights(mesh, place)));
            return weights;
        },
        py::arg("mesh"), py::arg("places"),
        "Of n Places the barycentric weights for all corners of their faces, in the faces' order.\n\nRaises "
        "BadOption.");
    m.def(
        "positions_on",
        [](const Mesh& mesh, const Places& places) {
            require_on(mesh, places);
            return positions_on(mesh, places.points);
        },
        py::arg("mesh"), py::arg("places"), "n×3 (or ×2) positions of n Places of a mesh.\n\nRaises BadOption.");
    m.def(
        "mesh_with_curves", &with_curves, py::arg("mesh"), py::arg("curves"),
        "Joins the points of every curve by geodesics and divides the faces that they cross, so that curves run along "
        "edges.\n\ncurves: (Places or vertices, closed) each.\n\nReturns the Mesh (old vertices first), Places on the "
        "old "
        "mesh of the new vertices, the old face of each face, and of every curve its vertices, the arc length up to "
        "each "
        "of them, and its length. Raises BadBoundary naming the curve, BadMesh.");
    m.def(
        "boundary_correspondence",
        [](const SurfacePtr& source, const SurfacePtr& target, const py::object& pairs) {
            const BoundaryCorrespondence found =
                boundary_correspondence(source->surface, target->surface, whole_pairs(pairs, "pairs"));
            py::list places;
            for (const std::vector<BoundaryPlace>& loop : found.places) {
                Places of_loop;
                for (const BoundaryPlace& place : loop) of_loop.points.push_back(mesh_point(target->surface, place));
                places.append(py::cast(std::move(of_loop)));
            }
            return py::make_tuple(index_array(found.partner), places);
        },
        py::arg("source"), py::arg("target"), py::arg("pairs"),
        "Where a boundary goes on that of another surface: by pairs of vertices (n×2, at least one on every loop), arc "
        "length between them.\n\nReturns the partner of every loop, and of every loop the Places of its vertices on "
        "the "
        "target. Raises BadBoundary naming vertices and loops.");
    m.def(
        "reach_corners",
        [](const SurfacePtr& source, const TargetDomain& target, const py::object& loops, const py::object& map,
           const py::object& marked) {
            const std::vector<LoopOnto> list = loops_from(source, target, loops);
            Eigen::VectorXcd images = map_of(*source, map);
            std::vector<Mark> marks;
            for (const int v : vertex_list(marked, "marked", source->vertex_count())) marks.emplace_back(v, 0, 0.0);
            const int reached = reach_corners(source->surface, target, list, marks, images);
            return py::make_tuple(std::move(images), reached);
        },
        py::arg("source"), py::arg("target"), py::arg("loops"), py::arg("map"), py::arg("marked") = py::list(),
        "Lets the image of a map whose boundary slid have the corners of its target: the nearest boundary vertex moves "
        "there along its curve where no face folds by that.\n\nsource: map.surface, loops: map.loops, map: #V images "
        "of "
        "an ExtremalMap onto a TargetDomain. marked: vertices that stay.\n\nReturns the map (#V) and the number of "
        "corners at which a vertex lies.");
}

}  // namespace beltrami::python
