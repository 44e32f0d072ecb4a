#include <beltrami/io/read_mesh.h>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/read_file.h>
#include <beltrami/io/read_polygons.h>

namespace beltrami {

namespace {

LoadedMesh read(const std::filesystem::path& path, LargeFaces large_faces) {
    const std::string extension = lower_case_extension(path), name = path.string();
    if (extension == ".obj") return read_obj(read_file(path), name, large_faces);
    if (extension == ".ply") return read_ply(read_file(path), name, large_faces);
    if (extension == ".off") return read_off(read_file(path), name, large_faces);
    if (extension == ".stl") return read_stl(read_file(path), name);
    throw Error(Cause::unreadable,
                fmt::format("cannot read {}: the extension '{}' is none of .obj, .ply, .off, .stl", name, extension),
                "convert the mesh to one of these formats");
}

}  // namespace

LoadedMesh read_mesh(const std::filesystem::path& path) {
    return read(path, LargeFaces::cut);
}

LoadedMesh read_polygons(const std::filesystem::path& path) {
    return read(path, LargeFaces::keep);
}

}  // namespace beltrami
