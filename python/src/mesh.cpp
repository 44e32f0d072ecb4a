#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/quality.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

namespace {

std::optional<TextureCoordinates> texture_from(const Mesh& mesh, const py::object& texture) {
    if (texture.is_none()) return {};
    const auto pair =
        value_of<py::tuple>(texture, "texture is a pair: points, and their indices for every face corner");
    if (pair.size() != 2) throw py::type_error("texture is a pair: points, and their indices for every face corner");
    TextureCoordinates result{points(pair[0], "texture points"), whole_numbers(pair[1], "texture corners")};
    if (result.points.cols() != 2) throw Error(Cause::bad_option, "texture points are of the plane", "give n×2");
    if (static_cast<int>(result.corners.size()) != mesh.faces.corner_count())
        throw Error(Cause::bad_option,
                    "texture has " + std::to_string(result.corners.size()) + " corners, and the faces " +
                        std::to_string(mesh.faces.corner_count()),
                    "give an index for each, -1 where there is none");
    std::vector<int> bad;
    for (std::size_t i = 0; i < result.corners.size(); ++i)
        if (result.corners[i] < -1 || result.corners[i] >= result.points.rows()) bad.push_back(static_cast<int>(i));
    if (!bad.empty())
        throw Error(Cause::bad_option, "texture corners name points that do not exist", {}, {Things::points, bad});
    return result;
}

Mesh mesh_of(const py::object& V, const py::object& F, const py::object& texture) {
    if (F.is_none() && py::isinstance<SurfaceObject>(V)) return V.cast<const SurfaceObject&>().surface.mesh;
    Mesh mesh;
    mesh.positions = points(V, "V", Cause::bad_mesh);
    mesh.faces = face_list(F, mesh.vertex_count());
    mesh.texture = texture_from(mesh, texture);
    return mesh;
}

}  // namespace

