#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/mesh_builder.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/read_polygons.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

/// What the first word says: any of ST, C, N before OFF.
struct OffHeader {
    bool has_texture = false;
    bool plain = true;  ///< vertices are three numbers
};

OffHeader read_header(TextScanner& scanner) {
    if (!scanner.next_line()) scanner.fail("the file is empty");
    std::string word(scanner.word());
    std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::toupper(c); });
    std::string_view kind = word;
    OffHeader header;
    if (kind.starts_with("ST")) {
        header.has_texture = true;
        kind.remove_prefix(2);
    }
    header.plain = kind == "OFF" && !header.has_texture;
    if (kind.starts_with('C')) kind.remove_prefix(1);
    if (kind.starts_with('N')) kind.remove_prefix(1);
    if (kind != "OFF") {
        scanner.fail(fmt::format("the file begins with {}, not with OFF (or COFF, NOFF, STOFF)", in_quotes(word)));
    }
    return header;
}

std::size_t read_count(TextScanner& scanner, const char* things) {
    const std::int64_t count = scanner.integer(fmt::format("the number of {}", things));
    // A vertex or a face takes more than two bytes, so a false count is seen before anything is allocated for it.
    const std::size_t bytes = scanner.rest().size();
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes / 2) {
        scanner.fail(fmt::format("the file announces {} {}, but only {} bytes follow", count, things, bytes));
    }
    return static_cast<std::size_t>(count);
}

[[noreturn]] void fail_at_end(const TextScanner& scanner, const char* things, std::size_t found, std::size_t count) {
    scanner.fail(fmt::format("the file ends after {} of {} {}", found, count, things));
}

/// How the numbers are set out: each vertex and each face begins a line and what follows its numbers there, colours
/// for instance, belongs to it; or the lines mean nothing.
enum class Layout { lines, stream };

/// Goes on to the next line where this one holds no further number of a vertex or a face.
void reach_number(TextScanner& scanner) {
    if (!scanner.at_line_end()) return;
    TextScanner ahead = scanner;
    if (ahead.next_line()) scanner = ahead;
}

/// Goes to the next vertex or face; false at the end of the text.
bool reach_record(TextScanner& scanner, Layout layout) {
    return (layout == Layout::stream && !scanner.at_line_end()) || scanner.next_line();
}

void read_vertex(TextScanner& scanner, bool has_texture, MeshBuilder& builder) {
    std::array<double, 3> point;
    for (double& coordinate : point) {
        reach_number(scanner);
        coordinate = scanner.number("a coordinate");
    }
    builder.add_vertex(point);
    if (!has_texture) return;
    double u = scanner.number("a texture coordinate");
    double v = scanner.number("a texture coordinate");
    while (!scanner.at_line_end()) {  // normals and colours stand before the texture coordinates
        u = v;
        v = scanner.number("a texture coordinate");
    }
    builder.add_texture_point(u, v);
}

LoadedMesh read_as(Layout layout, std::string_view bytes, const std::string& name, LargeFaces large_faces) {
    TextScanner scanner(bytes, name);
    const OffHeader header = read_header(scanner);
    if (layout == Layout::stream && !header.plain) scanner.fail("a stream of numbers has no colours");
    reach_number(scanner);
    const std::size_t vertex_count = read_count(scanner, "vertices");
    reach_number(scanner);
    const std::size_t face_count = read_count(scanner, "faces");
    if (layout == Layout::stream) {  // the number of edges
        reach_number(scanner);
        scanner.integer("the number of edges");
    }

    MeshBuilder builder(name, 3, large_faces);
    builder.reserve_vertices(vertex_count);
    if (header.has_texture) builder.use_texture_per_vertex();
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        if (!reach_record(scanner, layout)) fail_at_end(scanner, "vertices", vertex, vertex_count);
        read_vertex(scanner, header.has_texture, builder);
    }
    std::vector<int> corners;
    for (std::size_t face = 0; face < face_count; ++face) {
        if (!reach_record(scanner, layout)) fail_at_end(scanner, "faces", face, face_count);
        const std::int64_t degree = scanner.integer("the number of corners");
        if (degree < 3) scanner.fail(fmt::format("a face names {} corners, it needs at least 3", degree));
        corners.clear();
        for (std::int64_t corner = 0; corner < degree; ++corner) {
            reach_number(scanner);
            const std::int64_t vertex = scanner.integer("a vertex index");
            if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_count) {
                scanner.fail(fmt::format("a face names vertex {}, but the file has vertices 0 to {}", vertex,
                                         static_cast<std::int64_t>(vertex_count) - 1));
            }
            corners.push_back(static_cast<int>(vertex));
        }
        builder.add_face(corners, {}, scanner);
    }
    return builder.finish();
}

}  // namespace

LoadedMesh read_off(std::string_view bytes, const std::string& name) {
    return read_off(bytes, name, LargeFaces::cut);
}

LoadedMesh read_off(std::string_view bytes, const std::string& name, LargeFaces large_faces) {
    try {
        return read_as(Layout::lines, bytes, name, large_faces);
    } catch (const Error&) {
        // Where lines mean nothing there are fewer of them than vertices and faces, and so that has failed.
        try {
            return read_as(Layout::stream, bytes, name, large_faces);
        } catch (const Error&) {
        }
        throw;
    }
}

}  // namespace beltrami
