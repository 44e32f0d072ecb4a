#include <beltrami/io/atomic_file.h>
#include <beltrami/io/coefficient_file.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/target_file.h>
#include <beltrami/io/write_mesh.h>

#include "module.h"
#include "surface.h"

#include <pybind11/stl/filesystem.h>

namespace beltrami::python {

namespace {

Mesh issued(const Warnings& warnings, Mesh mesh) {
    for (const Warning& warning : warnings)
        if (PyErr_WarnEx(PyExc_UserWarning, warning.sentence.c_str(), 2) != 0) throw py::error_already_set();
    return checked(std::move(mesh));
}

template <class Read>
void bind_bytes(py::module_& m, const char* name, const char* about, Read read) {
    m.def(
        name,
        [read](const py::bytes& bytes, const std::string& file) {
            const auto text = static_cast<std::string>(bytes);
            LoadedMesh loaded = without_lock([&] { return read(text, file); });
            return issued(loaded.warnings, std::move(loaded.mesh));
        },
        py::arg("bytes"), py::arg("name") = "the mesh", about);
}

void write(const std::filesystem::path& path, const py::object& mesh, const py::object& map) {
    const Mesh& written =
        py::isinstance<Mesh>(mesh) ? mesh.cast<const Mesh&>() : mesh.cast<const SurfaceObject&>().surface.mesh;
    MeshOutput output{written};
    if (!map.is_none()) {
        const Eigen::VectorXcd images = complex_numbers(map, "map", written.vertex_count(), "vertices");
        output.map = Positions(images.size(), 2);
        output.map->col(0) = images.real();
        output.map->col(1) = images.imag();
    }
    const py::gil_scoped_release release;
    write_mesh(path, output);
}

}  // namespace

void bind_files(py::module_& m) {
    m.def(
        "read_mesh",
        [](const std::filesystem::path& path) {
            LoadedMesh loaded = without_lock([&] { return read_mesh(path); });
            return issued(loaded.warnings, std::move(loaded.mesh));
        },
        py::arg("path"),
        "Reads .obj, .ply, .off or .stl: vertices and faces in the order of the file.\n\nWhat the file holds and the "
        "mesh "
        "does not is said by warnings.warn.\n\nRaises Unreadable, BadMesh for numbers that are not finite.");
    bind_bytes(m, "read_obj",
               "The Mesh of a Wavefront OBJ held in memory.\n\nname: what errors call it. Raises Unreadable, BadMesh.",
               &read_obj);
    bind_bytes(m, "read_ply", "The same of PLY, ascii or binary.", &read_ply);
    bind_bytes(m, "read_off", "The same of OFF.", &read_off);
    bind_bytes(m, "read_stl", "The same of STL, text or binary.", &read_stl);
    m.def("write_mesh", &write, py::arg("path"), py::arg("mesh"), py::arg("map") = py::none(),
          "Writes .obj, .ply (binary) or .off, at once or not at all.\n\nmesh: a Mesh or Surface. map: #V complex or "
          "#V×2, written as texture coordinates; else the mesh's own.\n\nRaises Unwritable, BadOption.");
    m.def("read_coefficient", &read_coefficient, py::arg("path"), py::arg("face_count"),
          "Reads a Beltrami coefficient, one number a face (docs/formats.md): #F complex.\n\nRaises Unreadable.");
    m.def("read_target_domain", &read_target_domain, py::arg("path"),
          "Reads a target domain from JSON (docs/target-domains.md).\n\nRaises Unreadable, BadOption.");
    m.def("write_target_domain", &write_target_domain, py::arg("path"), py::arg("domain"),
          "Writes what read_target_domain reads, to the last bit.\n\nRaises Unwritable.");
    m.def("parse_target_domain", &parse_target_domain, py::arg("text"), py::arg("name") = "the domain",
          "A target domain from JSON text.\n\nRaises Unreadable, BadOption.");
    m.def("format_target_domain", &format_target_domain, py::arg("domain"), "A target domain as JSON text.");
}

}  // namespace beltrami::python
