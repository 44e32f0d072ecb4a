#include <algorithm>

#include <beltrami/forms/flat_torus.h>
#include <beltrami/remeshing/carried_data.h>
#include <beltrami/remeshing/feature_curves.h>
#include <beltrami/remeshing/mesh_comparison.h>
#include <beltrami/remeshing/remesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/reference_shapes.h>

#include "extremal_map.h"
#include "module.h"
#include "space_map.h"
#include "space_targets.h"

namespace beltrami::python {

namespace {

/// A mesh whose vertices have moved along itself.
class RemeshedObject final : public SpaceMap {
  public:
    RemeshedObject(const SurfacePtr& source, RemeshedSurface found, Distortion distortion, Record record)
        : SpaceMap(source, "remeshed", found.positions, std::move(distortion), std::move(record)),
          found_(std::move(found)) {}
    const RemeshedSurface& found() const { return found_; }

  private:
    RemeshedSurface found_;
};
using RemeshedPtr = std::shared_ptr<RemeshedObject>;

RemeshRecord record_of(const Mesh& mesh, const Mesh& image, const RemeshedSurface& found,
                       const RemeshOptions& options) {
    RemeshRecord record = remesh_record(mesh, image, found);
    record.reference = "given";
    record.method = options.fast ? "linear" : "barrier";
    record.power = options.fast ? 0 : options.power;
    return record;
}

RemeshedPtr remeshed(const SurfacePtr& source, const py::object& reference, const py::kwargs& given) {
    const SurfacePtr surface = in_space(source);
    const Mesh& mesh = surface->surface.mesh;
    const Positions shapes = reference.is_none() ? regular_shapes(mesh.faces)
                                                 : points_of(reference, "reference", mesh.faces.corner_count(), 2);
    Interruption interruption;
    RemeshOptions options;
    Keywords keywords(given);
    keywords.take("power", options.power);
    keywords.take("max_distance", options.max_distance);
    keywords.take("even_size", options.even_size);
    keywords.take("feature_angle", options.feature_angle);
    keywords.take("slide_border", options.slide_border);
    keywords.take("keep_seams", options.keep_seams);
    if (const py::object sizing = keywords.taken("sizing"); sizing && !sizing.is_none()) {
        options.sizing = real_numbers(sizing, "sizing");
        if (options.sizing->size() != mesh.vertex_count())
            throw Error(Cause::bad_option, "sizing is not one number for each vertex");
    }
    keywords.take("open_angles", options.open_angles);
    keywords.take("fast", options.fast);
    keywords.progress(interruption, options.progress);
    keywords.finish();
    const double begun = seconds();
    return without_lock(interruption, [&] {
        RemeshedSurface found = remesh(surface->surface, shapes, options);
        Mesh image = mesh;
        image.positions = found.positions;
        const CornerElements elements = corner_elements(mesh, shapes);
        Distortion after = distortion(elements.operators, image.positions, vertex_normals(image));
        Record record = space_record(surface, "remesh", map_record(after), found.warnings);
        record.solve =
            solve_of(found.steps, found.factorizations,
                     found.settled ? Termination::converged : Termination::iteration_limit, seconds() - begun);
        record.remesh = record_of(mesh, image, found, options);
        return std::make_shared<RemeshedObject>(surface, std::move(found), std::move(after), std::move(record));
    });
}

std::vector<MeshPoint> places_on(const Mesh& mesh, const Places& places) {
    require_on(mesh, places);
    return places.points;
}

void bind_comparison(py::module_& m) {
    py::class_<AngleStatistics>(
        m, "AngleStatistics", "Angles of the faces of a mesh, degrees; deviations are those from a regular polygon's.")
        .def_readonly("smallest", &AngleStatistics::smallest)
        .def_readonly("one_percent", &AngleStatistics::one_percent, "One percent of the angles are below")
        .def_readonly("largest", &AngleStatistics::largest)
        .def_readonly("median_deviation", &AngleStatistics::median_deviation)
        .def_readonly("mean_deviation", &AngleStatistics::mean_deviation)
        .def_property_readonly(
            "histogram",
            [](const AngleStatistics& s) {
                return index_array({s.histogram.begin(), s.histogram.end()});
            },
            "18 numbers of corners with angles in [10 i, 10 (i+1))")
        .def("__repr__", [](const AngleStatistics& s) {
            return "<beltrami.AngleStatistics: from " + std::to_string(s.smallest) + " to " +
                   std::to_string(s.largest) + " degrees>";
        });
    m.def("angle_statistics", &angle_statistics, py::arg("mesh"), "Of a Mesh or Surface.");
    m.def(
        "surface_distance",
        [](const py::object& a, const py::object& b) {
            const auto first = mesh_target_of(a), second = mesh_target_of(b);
            const SurfaceDistance found = without_lock([&] { return surface_distance(*first, *second); });
            return py::make_tuple(found.largest, found.mean);
        },
        py::arg("a"), py::arg("b"),
        "How far apart two surfaces (MeshTarget, Mesh or Surface) are, both ways: largest and mean distance, in the "
        "positions' units, sampled at vertices, middles of edges and of triangles.\n\nRaises BadMesh.");
    m.def(
        "opposed_faces",
        [](const Mesh& mesh, const py::object& surface) {
            const auto target = mesh_target_of(surface);
            return index_array(without_lock([&] { return opposed_faces(mesh, *target); }));
        },
        py::arg("mesh"), py::arg("surface"),
        "Faces whose normal opposes that of a surface at the point nearest to their middle.\n\nRaises BadMesh.");
    m.def("surface_area", &surface_area, py::arg("mesh"), "Sum of the areas of the faces.");
    m.def(
        "valence_floor",
        [](int count) {
            if (count < 3) throw Error(Cause::bad_option, "a vertex inside has three triangles or more");
            return valence_floor(count);
        },
        py::arg("m"),
        "|μ| that an isosceles triangle needs against an equilateral one if m of them fill a full angle.\n\nRaises "
        "BadOption for m < 3.");
}

void bind_shapes(py::module_& m) {
    m.def(
        "regular_shapes", [](const Mesh& mesh) { return regular_shapes(mesh.faces); }, py::arg("mesh"),
        "Regular polygons of side 1 as the shapes that faces ought to have: #corners×2, a reference of remesh and a "
        "metric of Surface.");
    m.def("valence_shapes", &valence_shapes, py::arg("mesh"),
          "Shapes by the valences of the vertices: at a vertex of m faces every angle ought to be 2π/m: #corners×2.\n\n"
          "Raises BadMesh. Source: Gruber, Aulisa 2022, Algorithm 5.");
    m.def(
        "shapes_from_angles",
        [](const Mesh& mesh, const py::object& angles) {
            const Eigen::VectorXd list = real_numbers(angles, "angles");
            if (list.size() != mesh.faces.corner_count())
                throw Error(Cause::bad_option, "angles are not one number for each corner of a face");
            return shapes_from_angles(mesh.faces, list);
        },
        py::arg("mesh"), py::arg("angles"),
        "Shapes by angles: #corners radians, positive, below π, of every face adding up to (n−2)π: "
        "#corners×2.\n\nRaises "
        "BadOption naming the faces of which they do not.");
    m.def(
        "feature_curves",
        [](const SurfacePtr& surface, const std::optional<double>& angle, const py::object& given) {
            std::vector<std::array<int, 2>> edges = whole_pairs(given, "given");
            for (const auto& edge : edges)
                for (const int v : edge)
                    if (v < 0 || v >= surface->vertex_count())
                        throw Error(Cause::bad_option, "given: there is no vertex " + std::to_string(v));
            const FeatureCurves found = feature_curves(surface->surface.mesh, surface->surface.topology, angle, edges);
            py::list curves;
            for (const FeatureCurves::Curve& curve : found.curves)
                curves.append(py::make_tuple(index_array(curve.vertices), curve.closed));
            return py::make_tuple(curves, index_array(found.corners));
        },
        py::arg("surface"), py::arg("angle") = py::none(), py::arg("given") = py::list(),
        "Curves that a mesh's shape or border distinguishes: the border, given edges (n×2 vertices), and those at "
        "which "
        "normals differ by more than an angle (radians; None: no others).\n\nReturns a list of (vertices, closed), and "
        "the corners.");
}

}  // namespace

void bind_remeshing(py::module_& m) {
    py::class_<RemeshedObject, SpaceMap, RemeshedPtr>(
        m, "RemeshedSurface",
        "A mesh whose vertices have moved along its own surface; distortion is that against the "
        "reference.")
        .def_property_readonly(
            "places", [](const RemeshedObject& o) { return Places{o.found().places}; }, "#V Places on the mesh before")
        .def_property_readonly(
            "mesh",
            [](const RemeshedObject& o) {
                Mesh mesh = o.source()->surface.mesh;
                const bool whole =
                    mesh.texture && std::none_of(mesh.texture->corners.begin(), mesh.texture->corners.end(),
                                                 [](int c) { return c < 0; });
                if (whole) mesh.texture = carried_texture(mesh, o.found().places);
                mesh.positions = o.found().positions;
                return mesh;
            },
            "The Mesh after, its texture carried along where every corner has a point")
        .def_property_readonly(
            "distance", [](const RemeshedObject& o) { return o.found().distance; },
            "The largest between image and surface, as part of the diagonal of the box around it")
        .def_property_readonly("steps", [](const RemeshedObject& o) { return o.found().steps; })
        .def_property_readonly(
            "settled", [](const RemeshedObject& o) { return o.found().settled; },
            "Whether the distance was kept before the rounds were over")
        .def_property_readonly(
            "unresolved", [](const RemeshedObject& o) { return index_array(o.found().unresolved); },
            "Faces whose normals oppose the surface's at the end");
    m.def("remesh", &remeshed, py::arg("surface"), py::arg("reference") = py::none(),
          "Moves the vertices of a mesh along its own surface until its faces have the shapes of a reference as nearly "
          "as they can; the connectivity stays.\n\nreference: #corners×2 (regular_shapes, valence_shapes, "
          "shapes_from_angles; None: regular).\n\nOptions: power=4 (larger: the worst faces count more), "
          "max_distance=0.003 (of the diagonal), even_size=0.03, feature_angle=None (radians), slide_border=True, "
          "keep_seams=True, sizing=None (#V factors), open_angles=False, fast=False, progress=None: called as "
          "progress(step, value), False "
          "stops (Cancelled).\n\nRaises BadOption, BadMesh, NotSolved, Cancelled.");
    m.def(
        "carried_texture",
        [](const Mesh& mesh, const Places& places) {
            texture_corners(mesh);  // throws unless every corner has a point
            return texture_tuple(carried_texture(mesh, places_on(mesh, places)));
        },
        py::arg("mesh"), py::arg("places"),
        "The texture of a mesh whose vertices have moved along it to #V Places: n×2 points and one for each "
        "corner.\n\nRaises BadOption, BadMesh unless every corner has a point.");
    m.def(
        "carried_values",
        [](const Mesh& mesh, const py::object& values, const Places& places) {
            return carried_values(table(values, "values", mesh.vertex_count()), places_on(mesh, places));
        },
        py::arg("mesh"), py::arg("values"), py::arg("places"),
        "Values of the vertices (#V or #V×m) at n Places: n×m, linear on the triangles.\n\nRaises BadOption.");
    m.def(
        "seam_edges", [](const Mesh& mesh) { return pairs_array(seam_edges(mesh)); }, py::arg("mesh"),
        "n×2 edges along which the texture has a seam, the smaller vertex first.");
    bind_comparison(m);
    bind_shapes(m);
}

}  // namespace beltrami::python
