#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/io/file_attributes.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh as its file has it, and what the file held that the mesh does not.
struct LoadedMesh {
    Mesh mesh;
    FileAttributes attributes = {};                ///< what else the file says of vertices and faces
    std::optional<Eigen::VectorXcd> face_mu = {};  ///< #F from a PLY's face properties mu_re and mu_im
    Warnings warnings;                             ///< empty if all was taken
};

/// Reads a mesh in the format its extension names: .obj, .ply, .off or .stl, in either case.
///
/// Vertices, faces (triangles and quads) and texture coordinates come in the order of the file. A face with more than
/// four corners is cut into triangles (polygon_split.h), with a warning that names its line (or byte). Groups,
/// materials and vertex colours of OBJ and further properties of PLY are attributes; normals of OBJ and colours of OFF
/// are ignored. Numbers are read the same way in every locale; "nan" and "inf" are taken as they stand, for diagnose()
/// to report. A false count never makes a reader take more memory than a small multiple of the file's size.
///
/// @throw Error unreadable if the extension is unknown, the file cannot be read, is malformed or truncated, holds no
///        vertex, or a face has fewer than three corners or names a vertex that is not there.
LoadedMesh read_mesh(const std::filesystem::path& path);

/// Reads a Wavefront OBJ held in memory. Texture points keep their first two numbers.
/// @param name what errors and warnings call the file
/// @throw Error unreadable
LoadedMesh read_obj(std::string_view bytes, const std::string& name);

/// Reads a PLY held in memory: ascii or binary of either byte order. Without a property z the positions are #V×2.
/// The vertex properties (s, t), (u, v) or (texture_u, texture_v) become texture coordinates, one point a vertex; or
/// the face lists texcoord do (two numbers per corner, corners of one vertex with equal numbers share a point). The
/// face properties mu_re and mu_im become coefficients, unless faces have to be cut. All other properties are
/// attributes, as are comments; other elements are passed over.
/// @param name what errors and warnings call the file
/// @throw Error unreadable
LoadedMesh read_ply(std::string_view bytes, const std::string& name);

/// Reads a text OFF held in memory, lines or a mere stream of numbers, also with colours, normals and texture
/// coordinates (COFF, NOFF, STOFF …); of these only texture coordinates, the last two numbers of a vertex line, are
/// kept.
/// @param name what errors and warnings call the file
/// @throw Error unreadable
LoadedMesh read_off(std::string_view bytes, const std::string& name);

/// Reads an STL held in memory, text or binary. The format lists each triangle's corners anew and has no notion of
/// a shared vertex, so corners with identical coordinates (bit for bit; −0 counts as 0) become one vertex. Vertices are
/// in the order of their first appearance.
/// @param name what errors and warnings call the file
/// @throw Error unreadable
LoadedMesh read_stl(std::string_view bytes, const std::string& name);

}  // namespace beltrami