void bind_mesh(py::module_& m) {
    py::class_<Mesh>(m, "Mesh",
                     "A polygon mesh of triangles and quads, as files and generators give it; V, F = mesh takes it "
                     "apart. What is to be mapped is a Surface(mesh).")
        .def(py::init(&mesh_of), py::arg("V"), py::arg("F") = py::none(), py::arg("texture") = py::none(),
             "V: #V×3 or #V×2 positions, or a Surface, without F. F: #F×3, or #F×4 with -1 in the fourth column of "
             "triangles, or a list of "
             "lists of vertices, counted from 0.\n"
             "texture: a pair of #VT×2 points and #corners indices of these (-1: none).\n\nRaises BadMesh, BadOption.")
        .def_property_readonly(
            "positions", [](const py::object& self) { return view(self.cast<const Mesh&>().positions, self); },
            "#V×3 or #V×2 positions, not to be written")
        .def_property_readonly("faces", &face_matrix, "#F×3, or #F×4 with -1 in the fourth column of triangles")
        .def_property_readonly("vertex_count", &Mesh::vertex_count)
        .def_property_readonly("face_count", &Mesh::face_count)
        .def_property_readonly(
            "texture",
            [](const Mesh& mesh) -> py::object {
                if (!mesh.texture) return py::none();
                return texture_tuple(*mesh.texture);
            },
            "None, or #VT×2 points and #corners indices of these, -1 where a corner has none")
        .def(
            "__iter__",
            [](const py::object& self) { return py::iter(py::make_tuple(self.attr("positions"), self.attr("faces"))); })
        .def("__repr__", [](const Mesh& mesh) {
            return "<beltrami.Mesh: " + std::to_string(mesh.vertex_count()) + " vertices, " +
                   std::to_string(mesh.face_count()) + " faces>";
        });

    py::class_<Finding>(m, "Finding", "What is wrong with a mesh, or unusual.")
        .def_readonly("fatal", &Finding::fatal, "Whether no map can be computed before it is mended")
        .def_readonly("sentence", &Finding::sentence)
        .def_readonly("next_step", &Finding::next_step)
        .def_property_readonly(
            "indices", [](const Finding& finding) { return finding.indices; },
            "Vertices, edges as pairs of vertices, or faces, as the sentence says")
        .def("__repr__", [](const Finding& finding) { return "<beltrami.Finding: " + finding.sentence + ">"; });

    py::class_<Warning>(m, "Warning", "What should be known of a result that was reached all the same.")
        .def_property_readonly("kind", [](const Warning& warning) { return std::string(to_string(warning.kind)); })
        .def_readonly("sentence", &Warning::sentence)
        .def_property_readonly("indices", [](const Warning& warning) { return warning.where.indices; })
        .def_property_readonly(
            "of", [](const Warning& warning) { return std::string(to_string(warning.where.of)); },
            "What the indices count")
        .def("__str__", [](const Warning& warning) { return warning.sentence; })
        .def("__repr__", [](const Warning& warning) { return "<beltrami.Warning: " + warning.sentence + ">"; });

    m.def("diagnose", &diagnose, py::arg("mesh"), "All that is wrong or unusual about a mesh, fatal findings first.");
    m.def("require_sound", &require_sound, py::arg("mesh"),
          "The findings that are only warnings.\n\nRaises BadMesh naming the first fatal one.");
    m.def("is_planar", &is_planar, py::arg("mesh"), "Whether the mesh lies in the plane z = 0.");
    m.def("corner_positions", &corner_positions, py::arg("mesh"),
          "#corners×3 (or ×2) position of every face corner's vertex.");
    m.def(
        "face_vector_area",
        [](const Mesh& mesh, int face) {
            if (face < 0 || face >= mesh.face_count())
                throw Error(Cause::bad_option, "there is no face " + std::to_string(face));
            return face_vector_area(mesh, face);
        },
        py::arg("mesh"), py::arg("face"),
        "½ Σ p_i × p_{i+1} of a face, 3 numbers: its length is the area, its direction the normal.\n\nRaises "
        "BadOption.");
    m.def(
        "planar_coordinates",
        [](const Mesh& mesh) {
            if (!is_planar(mesh)) throw Error(Cause::bad_mesh, "the mesh does not lie in the plane z = 0");
            return planar_coordinates(mesh);
        },
        py::arg("mesh"),
        "#V x + iy, seen from the side from which the faces run counter-clockwise.\n\nRaises BadMesh unless the mesh "
        "lies in the plane z = 0.");
    m.def(
        "seen_from_below",
        [](const Mesh& mesh) {
            if (!is_planar(mesh)) throw Error(Cause::bad_mesh, "the mesh does not lie in the plane z = 0");
            return seen_from_below(mesh);
        },
        py::arg("mesh"), "Whether the faces of a planar mesh run clockwise.\n\nRaises BadMesh unless it is planar.");
    m.def(
        "fitted_to_unit_square",
        [](const py::object& object) { return fitted_to_unit_square(points_of(object, "points", 2)); },
        py::arg("points"), "n×2 points moved and scaled so that their bounding box lies in [0, 1]², at 0.");
    m.def("vertex_normals", &vertex_normals, py::arg("mesh"), "#V×3 area-weighted unit normals.");
    m.def(
        "texture_map", &texture_map, py::arg("mesh"),
        "The map to the plane that a mesh has as its texture coordinates: #V complex, 0 at vertices without faces.\n\n"
        "Raises BadMesh naming vertices that have several points (seams), or none.");
    m.def("texture_corners", &texture_corners, py::arg("mesh"),
          "#corners×2 texture points of the corners: a metric for Surface.\n\nRaises BadMesh if there are none.");
    m.def(
        "corners_from_lengths",
        [](const Mesh& mesh, const py::object& edges, const py::object& lengths) {
            const Eigen::MatrixXi pairs = whole_table(edges, "edges", 2);
            const Eigen::VectorXd values = real_numbers(lengths, "lengths");
            if (pairs.rows() != values.size())
                throw Error(Cause::bad_option, "there are " + std::to_string(pairs.rows()) + " edges and " +
                                                   std::to_string(values.size()) + " lengths");
            std::vector<EdgeLength> list;
            for (Eigen::Index e = 0; e < values.size(); ++e) list.push_back({pairs(e, 0), pairs(e, 1), values[e]});
            return corners_from_lengths(mesh, list);
        },
        py::arg("mesh"), py::arg("edges"), py::arg("lengths"),
        "A metric for Surface from edge lengths: #corners×2.\n\nedges: #E×2 vertices in either order; lengths: #E.\n\n"
        "Raises BadMesh for missing, repeated, unknown or non-positive lengths, triangles that violate the triangle "
        "inequality (named), and quads.");

    py::class_<MeshQuality>(m, "MeshQuality", "Shape of the faces of a mesh: angles in radians.")
        .def_readonly("min_angle", &MeshQuality::min_angle)
        .def_readonly("mean_min_angle", &MeshQuality::mean_min_angle)
        .def_readonly("max_angle", &MeshQuality::max_angle)
        .def_readonly("min_edge", &MeshQuality::min_edge)
        .def_readonly("mean_edge", &MeshQuality::mean_edge)
        .def_readonly("max_edge", &MeshQuality::max_edge)
        .def_readonly("max_aspect", &MeshQuality::max_aspect)
        .def_readonly("ears", &MeshQuality::ears)
        .def_readonly("face_count", &MeshQuality::face_count)
        .def("__repr__", [](const MeshQuality& quality) {
            return "<beltrami.MeshQuality: angles from " + std::to_string(quality.min_angle) + " to " +
                   std::to_string(quality.max_angle) + ">";
        });
    m.def("quality", &quality, py::arg("mesh"),
          "Angles and edges of the faces.\n\nRaises BadMesh if the mesh is not an oriented manifold.");
}

}  // namespace beltrami::python
