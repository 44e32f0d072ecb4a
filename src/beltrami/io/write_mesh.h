#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/io/file_attributes.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

// All writers write completely or not at all (see AtomicFile), with the fewest digits that give the same double back:
// what is read again is the same mesh, bit for bit. Where a format demands three coordinates, a mesh of the plane gets
// z = 0.

/// A named number for each face or each vertex.
struct Column {
    std::string name;        ///< one word
    Eigen::VectorXd values;  ///< #F or #V
};

/// Two colours for the faces, as of a checkerboard: materials called light and dark in OBJ (there is no file of
/// materials), RGB in PLY and OFF. One a face, or none at all.
enum class Shade : unsigned char { light, dark };

enum class PlyEncoding { ascii, binary_little_endian };

/// A map of the mesh's vertices to the plane as texture coordinates: one point a vertex, without seams.
/// @param map #V×2
/// @throw Error bad_option if it has another shape
TextureCoordinates texture_of_map(const Mesh& mesh, const Positions& map);

/// Writes a Wavefront OBJ.
/// @param texture    written as vt; pass mesh.texture to keep the mesh's own, or texture_of_map()
/// @param attributes vertex columns red, green, blue become colours of the vertices; files of materials and statements
///                   at the faces are written again
/// @throw Error unwritable; bad_option if the texture, the shades or the attributes do not fit the mesh
void write_obj(const std::filesystem::path& path, const Mesh& mesh,
               const std::optional<TextureCoordinates>& texture = std::nullopt, const std::vector<Shade>& shades = {},
               const FileAttributes& attributes = {});

/// Writes a text OFF, or a STOFF if there is a map. The mesh's own texture is not written.
/// @param map #V×2, texture coordinates of the vertices
/// @throw Error unwritable; bad_option if the map or the shades do not fit the mesh
void write_off(const std::filesystem::path& path, const Mesh& mesh, const std::optional<Positions>& map = std::nullopt,
               const std::vector<Shade>& shades = {});

/// Writes a PLY with all numbers as double, without z if the mesh has none. The mesh's own texture is not written.
/// @param face_columns   further properties of the faces, for instance mu_re, mu_im, abs_mu, K
/// @param vertex_columns further properties of the vertices; u and v are read back as texture coordinates
/// @param attributes     their columns and comments are written again, but for columns whose names are taken, and for
///                       texture coordinates where u and v are written; colours of OBJ become bytes
/// @throw Error unwritable; bad_option if shades, a column or the attributes do not fit the mesh or a column's name is
///        not a word of its own
void write_ply(const std::filesystem::path& path, const Mesh& mesh, const std::vector<Column>& face_columns = {},
               const std::vector<Column>& vertex_columns = {}, PlyEncoding encoding = PlyEncoding::binary_little_endian,
               const std::vector<Shade>& shades = {}, const FileAttributes& attributes = {});

/// What write_mesh() writes.
struct MeshOutput {
    const Mesh& mesh;
    std::optional<Positions> map = std::nullopt;  ///< #V×2: where the vertices go
    std::vector<Column> face_columns = {};
    std::vector<Shade> shades = {};
    FileAttributes attributes = {};  ///< of the mesh's file
    /// A map with seams, one point per face corner, in place of one per vertex: of a closed surface cut open.
    std::optional<TextureCoordinates> corner_map = std::nullopt;
};

/// Writes in the format the extension names, in either case: .obj (the map as vt, or else the mesh's own texture),
/// .ply (binary; the map as vertex properties u and v, the face columns) or .off (the map as STOFF). Only .ply can hold
/// face columns, the other formats go without; attributes as write_obj() and write_ply() take them. A map with seams
/// becomes vt of OBJ and lists texcoord of the faces of PLY.
/// @throw Error unwritable, also if the extension is unknown; bad_option if the map, a column or the shades do not fit
///        the mesh, for two maps, and for one with seams in .off
void write_mesh(const std::filesystem::path& path, const MeshOutput& output);

}  // namespace beltrami
