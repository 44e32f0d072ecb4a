#include "surface.h"

#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/operators/frames.h>

#include "module.h"
#include "pickle.h"

namespace beltrami::python {

SurfacePtr make_surface(Mesh mesh, std::optional<Positions> metric) {
    return std::make_shared<SurfaceObject>(surface_of(std::move(mesh), std::move(metric)));
}

Mesh checked(Mesh mesh) {
    std::vector<int> vertices, faces;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.positions.row(v).allFinite()) vertices.push_back(v);
    if (!vertices.empty())
        throw Error(Cause::bad_mesh,
                    "positions are not finite, the first is that of vertex " + std::to_string(vertices[0]), {},
                    {Things::vertices, vertices});
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f])
            if (v < 0 || v >= mesh.vertex_count() || mesh.faces.degree(f) < 3 || mesh.faces.degree(f) > 4) {
                faces.push_back(f);
                break;
            }
    if (!faces.empty())
        throw Error(Cause::bad_mesh,
                    "faces are no triangles or quads of vertices, the first is face " + std::to_string(faces[0]), {},
                    {Things::faces, faces});
    return mesh;
}

Eigen::VectorXcd map_of(const SurfaceObject& surface, const py::object& map, const char* name) {
    return complex_numbers(map, name, surface.vertex_count(), "vertices");
}

Eigen::VectorXcd samples_of(const SurfaceObject& surface, const py::object& values, const char* name) {
    Eigen::VectorXcd result = complex_numbers(values, name);
    if (result.size() == surface.sample_count()) return result;
    if (result.size() == surface.surface.mesh.face_count()) return mu_at_samples(surface.surface, result);
    throw Error(Cause::bad_option,
                std::string(name) + " has " + std::to_string(result.size()) + " numbers, and there are " +
                    std::to_string(surface.sample_count()) + " samples",
                "give one for each sample, or each face");
}

SurfacePtr in_space(const SurfacePtr& surface) {
    if (surface->surface.mesh.positions.cols() == 3) return surface;
    Mesh mesh = surface->surface.mesh;
    mesh.positions.conservativeResize(Eigen::NoChange, 3);
    mesh.positions.col(2).setZero();
    return make_surface(std::move(mesh), surface->surface.metric);
}

std::vector<Surface> surfaces_of(const std::vector<SurfacePtr>& surfaces, const std::vector<std::string>& names) {
    if (!names.empty() && names.size() != surfaces.size())
        throw Error(Cause::bad_option, "there are " + std::to_string(names.size()) + " names for " +
                                           std::to_string(surfaces.size()) + " surfaces");
    std::vector<Surface> list;
    for (const SurfacePtr& surface : surfaces) {
        if (!surface) throw py::type_error("surfaces are Surface objects");
        list.push_back(surface->surface);
    }
    return list;
}

void require_loop(const SurfaceObject& surface, int loop) {
    const auto count = static_cast<int>(surface.surface.topology.boundary_loops.size());
    if (loop < 0 || loop >= count)
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(loop),
                    "there are " + std::to_string(count) + ", counted from 0");
}

namespace {

SurfacePtr surface_from(const py::object& first, const py::object& F, const py::object& metric) {
    Mesh mesh;
    if (py::isinstance<Mesh>(first)) {
        if (!F.is_none()) throw py::type_error("a mesh has its faces: leave F out");
        mesh = first.cast<const Mesh&>();
    } else {
        if (F.is_none()) throw py::type_error("give V and F, or a mesh");
        mesh.positions = points(first, "V", Cause::bad_mesh);
        mesh.faces = face_list(F, mesh.vertex_count());
    }
    std::optional<Positions> corners;
    if (!metric.is_none()) {
        corners = points(metric, "metric");
        if (corners->rows() != mesh.faces.corner_count())
            throw Error(Cause::bad_option,
                        "metric has " + std::to_string(corners->rows()) + " points, and there are " +
                            std::to_string(mesh.faces.corner_count()) + " corners of faces",
                        "give one for each corner");
    }
    Interruption interruption;
    return without_lock(interruption, [&] { return make_surface(std::move(mesh), std::move(corners)); });
}

std::string sentence_of(const SurfaceObject& object) {
    const Topology& topology = object.surface.topology;
    const std::size_t loops = topology.boundary_loops.size();
    return "<beltrami.Surface: " + std::to_string(object.vertex_count()) + " vertices, " +
           std::to_string(object.surface.mesh.face_count()) + " faces, genus " + std::to_string(topology.genus) + ", " +
           std::to_string(loops) + (loops == 1 ? " boundary loop>" : " boundary loops>");
}

}  // namespace

