#include <beltrami/io/write_mesh.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <type_traits>
#include <utility>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/binary_source.h>
#include <beltrami/io/extension.h>

namespace beltrami {

namespace {

using Buffer = fmt::memory_buffer;

/// fmt's default is the shortest text that gives the same double back, in every locale; only the sign that a NaN may
/// have must go, as few readers know "-nan".
void append(Buffer& out, double value) {
    if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("{}"), value);
}

void append(Buffer& out, int value) {
    fmt::format_to(std::back_inserter(out), FMT_COMPILE("{}"), value);
}

void append(Buffer& out, std::string_view text) {
    out.append(text);
}

template <class... Parts>
void append_all(Buffer& out, const Parts&... parts) {
    (append(out, parts), ...);
}

void append_point(Buffer& out, const Mesh& mesh, int vertex) {
    const Eigen::Vector3d point = mesh.point(vertex);
    append_all(out, point.x(), " ", point.y(), " ", point.z());
}

template <class Number>
void append_binary(Buffer& out, Number value) {
    const auto bytes = to_bytes(value, std::endian::little);
    out.append(bytes.data(), bytes.data() + bytes.size());
}

void write(const std::filesystem::path& path, const Buffer& out) {
    write_atomically(path, {out.data(), out.size()});
}

void require_map_fits(const Mesh& mesh, const Positions& map) {
    if (map.rows() == mesh.vertex_count() && map.cols() == 2) return;
    throw Error(Cause::bad_option,
                fmt::format("the map to be written is {}×{}, the mesh has {} vertices", map.rows(), map.cols(),
                            mesh.vertex_count()),
                "give one row of two coordinates a vertex");
}

void require_columns_fit(const std::vector<Column>& columns, int rows, std::set<std::string> taken) {
    for (const Column& column : columns) {
        const bool is_word = !column.name.empty() &&
                             std::ranges::all_of(column.name, [](unsigned char c) { return c > 0x20 && c < 0x7F; });
        if (!is_word || !taken.insert(column.name).second) {
            throw Error(Cause::bad_option, fmt::format("a column cannot be called '{}'", column.name),
                        "give each column one ASCII word that no other has");
        }
        if (column.values.size() != rows) {
            throw Error(Cause::bad_option,
                        fmt::format("column {} has {} values instead of {}", column.name, column.values.size(), rows),
                        "give one value for each face or vertex");
        }
    }
}

void require_shades_fit(const Mesh& mesh, const std::vector<Shade>& shades) {
    if (shades.empty() || shades.size() == static_cast<std::size_t>(mesh.face_count())) return;
    throw Error(Cause::bad_option, fmt::format("{} faces have {} shades", mesh.face_count(), shades.size()),
                "give one for each face");
}

int grey(Shade shade) {
    return shade == Shade::light ? 240 : 40;
}

/// The rows of a PLY body, of which each encoding writes the numbers its own way.
class PlyRows {
  public:
    PlyRows(Buffer& out, PlyEncoding encoding) : out_(out), ascii_(encoding == PlyEncoding::ascii) {}

    void value(double number) { ascii_ ? append_all(out_, separator(), number) : append_binary(out_, number); }
    void value(double number, NumberType type) {
        switch (type) {
            case NumberType::int8:
                return typed<std::int8_t>(number);
            case NumberType::uint8:
                return typed<std::uint8_t>(number);
            case NumberType::int16:
                return typed<std::int16_t>(number);
            case NumberType::uint16:
                return typed<std::uint16_t>(number);
            case NumberType::int32:
                return typed<std::int32_t>(number);
            case NumberType::uint32:
                return typed<std::uint32_t>(number);
            case NumberType::float32:
                return typed<float>(number);
            case NumberType::float64:
                return value(number);
        }
    }
    /// Row @p row of a column of a file.
    void kept(const FileColumn& column, int row) {
        if (!column.length_type) return value(column.values[row], column.type);
        const int first = column.offsets[row], end = column.offsets[row + 1];
        value(end - first, *column.length_type);
        for (int entry = first; entry < end; ++entry) value(column.values[entry], column.type);
    }
    void byte(int number) {
        ascii_ ? append_all(out_, separator(), number) : append_binary(out_, static_cast<std::uint8_t>(number));
    }
    void list(std::span<const int> entries) {
        const auto length = static_cast<std::uint8_t>(entries.size());
        ascii_ ? append_all(out_, separator(), static_cast<int>(length)) : append_binary(out_, length);
        for (const int entry : entries) {
            ascii_ ? append_all(out_, separator(), entry) : append_binary(out_, std::int32_t{entry});
        }
    }
    void end_row() {
        if (ascii_) append(out_, "\n");
        first_ = true;
    }

