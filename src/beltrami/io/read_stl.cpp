#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>

#include <fmt/format.h>

#include <beltrami/io/binary_source.h>
#include <beltrami/io/mesh_builder.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

using Point = std::array<double, 3>;

constexpr std::size_t header_bytes = 80;
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, two attribute bytes

bool equals_ignoring_case(std::string_view word, std::string_view lower_case) {
    return std::ranges::equal(word, lower_case, {}, [](unsigned char c) { return std::tolower(c); });
}

std::size_t binary_triangle_count(std::string_view bytes, const std::string& name) {
    return BinarySource(bytes, header_bytes, std::endian::little, name).read<std::uint32_t>();
}

/// A text begins with "solid", but so do the headers of many binary files: these have the size their count says, or
/// a zero byte early on.
bool is_binary(std::string_view bytes, const std::string& name) {
    constexpr std::size_t preamble = header_bytes + 4;
    if (bytes.size() >= preamble && bytes.size() == preamble + triangle_bytes * binary_triangle_count(bytes, name)) {
        return true;
    }
    TextScanner scanner(bytes, name);
    const bool begins_as_text = scanner.next_line() && equals_ignoring_case(scanner.word(), "solid");
    const bool has_zero_byte = bytes.substr(0, preamble).find('\0') != std::string_view::npos;
    if (begins_as_text && !has_zero_byte) return false;
    if (bytes.size() < preamble) fail_to_read(name, "this is no STL file, neither text nor binary");
    return true;
}

/// For each corner the first corner with the same coordinates. Sorted, not hashed: no choice of coordinates can make
/// it slow.
std::vector<std::size_t> first_equal(const std::vector<Point>& corners) {
    using Key = std::array<std::uint64_t, 4>;  // the bits of x, y and z, then the corner
    std::vector<Key> keys(corners.size());
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        const auto& [x, y, z] = corners[corner];
        // Adding 0 turns −0 into 0 and leaves everything else as it is.
        keys[corner] = {std::bit_cast<std::uint64_t>(x + 0.0), std::bit_cast<std::uint64_t>(y + 0.0),
                        std::bit_cast<std::uint64_t>(z + 0.0), corner};
    }
    std::ranges::sort(keys);
    std::vector<std::size_t> first(corners.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool repeats = i > 0 && std::equal(keys[i].begin(), keys[i].end() - 1, keys[i - 1].begin());
        first[keys[i][3]] = repeats ? first[keys[i - 1][3]] : keys[i][3];
    }
    return first;
}

/// The corners of all triangles, each triangle with its own three.
std::vector<Point> read_binary_corners(std::string_view bytes, const std::string& name) {
    const std::size_t count = binary_triangle_count(bytes, name);
    BinarySource source(bytes, header_bytes + 4, std::endian::little, name);
    if (count > source.remaining() / triangle_bytes) {
        source.fail(
            fmt::format("the file announces {} triangles, but only {} bytes follow", count, source.remaining()));
    }
    std::vector<Point> corners(3 * count);
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        if (corner % 3 == 0) source.skip(corner == 0 ? 12 : 14);  // attribute of the last triangle, normal of this one
        for (double& coordinate : corners[corner]) coordinate = source.read<float>();
    }
    return corners;
}

std::vector<Point> read_text_corners(std::string_view bytes, const std::string& name) {
    TextScanner scanner(bytes, name);
    std::vector<Point> corners;
    std::size_t whole = 0;  // corners of the triangles that are complete
    bool inside_solid = false;
    while (scanner.next_line()) {
        const std::string_view word = scanner.word();
        const auto is = [&](std::string_view keyword) { return equals_ignoring_case(word, keyword); };
        if (is("vertex")) {
            Point& corner = corners.emplace_back();
            for (double& coordinate : corner) coordinate = scanner.number("a coordinate");
        } else if (is("endloop")) {
            if (corners.size() != whole + 3) {
                scanner.fail(fmt::format("a facet has {} vertices, it needs 3", corners.size() - whole));
            }
            whole = corners.size();
        } else if (is("solid") || is("endsolid")) {
            inside_solid = is("solid");
        } else if (!is("facet") && !is("outer") && !is("endfacet")) {
            scanner.fail(fmt::format("{} is not a statement of an STL file", in_quotes(word)));
        }
    }
    if (inside_solid || corners.size() != whole) scanner.fail("the file ends inside a solid");
    return corners;
}

}  // namespace

LoadedMesh read_stl(std::string_view bytes, const std::string& name) {
    const std::vector<Point> corners =
        is_binary(bytes, name) ? read_binary_corners(bytes, name) : read_text_corners(bytes, name);
    const std::vector<std::size_t> first = first_equal(corners);
    MeshBuilder builder(name);
    std::vector<int> vertices(corners.size());
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        if (first[corner] == corner) {
            vertices[corner] = static_cast<int>(builder.vertex_count());
            builder.add_vertex(corners[corner]);
        } else {
            vertices[corner] = vertices[first[corner]];
        }
    }
    for (std::size_t corner = 0; corner < corners.size(); corner += 3) {
        builder.add_face(std::span(vertices).subspan(corner, 3));
    }
    return builder.finish();
}

}  // namespace beltrami