void bind_surface(py::module_& m) {
    py::class_<SurfaceObject, SurfacePtr>(
        m, "Surface",
        "A mesh that passed the diagnosis, with its topology, operators and charts: what every solver starts from.\n\n"
        "Make it once and pass it on: conformal charts are made when they are first asked for and then kept. It has a "
        "copy of its own of V and F.")
        .def(py::init(&surface_from), py::arg("V"), py::arg("F") = py::none(), py::kw_only(),
             py::arg("metric") = py::none(),
             "V: #V×3 positions in space or #V×2 in the plane, or a Mesh, without F.\n"
             "F: #F×3 triangles, or #F×4 with -1 in the fourth column of triangles; counted from 0.\n"
             "metric: #corners×2 or ×3, one point for every face corner, which gives faces another shape than V "
             "(corners_from_lengths, texture_corners); #corners = F.size less the -1.\n\n"
             "Raises BadMesh with the offending vertices, edges or faces as indices, BadOption.")
        .def_property_readonly(
            "mesh", [](const SurfaceObject& object) { return object.surface.mesh; }, "A copy.")
        .def_property_readonly(
            "positions",
            [](const py::object& self) { return view(self.cast<const SurfaceObject&>().surface.mesh.positions, self); },
            "#V×3 or #V×2 positions")
        .def_property_readonly(
            "faces", [](const SurfaceObject& object) { return face_matrix(object.surface.mesh); },
            "#F×3, or #F×4 with -1 in the fourth column of triangles")
        .def_property_readonly("vertex_count", &SurfaceObject::vertex_count)
        .def_property_readonly("face_count",
                               [](const SurfaceObject& object) { return object.surface.mesh.face_count(); })
        .def_property_readonly("sample_count", &SurfaceObject::sample_count,
                               "#S: one sample a triangle, four a quad; μ and φ are known there")
        .def_property_readonly(
            "sample_faces", [](const SurfaceObject& object) { return index_array(object.surface.operators.faces); },
            "#S face of every sample")
        .def_property_readonly(
            "weights",
            [](const SurfaceObject& object) {
                return py::array_t<double>(static_cast<py::ssize_t>(object.surface.operators.weights.size()),
                                           object.surface.operators.weights.data());
            },
            "#S areas of the samples")
        .def_property_readonly("area", [](const SurfaceObject& object) { return object.surface.operators.area(); })
        .def_property_readonly("genus", [](const SurfaceObject& object) { return object.surface.topology.genus; })
        .def_property_readonly("components",
                               [](const SurfaceObject& object) { return object.surface.topology.components; })
        .def_property_readonly("euler_characteristic",
                               [](const SurfaceObject& object) { return object.surface.topology.euler_characteristic; })
        .def_property_readonly(
            "edges", [](const SurfaceObject& object) { return pairs_array(object.surface.topology.edges); },
            "#E×2 vertices of the edges, the smaller first")
        .def_property_readonly(
            "boundary_loops",
            [](const SurfaceObject& object) { return index_lists(object.surface.topology.boundary_loops); },
            "Vertices of every boundary loop, with the faces on the left; loop 0 is the outer one: in the plane the "
            "one that encloses the most, in space the longest")
        .def_property_readonly("loop_lengths",
                               [](const SurfaceObject& object) { return object.surface.topology.loop_lengths; })
        .def_property_readonly("in_plane", [](const SurfaceObject& object) { return object.surface.in_plane(); })
        .def_property_readonly(
            "findings", [](const SurfaceObject& object) { return object.surface.findings; },
            "Warnings of the diagnosis")
        .def(
            "d_z", [](const SurfaceObject& object) { return object.surface.operators.d_z(); },
            "∂ as a sparse #S×#V matrix (scipy.sparse)")
        .def(
            "d_zbar", [](const SurfaceObject& object) { return object.surface.operators.d_zbar(); },
            "∂̄ as a sparse #S×#V matrix (scipy.sparse)")
        .def(
            "prepare",
            [](const SurfaceObject& object, int outer_loop) {
                require_loop(object, outer_loop);
                without_lock([&] {
                    object.shape.circles(outer_loop);
                    object.shape.without_bridges().circles(outer_loop);
                    return 0;
                });
            },
            py::arg("outer_loop") = 0,
            "Makes the charts that maps onto, and distances from, other surfaces need. They are kept, and pickled "
            "along, so "
            "that other programs need not make them again.\n\nRaises BadMesh, NotSolved.")
        .def(py::pickle([](const SurfaceObject& object) { return state_of(object); },
                        [](const py::tuple& state) { return surface_from_state(state); }))
        .def("__repr__", &sentence_of);

    // Functions of meshes take surfaces as well.
    py::implicitly_convertible<SurfaceObject, Mesh>();

    m.def(
        "first_edge_directions", [](const SurfacePtr& surface) { return first_edge_directions(surface->surface); },
        py::arg("surface"), "#S: the direction of the face's first edge in the frame of every sample, of length 1.");
    m.def(
        "stereographic_derivatives",
        [](const SurfacePtr& surface) {
            if (surface->surface.mesh.positions.cols() != 3)
                throw Error(Cause::bad_option, "the surface does not lie on the unit sphere");
            return stereographic_derivatives(surface->surface);
        },
        py::arg("surface"),
        "#S: dz/dw of the stereographic coordinate at the middle of every sample's face, w in its frame.\n\nRaises "
        "BadOption naming vertices that are not on the unit sphere.");
    m.def(
        "mu_along_first_edge",
        [](const SurfaceObject& surface, const py::object& mu) {
            return mu_along_first_edge(surface.surface, samples_of(surface, mu, "mu"));
        },
        py::arg("surface"), py::arg("mu"),
        "μ of the samples in the frames whose real axis is the first edge of their face.\n\n"
        "mu: #S or #F in the samples' frames. Returns #S. Turning a planar mesh changes nothing of it.");
    m.def(
        "mu_at_samples",
        [](const SurfaceObject& surface, const py::object& face_mu, const std::string& frame) {
            return mu_at_samples(
                surface.surface, complex_numbers(face_mu, "face_mu"),
                Keywords::choice<CoefficientFrame>("frame", py::str(frame),
                                                   {{"samples", CoefficientFrame::samples},
                                                    {"first_edge", CoefficientFrame::first_edge},
                                                    {"plane", CoefficientFrame::plane},
                                                    {"stereographic", CoefficientFrame::stereographic}}));
        },
        py::arg("surface"), py::arg("face_mu"), py::arg("frame") = "samples",
        "Coefficients given for faces in the samples' frames.\n\nface_mu: #F. frame: \"samples\", \"first_edge\" "
        "(the face's first edge is the real axis) or \"plane\" (that of a planar mesh) or \"stereographic\" (of a mesh "
        "on the "
        "unit sphere). Returns #S.\n\nRaises BadOption if there are not #F of them, or the surface does not lie in the "
        "plane, or on the sphere.");
}

}  // namespace beltrami::python
