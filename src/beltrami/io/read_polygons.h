#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <beltrami/base/public.h>
#include <beltrami/io/mesh_builder.h>

namespace beltrami BELTRAMI_PUBLIC {

/// As read_mesh(), but faces with more than four corners stay as they are, for what measures polygons by their corner
/// triangles (space/polygon_surface.h).
/// @throw Error unreadable as read_mesh()
LoadedMesh read_polygons(const std::filesystem::path& path);

// The readers of read_mesh.h, told what becomes of such faces.
LoadedMesh read_obj(std::string_view bytes, const std::string& name, LargeFaces large_faces);
LoadedMesh read_ply(std::string_view bytes, const std::string& name, LargeFaces large_faces);
LoadedMesh read_off(std::string_view bytes, const std::string& name, LargeFaces large_faces);

}  // namespace beltrami