  private:
    template <class Number>
    void typed(double number) {
        if (!ascii_) return append_binary(out_, static_cast<Number>(number));
        append(out_, separator());
        if constexpr (std::is_integral_v<Number>) {
            fmt::format_to(std::back_inserter(out_), FMT_COMPILE("{}"), static_cast<std::int64_t>(number));
        } else {
            fmt::format_to(std::back_inserter(out_), FMT_COMPILE("{}"), static_cast<Number>(number));
        }
    }
    std::string_view separator() { return std::exchange(first_, false) ? "" : " "; }

    Buffer& out_;
    bool ascii_;
    bool first_ = true;
};

}  // namespace

namespace {

const char* name_of(NumberType type) {
    switch (type) {
        case NumberType::int8:
            return "char";
        case NumberType::uint8:
            return "uchar";
        case NumberType::int16:
            return "short";
        case NumberType::uint16:
            return "ushort";
        case NumberType::int32:
            return "int";
        case NumberType::uint32:
            return "uint";
        case NumberType::float32:
            return "float";
        case NumberType::float64:
            return "double";
    }
    return "double";
}

void require_texture_fits(const Mesh& mesh, const TextureCoordinates& texture) {
    const auto names_a_point = [&](int point) { return point >= -1 && point < texture.points.rows(); };
    if (texture.points.cols() == 2 && texture.corners.size() == static_cast<std::size_t>(mesh.faces.corner_count()) &&
        std::ranges::all_of(texture.corners, names_a_point))
        return;
    throw Error(Cause::bad_option, "the texture coordinates do not fit the mesh",
                "give points of two coordinates and one index for each face corner");
}

void require_attributes_fit(const Mesh& mesh, const FileAttributes& attributes) {
    const auto fits = [](const std::vector<FileColumn>& columns, int rows) {
        return std::ranges::all_of(columns, [&](const FileColumn& column) {
            const std::size_t found = column.length_type ? column.offsets.size() : column.values.size() + 1;
            return found == static_cast<std::size_t>(rows) + 1;
        });
    };
    const bool states =
        attributes.face_states.empty() || attributes.face_states.size() == static_cast<std::size_t>(mesh.face_count());
    if (fits(attributes.vertex_columns, mesh.vertex_count()) && fits(attributes.face_columns, mesh.face_count()) &&
        states)
        return;
    throw Error(Cause::bad_option, "the attributes do not fit the mesh", "give one row for each vertex and each face");
}

/// The columns red, green, blue of the vertices, with what their numbers are to be divided by; or nothing.
struct Colours {
    std::array<const FileColumn*, 3> channels{};
    double unit = 1;
};
std::optional<Colours> colours_of(const FileAttributes& attributes) {
    Colours colours;
    constexpr std::array<std::string_view, 3> names{"red", "green", "blue"};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto found = std::ranges::find(attributes.vertex_columns, names[channel], &FileColumn::name);
        if (found == attributes.vertex_columns.end() || found->length_type) return std::nullopt;
        colours.channels[channel] = &*found;
    }
    if (colours.channels[0]->type == NumberType::uint8) colours.unit = 255;
    if (colours.channels[0]->type == NumberType::uint16) colours.unit = 65535;
    return colours;
}

/// What is said at a face and not at the one before.
void append_state(Buffer& out, const FileAttributes& attributes, int face) {
    if (attributes.face_states.empty()) return;
    const int state = attributes.face_states[face], before = face > 0 ? attributes.face_states[face - 1] : -1;
    if (state == before) return;
    for (const auto& [keyword, rest] : attributes.states[state]) {
        if (before >= 0) {
            const auto& said = attributes.states[before];
            const auto same = said.find(keyword);
            if (same != said.end() && same->second == rest) continue;
        }
        append_all(out, keyword, rest.empty() ? "" : " ", rest, "\n");
    }
}

/// The attributes' columns that are written beside others: bytes for OBJ's colours.
std::vector<FileColumn> kept_columns(const std::vector<FileColumn>& columns, const std::set<std::string>& taken,
                                     bool unit_colours) {
    std::vector<FileColumn> kept;
    for (const FileColumn& column : columns) {
        if (taken.contains(column.name)) continue;
        kept.push_back(column);
        if (!unit_colours || (column.name != "red" && column.name != "green" && column.name != "blue")) continue;
        kept.back().type = NumberType::uint8;
        for (double& value : kept.back().values) value = std::round(255 * std::clamp(value, 0.0, 1.0));
    }
    return kept;
}

