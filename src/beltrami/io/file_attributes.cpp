#include <beltrami/io/file_attributes.h>

#include <cmath>

namespace beltrami {

namespace {

bool is_whole(NumberType type) {
    return type != NumberType::float32 && type != NumberType::float64;
}

/// A column whose row i is the mean of the rows named; lists cannot be averaged and are those of the first row named.
template <class RowsOf>
FileColumn carried(const FileColumn& column, std::size_t rows, const RowsOf& rows_of) {
    FileColumn result{column.name, column.type, column.length_type, {}, {}};
    if (column.length_type) result.offsets.push_back(0);
    for (std::size_t row = 0; row < rows; ++row) {
        const auto from = rows_of(row);
        if (column.length_type) {
            if (!from.empty())
                result.values.insert(result.values.end(), column.values.begin() + column.offsets[from[0]],
                                     column.values.begin() + column.offsets[from[0] + 1]);
            result.offsets.push_back(static_cast<int>(result.values.size()));
            continue;
        }
        double mean = 0;
        for (const int r : from) mean += column.values[r] / static_cast<double>(from.size());
        if (from.size() == 1) mean = column.values[from[0]];
        result.values.push_back(is_whole(column.type) ? std::round(mean) : mean);
    }
    return result;
}

}  // namespace

FileAttributes carried(const FileAttributes& attributes, const std::vector<std::vector<int>>& vertices,
                       const std::vector<int>& faces) {
    FileAttributes result;
    result.unit_colours = attributes.unit_colours;
    result.header = attributes.header;
    result.states = attributes.states;
    for (const FileColumn& column : attributes.vertex_columns)
        result.vertex_columns.push_back(
            carried(column, vertices.size(), [&](std::size_t v) -> const std::vector<int>& { return vertices[v]; }));
    for (const FileColumn& column : attributes.face_columns)
        result.face_columns.push_back(
            carried(column, faces.size(), [&](std::size_t f) { return std::vector<int>{faces[f]}; }));
    if (!attributes.face_states.empty())
        for (const int f : faces) result.face_states.push_back(attributes.face_states[f]);
    return result;
}

}  // namespace beltrami
