#include <beltrami/io/read_mesh.h>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/read_file.h>

namespace beltrami {

LoadedMesh read_mesh(const std::filesystem::path& path) {
    const std::string extension = lower_case_extension(path);
    const auto reader = extension == ".obj"   ? &read_obj
                        : extension == ".ply" ? &read_ply
                        : extension == ".off" ? &read_off
                        : extension == ".stl" ? &read_stl
                                              : nullptr;
    if (!reader) {
        throw Error(Cause::unreadable,
                    fmt::format("cannot read {}: the extension '{}' is none of .obj, .ply, .off, .stl", path.string(),
                                extension),
                    "convert the mesh to one of these formats");
    }
    return reader(read_file(path), path.string());
}

}  // namespace beltrami