void declare(Buffer& out, const std::vector<FileColumn>& columns) {
    for (const FileColumn& column : columns) {
        append(out, "property ");
        if (column.length_type) append_all(out, "list ", name_of(*column.length_type), " ");
        append_all(out, name_of(column.type), " ", column.name, "\n");
    }
}

}  // namespace

TextureCoordinates texture_of_map(const Mesh& mesh, const Positions& map) {
    require_map_fits(mesh, map);
    return {map, mesh.faces.vertices()};
}

void write_obj(const std::filesystem::path& path, const Mesh& mesh, const std::optional<TextureCoordinates>& texture,
               const std::vector<Shade>& shades, const FileAttributes& attributes) {
    require_shades_fit(mesh, shades);
    require_attributes_fit(mesh, attributes);
    if (texture) require_texture_fits(mesh, *texture);
    Buffer out;
    for (const std::string& line : attributes.header)
        if (line.starts_with("mtllib ")) append_all(out, line, "\n");
    const std::optional<Colours> colours = colours_of(attributes);
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        append(out, "v ");
        append_point(out, mesh, vertex);
        for (std::size_t channel = 0; colours && channel < 3; ++channel)
            append_all(out, " ", colours->channels[channel]->values[vertex] / colours->unit);
        append(out, "\n");
    }
    for (Eigen::Index point = 0; texture && point < texture->points.rows(); ++point) {
        append_all(out, "vt ", texture->points(point, 0), " ", texture->points(point, 1), "\n");
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        if (!shades.empty() && (face == 0 || shades[face] != shades[face - 1]))
            append(out, shades[face] == Shade::light ? "usemtl light\n" : "usemtl dark\n");
        append_state(out, attributes, face);
        append(out, "f");
        for (int corner = mesh.faces.first_corner(face); corner < mesh.faces.first_corner(face + 1); ++corner) {
            append_all(out, " ", mesh.faces.vertices()[corner] + 1);
            const int point = texture ? texture->corners[corner] : -1;
            if (point >= 0) append_all(out, "/", point + 1);
        }
        append(out, "\n");
    }
    write(path, out);
}

void write_off(const std::filesystem::path& path, const Mesh& mesh, const std::optional<Positions>& map,
               const std::vector<Shade>& shades) {
    require_shades_fit(mesh, shades);
    if (map) require_map_fits(mesh, *map);
    Buffer out;
    append_all(out, map ? "STOFF\n" : "OFF\n", mesh.vertex_count(), " ", mesh.face_count(), " 0\n");
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        append_point(out, mesh, vertex);
        if (map) append_all(out, " ", (*map)(vertex, 0), " ", (*map)(vertex, 1));
        append(out, "\n");
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        append(out, mesh.faces.degree(face));
        for (const int vertex : mesh.faces[face]) append_all(out, " ", vertex);
        for (int channel = 0; channel < 3 && !shades.empty(); ++channel) append_all(out, " ", grey(shades[face]));
        append(out, "\n");
    }
    write(path, out);
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh, const std::vector<Column>& face_columns,
               const std::vector<Column>& vertex_columns, PlyEncoding encoding, const std::vector<Shade>& shades,
               const FileAttributes& attributes) {
    require_shades_fit(mesh, shades);
    require_attributes_fit(mesh, attributes);
    require_columns_fit(face_columns, mesh.face_count(),
                        shades.empty() ? std::set<std::string>{"vertex_indices"}
                                       : std::set<std::string>{"vertex_indices", "red", "green", "blue"});
    require_columns_fit(vertex_columns, mesh.vertex_count(), {"x", "y", "z"});
    std::set<std::string> taken{"x", "y", "z"}, taken_of_faces{"vertex_indices", "vertex_index"};
    for (const Column& column : vertex_columns) taken.insert(column.name);
    for (const Column& column : face_columns) taken_of_faces.insert(column.name);
    if (taken.contains("u")) {
        taken.insert({"s", "t", "texture_u", "texture_v"});
        taken_of_faces.insert("texcoord");
    }
    if (!shades.empty()) taken_of_faces.insert({"red", "green", "blue"});
    const std::vector<FileColumn> kept = kept_columns(attributes.vertex_columns, taken, attributes.unit_colours),
                                  kept_of_faces = kept_columns(attributes.face_columns, taken_of_faces, false);
    Buffer out;
    append_all(out, "ply\nformat ", encoding == PlyEncoding::ascii ? "ascii" : "binary_little_endian", " 1.0\n");
    for (const std::string& line : attributes.header)
        if (line.starts_with("comment") || line.starts_with("obj_info")) append_all(out, line, "\n");
    append_all(out, "element vertex ", mesh.vertex_count(), "\nproperty double x\nproperty double y\n",
               mesh.positions.cols() > 2 ? "property double z\n" : "");
    for (const Column& column : vertex_columns) append_all(out, "property double ", column.name, "\n");
    declare(out, kept);
    append_all(out, "element face ", mesh.face_count(), "\nproperty list uchar int vertex_indices\n");
    for (const Column& column : face_columns) append_all(out, "property double ", column.name, "\n");
    declare(out, kept_of_faces);
    if (!shades.empty()) append(out, "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    append(out, "end_header\n");

    PlyRows rows(out, encoding);
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        for (const double coordinate : mesh.positions.row(vertex)) rows.value(coordinate);
        for (const Column& column : vertex_columns) rows.value(column.values[vertex]);
        for (const FileColumn& column : kept) rows.kept(column, vertex);
        rows.end_row();
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        rows.list(mesh.faces[face]);
        for (const Column& column : face_columns) rows.value(column.values[face]);
        for (const FileColumn& column : kept_of_faces) rows.kept(column, face);
        for (int channel = 0; channel < 3 && !shades.empty(); ++channel) rows.byte(grey(shades[face]));
        rows.end_row();
    }
    write(path, out);
}

