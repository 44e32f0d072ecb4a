#include <beltrami/registration/nearest_places.h>
#include <beltrami/registration/transferred_polyline.h>

#include "module.h"
#include "registration.h"

namespace beltrami::python {

namespace {

TransferWay way_from(bool to_source) {
    return to_source ? TransferWay::to_source : TransferWay::to_target;
}

std::shared_ptr<SurfaceCorrespondence> correspondence(const SurfacePtr& source, const SurfacePtr& target,
                                                      const py::object& target_sphere, const Places& places) {
    const Positions sphere = points_of(target_sphere, "target_sphere", target->vertex_count(), 3);
    if (static_cast<int>(places.points.size()) != source->vertex_count())
        throw Error(Cause::bad_option, "places are not one for each vertex of the source");
    require_on(target->surface.mesh, places);
    return without_lock([&] {
        return std::make_shared<SurfaceCorrespondence>(source->surface.mesh, target->surface.mesh, sphere,
                                                       places.points);
    });
}

}  // namespace

Positions transferred_values(const SurfaceCorrespondence& map, const py::object& values, bool to_source,
                             bool of_faces) {
    const Mesh& from = to_source ? map.target() : map.source();
    const Positions rows = table(values, "values", of_faces ? from.face_count() : from.vertex_count());
    return without_lock([&] {
        return of_faces ? transferred_face_values(map, rows, way_from(to_source))
                        : transferred_vertex_values(map, rows, way_from(to_source));
    });
}

Places carried_places(const SurfaceCorrespondence& map, const Places& places, bool to_source) {
    require_on(to_source ? map.target() : map.source(), places);
    return without_lock([&] { return Places{to_source ? map.back(places.points) : map.forward(places.points)}; });
}

void bind_transfer(py::module_& m) {
    py::class_<SurfaceCorrespondence, std::shared_ptr<SurfaceCorrespondence>>(
        m, "SurfaceCorrespondence",
        "A one-to-one map between two closed surfaces of genus 0 and its inverse, at any points: both lie on the "
        "sphere.")
        .def(py::init(&correspondence), py::arg("source"), py::arg("target"), py::arg("target_sphere"),
             py::arg("places"),
             "target_sphere: #V×3 of the target, its map to the unit sphere (sphere_map). places: #V Places of the "
             "source's vertices on the target.\n\nRaises BadOption, BadMesh naming faces that the map flips.")
        .def(
            "forward",
            [](const SurfaceCorrespondence& map, const Places& places) { return carried_places(map, places, false); },
            py::arg("places"), "Places of the source on the target.")
        .def(
            "back",
            [](const SurfaceCorrespondence& map, const Places& places) { return carried_places(map, places, true); },
            py::arg("places"), "Places of the target on the source.")
        .def("__repr__", [](const SurfaceCorrespondence& map) {
            return "<beltrami.SurfaceCorrespondence: " + std::to_string(map.source().vertex_count()) + " and " +
                   std::to_string(map.target().vertex_count()) + " vertices>";
        });
    m.def(
        "transferred_vertex_values",
        [](const SurfaceCorrespondence& map, const py::object& values, bool to_source) {
            return transferred_values(map, values, to_source, false);
        },
        py::arg("map"), py::arg("values"), py::arg("to_source") = false,
        "Values of the vertices of one surface (#V or #V×m) at those of the other, linear on the triangles: "
        "#V×m.\n\nRaises BadOption unless there are #V.");
    m.def(
        "transferred_face_values",
        [](const SurfaceCorrespondence& map, const py::object& values, bool to_source) {
            return transferred_values(map, values, to_source, true);
        },
        py::arg("map"), py::arg("values"), py::arg("to_source") = false,
        "Values of the faces of one surface (#F or #F×m) as means over the other's faces, exactly: #F×m.\n\nRaises "
        "BadOption unless there are #F.");
    m.def(
        "transferred_texture",
        [](const SurfaceCorrespondence& map, bool to_source) {
            return texture_tuple(without_lock([&] { return transferred_texture(map, way_from(to_source)); }));
        },
        py::arg("map"), py::arg("to_source") = false,
        "The texture coordinates of one surface on the other, as Mesh(texture=…) takes them: n×2 points, one for each "
        "corner.\n\nRaises BadMesh if the surface has none, or not at every corner.");
    m.def(
        "transferred_polyline",
        [](const SurfaceCorrespondence& map, const Places& points, bool to_source) {
            require_on(to_source ? map.target() : map.source(), points);
            TransferredPolyline found =
                without_lock([&] { return transferred_polyline(map, points.points, way_from(to_source)); });
            return py::make_tuple(Places{std::move(found.places)}, index_array(found.given));
        },
        py::arg("map"), py::arg("points"), py::arg("to_source") = false,
        "A polyline of one surface on the other: (Places, numbers of the images of the given points). Points are "
        "joined "
        "by geodesics, the image has a place wherever it bends.\n\nRaises BadBoundary if no way leads from one point "
        "to "
        "the next.");
    m.def(
        "places_of_vertices", [](const Mesh& mesh) { return Places{places_of_vertices(mesh)}; }, py::arg("mesh"),
        "#V Places of the vertices; face -1 for those that no face names.");
    m.def(
        "nearest_places",
        [](const Mesh& mesh, const py::object& points) {
            const Positions at = points_of(points, "points", 3);
            const std::vector<NearestPlace> found = without_lock([&] { return nearest_places(mesh, at); });
            Places places;
            std::vector<double> distances;
            for (const NearestPlace& nearest : found) {
                places.points.push_back(nearest.place);
                distances.push_back(nearest.distance);
            }
            return py::make_tuple(std::move(places), number_array(distances));
        },
        py::arg("mesh"), py::arg("points"),
        "The Places of a mesh that are nearest to n×3 (or n×2) points, and their n distances.\n\nRaises BadMesh if "
        "there is no face.");
}

}  // namespace beltrami::python
