#include <beltrami/io/write_mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <span>
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
    std::string_view separator() { return std::exchange(first_, false) ? "" : " "; }

    Buffer& out_;
    bool ascii_;
    bool first_ = true;
};

}  // namespace

TextureCoordinates texture_of_map(const Mesh& mesh, const Positions& map) {
    require_map_fits(mesh, map);
    return {map, mesh.faces.vertices()};
}

void write_obj(const std::filesystem::path& path, const Mesh& mesh, const std::optional<TextureCoordinates>& texture,
               const std::vector<Shade>& shades) {
    require_shades_fit(mesh, shades);
    const auto names_a_point = [&](int point) { return point >= -1 && point < texture->points.rows(); };
    if (texture && (texture->points.cols() != 2 ||
                    texture->corners.size() != static_cast<std::size_t>(mesh.faces.corner_count()) ||
                    !std::ranges::all_of(texture->corners, names_a_point))) {
        throw Error(Cause::bad_option, "the texture coordinates do not fit the mesh",
                    "give points of two coordinates and one index for each face corner");
    }
    Buffer out;
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        append(out, "v ");
        append_point(out, mesh, vertex);
        append(out, "\n");
    }
    for (Eigen::Index point = 0; texture && point < texture->points.rows(); ++point) {
        append_all(out, "vt ", texture->points(point, 0), " ", texture->points(point, 1), "\n");
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        if (!shades.empty() && (face == 0 || shades[face] != shades[face - 1]))
            append(out, shades[face] == Shade::light ? "usemtl light\n" : "usemtl dark\n");
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
               const std::vector<Column>& vertex_columns, PlyEncoding encoding, const std::vector<Shade>& shades) {
    require_shades_fit(mesh, shades);
    require_columns_fit(face_columns, mesh.face_count(),
                        shades.empty() ? std::set<std::string>{"vertex_indices"}
                                       : std::set<std::string>{"vertex_indices", "red", "green", "blue"});
    require_columns_fit(vertex_columns, mesh.vertex_count(), {"x", "y", "z"});
    Buffer out;
    append_all(out, "ply\nformat ", encoding == PlyEncoding::ascii ? "ascii" : "binary_little_endian", " 1.0\n",
               "element vertex ", mesh.vertex_count(), "\nproperty double x\nproperty double y\n",
               mesh.positions.cols() > 2 ? "property double z\n" : "");
    for (const Column& column : vertex_columns) append_all(out, "property double ", column.name, "\n");
    append_all(out, "element face ", mesh.face_count(), "\nproperty list uchar int vertex_indices\n");
    for (const Column& column : face_columns) append_all(out, "property double ", column.name, "\n");
    if (!shades.empty()) append(out, "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    append(out, "end_header\n");

    PlyRows rows(out, encoding);
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        for (const double coordinate : mesh.positions.row(vertex)) rows.value(coordinate);
        for (const Column& column : vertex_columns) rows.value(column.values[vertex]);
        rows.end_row();
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        rows.list(mesh.faces[face]);
        for (const Column& column : face_columns) rows.value(column.values[face]);
        for (int channel = 0; channel < 3 && !shades.empty(); ++channel) rows.byte(grey(shades[face]));
        rows.end_row();
    }
    write(path, out);
}

void write_mesh(const std::filesystem::path& path, const MeshOutput& output) {
    const std::string extension = lower_case_extension(path);
    const Mesh& mesh = output.mesh;
    if (output.map) require_map_fits(mesh, *output.map);
    if (extension == ".obj") {
        write_obj(path, mesh, output.map ? texture_of_map(mesh, *output.map) : mesh.texture, output.shades);
    } else if (extension == ".off") {
        write_off(path, mesh, output.map, output.shades);
    } else if (extension == ".ply") {
        std::vector<Column> vertex_columns;
        if (output.map) vertex_columns = {{"u", output.map->col(0)}, {"v", output.map->col(1)}};
        write_ply(path, mesh, output.face_columns, vertex_columns, PlyEncoding::binary_little_endian, output.shades);
    } else {
        throw Error(
            Cause::unwritable,
            fmt::format("cannot write {}: the extension '{}' is none of .obj, .ply, .off", path.string(), extension),
            "name the output with one of these extensions");
    }
}

}  // namespace beltrami