namespace {

/// The points of every face's corners, u and v in turn; none for a face one of whose corners has none.
FileColumn texcoord_column(const Mesh& mesh, const TextureCoordinates& texture) {
    FileColumn column{"texcoord", NumberType::float64, NumberType::uint8, {}, {0}};
    for (int face = 0; face < mesh.face_count(); ++face) {
        const auto first = texture.corners.begin() + mesh.faces.first_corner(face),
                   last = first + mesh.faces.degree(face);
        if (std::find(first, last, -1) == last)
            for (auto corner = first; corner != last; ++corner)
                column.values.insert(column.values.end(), {texture.points(*corner, 0), texture.points(*corner, 1)});
        column.offsets.push_back(static_cast<int>(column.values.size()));
    }
    return column;
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const MeshOutput& output) {
    const std::string extension = lower_case_extension(path);
    const Mesh& mesh = output.mesh;
    if (output.map) require_map_fits(mesh, *output.map);
    if (output.corner_map) {
        require_texture_fits(mesh, *output.corner_map);
        if (output.map || extension == ".off")
            throw Error(Cause::bad_option,
                        output.map ? "there are two maps, one with seams and one without"
                                   : "OFF has one texture point a vertex and cannot hold a map with seams",
                        output.map ? "give one" : "write OBJ or PLY");
    }
    if (extension == ".obj") {
        write_obj(path, mesh,
                  output.corner_map ? output.corner_map
                  : output.map      ? texture_of_map(mesh, *output.map)
                                    : mesh.texture,
                  output.shades, output.attributes);
    } else if (extension == ".off") {
        write_off(path, mesh, output.map, output.shades);
    } else if (extension == ".ply") {
        std::vector<Column> vertex_columns;
        if (output.map) vertex_columns = {{"u", output.map->col(0)}, {"v", output.map->col(1)}};
        if (output.corner_map) {
            // In place of whatever texture the file had.
            FileAttributes attributes = output.attributes;
            const std::set<std::string> texture{"s", "t", "u", "v", "texture_u", "texture_v", "texcoord"};
            const auto is_texture = [&](const FileColumn& column) { return texture.contains(column.name); };
            std::erase_if(attributes.vertex_columns, is_texture);
            std::erase_if(attributes.face_columns, is_texture);
            attributes.face_columns.push_back(texcoord_column(mesh, *output.corner_map));
            return write_ply(path, mesh, output.face_columns, {}, PlyEncoding::binary_little_endian, output.shades,
                             attributes);
        }
        write_ply(path, mesh, output.face_columns, vertex_columns, PlyEncoding::binary_little_endian, output.shades,
                  output.attributes);
    } else {
        throw Error(
            Cause::unwritable,
            fmt::format("cannot write {}: the extension '{}' is none of .obj, .ply, .off", path.string(), extension),
            "name the output with one of these extensions");
    }
}

}  // namespace beltrami
