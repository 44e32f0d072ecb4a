#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/repair.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/meshing/fill_holes.h>

#include "module.h"
#include "surface.h"

namespace beltrami::python {

namespace {

py::tuple unpacked(Submesh part) {
    return py::make_tuple(std::move(part.mesh), index_array(part.vertices), index_array(part.faces));
}

std::vector<int> faces_of(const Mesh& mesh, const py::object& faces) {
    std::vector<int> result = whole_numbers(faces, "faces");
    for (std::size_t i = 0; i < result.size(); ++i)
        if (result[i] < 0 || result[i] >= mesh.face_count() || (i > 0 && result[i] <= result[i - 1]))
            throw Error(Cause::bad_option, "faces are to ascend, and to be there: face " + std::to_string(result[i]),
                        {}, {Things::faces, {result[i]}});
    return result;
}

/// @throw Error bad_mesh unless every corner has a point, and every point belongs to one vertex
void require_texture(const Mesh& mesh) {
    texture_corners(mesh);
    std::vector<int> vertex(static_cast<std::size_t>(mesh.texture->points.rows()), -1);
    for (std::size_t c = 0; c < mesh.texture->corners.size(); ++c) {
        int& of = vertex[static_cast<std::size_t>(mesh.texture->corners[c])];
        if (of >= 0 && of != mesh.faces.vertices()[c])
            throw Error(Cause::bad_mesh, "a point of the texture belongs to two vertices", {},
                        {Things::vertices, {of, mesh.faces.vertices()[c]}});
        of = mesh.faces.vertices()[c];
    }
}

}  // namespace

void bind_edits(py::module_& m) {
    m.def(
        "keep_faces",
        [](const Mesh& mesh, const py::object& faces) { return unpacked(keep_faces(mesh, faces_of(mesh, faces))); },
        py::arg("mesh"), py::arg("faces"),
        "The given faces (ascending) and the vertices they name.\n\nReturns the mesh, and the old vertex of each "
        "vertex "
        "and the old face of each face.");
    m.def(
        "largest_component", [](const Mesh& mesh) { return unpacked(largest_component(mesh)); }, py::arg("mesh"),
        "The component with the most faces: mesh, old vertices, old faces.");
    m.def(
        "remove_unreferenced", [](const Mesh& mesh) { return unpacked(remove_unreferenced(mesh)); }, py::arg("mesh"),
        "The mesh without the vertices that no face names: mesh, old vertices, old faces.");
    m.def(
        "component_faces",
        [](const Mesh& mesh) {
            py::list result;
            for (const std::vector<int>& faces : component_faces(mesh)) result.append(index_array(faces));
            return result;
        },
        py::arg("mesh"), "The faces of every component, ascending.");
    m.def(
        "weld",
        [](const Mesh& mesh, double tolerance) {
            WeldedMesh welded = weld(mesh, tolerance);
            return py::make_tuple(std::move(welded.mesh), index_array(welded.welded));
        },
        py::arg("mesh"), py::arg("tolerance") = 0.0,
        "Makes vertices one that are no further apart than the tolerance (in the units of the positions).\n\n"
        "Returns the mesh, and the new vertex of each old one. Raises BadOption unless the tolerance is a number from "
        "0.");
    m.def(
        "suggest_weld",
        [](const Mesh& mesh) {
            const WeldSuggestion suggestion = suggest_weld(mesh);
            return py::make_tuple(suggestion.tolerance, suggestion.components);
        },
        py::arg("mesh"), "A tolerance for weld that joins the most components, and how many are left; 0: none does.");
    m.def(
        "orient",
        [](const Mesh& mesh) {
            OrientedMesh oriented = orient(mesh);
            return py::make_tuple(std::move(oriented.mesh), index_array(oriented.turned));
        },
        py::arg("mesh"),
        "Faces turned so that neighbours agree: the mesh and the faces that were turned.\n\nRaises BadMesh if there is "
        "no coherent orientation.");
    m.def(
        "cut_by_plane",
        [](const Mesh& mesh, const std::array<double, 3>& point, const std::array<double, 3>& normal) {
            CutMesh cut =
                cut_by_plane(mesh, HalfSpace::through(Eigen::Vector3d(point.data()), Eigen::Vector3d(normal.data())));
            return py::make_tuple(std::move(cut.mesh), index_array(cut.vertices), index_array(cut.faces));
        },
        py::arg("mesh"), py::arg("point"), py::arg("normal"),
        "Cuts along the plane through a point and keeps the side into which the normal points.\n\n"
        "Returns the mesh, the old vertex of each vertex (-1: new, on the plane) and the old face of each face.");
    m.def(
        "midpoint_subdivide",
        [](const Mesh& mesh) {
            SubdividedMesh finer = midpoint_subdivide(mesh);
            return py::make_tuple(std::move(finer.mesh), parents_array(finer.parents), index_array(finer.face_parents));
        },
        py::arg("mesh"),
        "Splits every face into four at the midpoints.\n\nReturns the mesh, the n×4 old vertices whose mean each new "
        "vertex is (-1: none) and the old face of each face.");
    m.def(
        "with_parents_means",
        [](const py::object& values, const py::object& parents) {
            const Eigen::VectorXcd old = complex_numbers(values, "values");
            const Eigen::MatrixXi rows = whole_table(parents, "parents", 4);
            std::vector<std::array<int, 4>> list;
            for (Eigen::Index i = 0; i < rows.rows(); ++i) {
                list.push_back({rows(i, 0), rows(i, 1), rows(i, 2), rows(i, 3)});
                const bool two = rows(i, 2) == -1 && rows(i, 3) == -1;
                for (int j = 0; j < (two ? 2 : 4); ++j)
                    if (rows(i, j) < 0 || rows(i, j) >= old.size())
                        throw Error(Cause::bad_option, "parents name vertices that have no value");
            }
            return with_parents_means(old, list);
        },
        py::arg("values"), py::arg("parents"),
        "Values at the old vertices, followed by those of new ones: the means over their parents.");
    m.def(
        "texture_charts",
        [](const Mesh& mesh) {
            require_texture(mesh);
            return index_lists(texture_charts(mesh));
        },
        py::arg("mesh"),
        "The charts that texture coordinates divide a mesh into: the faces of each, ascending.\n\nRaises BadMesh "
        "unless "
        "every corner has a point.");
    m.def(
        "cut_along_seams",
        [](const Mesh& mesh) {
            require_texture(mesh);
            return cut_along_seams(mesh, *mesh.texture);
        },
        py::arg("mesh"),
        "The mesh cut open along the seams of its texture: a vertex for every point, the faces in their "
        "order.\n\nRaises "
        "BadMesh unless every corner has a point that belongs to one vertex.");
    m.def(
        "fill_holes",
        [](const SurfacePtr& surface, int outer_loop) {
            require_loop(*surface, outer_loop);
            FilledSurface filled = without_lock([&] { return fill_holes(surface->surface, outer_loop); });
            return make_surface(std::move(filled.mesh), std::move(filled.metric));
        },
        py::arg("surface"), py::arg("outer_loop") = 0,
        "The surface with all boundary loops but one closed; the old vertices and faces come first.");
}

}  // namespace beltrami::python
