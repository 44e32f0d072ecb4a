#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Types of numbers in a PLY file.
enum class NumberType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// A property of vertices or faces that has no part in the mesh: colours, normals, labels …
struct FileColumn {
    std::string name;
    NumberType type = NumberType::float64;  ///< of the values
    std::optional<NumberType> length_type;  ///< present: every row has a list of values
    std::vector<double> values;             ///< one a row; of lists, the entries of all rows, row after row
    std::vector<int> offsets;               ///< of lists: #rows+1 positions in values
};

/// What a file says of a mesh beyond positions, faces and texture coordinates, kept so that it can be written again.
struct FileAttributes {
    /// PLY properties. Vertex colours of OBJ are the columns red, green, blue, with unit_colours.
    std::vector<FileColumn> vertex_columns, face_columns;
    bool unit_colours = false;        ///< the columns red, green, blue of the vertices are OBJ's, in [0, 1]
    std::vector<std::string> header;  ///< OBJ: lines that name files of materials; PLY: comments
    /// OBJ: the statements in force at a face (usemtl, g, o, s) by keyword, each with the rest of its line.
    std::vector<std::map<std::string, std::string>> states;
    std::vector<int> face_states;  ///< #F indices into states; empty if there are none

    bool empty() const {
        return vertex_columns.empty() && face_columns.empty() && header.empty() && face_states.empty();
    }
};

/// The attributes of a mesh made from another one.
/// @param vertices for each new vertex the old ones whose mean it is (numbers that are whole stay so); none: 0
/// @param faces    for each new face the old one it is (a part of)
FileAttributes carried(const FileAttributes& attributes, const std::vector<std::vector<int>>& vertices,
                       const std::vector<int>& faces);

}  // namespace beltrami
