#include <beltrami/io/binary_source.h>
#include <beltrami/io/read_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

void expect_off_error(const std::string& part, std::string_view text) {
    expect_error(Cause::unreadable, part, [&] { read_off(text, "t.off"); });
}

void expect_stl_error(const std::string& part, std::string_view bytes) {
    expect_error(Cause::unreadable, part, [&] { read_stl(bytes, "t.stl"); });
}

using Triangle = std::array<std::array<float, 3>, 3>;

template <class Number>
void append(std::string& bytes, Number value) {
    const auto raw = to_bytes(value, std::endian::little);
    bytes.append(raw.data(), raw.size());
}

std::string binary_stl(std::string header, const std::vector<Triangle>& triangles) {
    header.resize(80, ' ');
    append(header, static_cast<std::uint32_t>(triangles.size()));
    for (const Triangle& triangle : triangles) {
        header.append(12, '\0');
        for (const auto& corner : triangle) {
            for (const float coordinate : corner) append(header, coordinate);
        }
        header.append(2, '\0');
    }
    return header;
}

// Two triangles that share an edge, one end of which is (0, 0, 0) here and (−0, 0, 0) there.
const std::vector<Triangle> two_triangles{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
                                          {{{-0.0F, 0, 0}, {1, 1, 0}, {0, 1.5F, 0}}}};

void expect_two_triangles(const Mesh& mesh) {
    expect_same_bits(mesh.positions, rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1.5, 0}}));
    ASSERT_EQ(mesh.face_count(), 2);
    EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
    EXPECT_EQ(corners_of(mesh, 1), (std::vector{0, 2, 3}));
}

}  // namespace

TEST(ReadOff, TakesEveryHeader) {
    const Positions points = rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, .5}});
    for (const std::string_view text : {
             "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 .5\n4 0 1 2 3\n3 2 1 0\n",
             "OFF 4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 .5\n4 0 1 2 3\n3 2 1 0",
             "off\r\n# comment\r\n\r\n4 2\r\n0 0 0\r\n1 0 0 # c\r\n1 1 0\r\n0 1 .5\r\n4 0 1 2 3 255 0 0\r\n3 2 1 0\r\n",
             "COFF\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0\n0 1 .5 9\n4 0 1 2 3 0.1 0.2 0.3\n3 2 1 0 7\n",
             "NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 .5 0 0 1\n4 0 1 2 3\n3 2 1 0\n",
             "CNOFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 .5\n4 0 1 2 3\n3 2 1 0\n",
         }) {
        SCOPED_TRACE(std::string(text));
        const Mesh mesh = read_off(text, "t.off").mesh;
        expect_same_bits(mesh.positions, points);
        ASSERT_EQ(mesh.face_count(), 2);
        EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2, 3}));
        EXPECT_EQ(corners_of(mesh, 1), (std::vector{2, 1, 0}));
        EXPECT_FALSE(mesh.texture);
    }
}

TEST(ReadOff, KeepsTextureCoordinates) {
    const Mesh mesh = read_off("STNOFF 3 1 0\n0 0 0 0 0 1 .1 .2\n1 0 0 0 0 1 .3 .4\n0 1 0 .5 .6\n3 2 1 0\n", "t").mesh;
    ASSERT_TRUE(mesh.texture);
    expect_same_bits(mesh.texture->points, rows({{.1, .2}, {.3, .4}, {.5, .6}}));
    EXPECT_EQ(mesh.texture->corners, (std::vector{2, 1, 0}));
}

TEST(ReadOff, LinesMeanNothing) {
    const Positions points = rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    for (const std::string_view text : {
             "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0\n1\n2\n3\n0 2 3\n",  // a face over several lines
             "OFF\n4\n2\n0\n0 0\n0 1 0 0\n1 1 0 0 1 0\n3 0 1 2 3 0 2 3\n",     // several on a line
             "OFF 4 2 0 0 0 0 1 0 0 1 1 0 0 1 0 3 0 1 2 3 0 2 3",              // all on one
             "OFF\n4 2 0\n0 0 0\n1\n0\n0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2\n3 9 9 9\n",  // with colours
         }) {
        SCOPED_TRACE(std::string(text));
        const Mesh mesh = read_off(text, "t.off").mesh;
        expect_same_bits(mesh.positions, points);
        ASSERT_EQ(mesh.face_count(), 2);
        EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
        EXPECT_EQ(corners_of(mesh, 1), (std::vector{0, 2, 3}));
    }
}

TEST(ReadOff, LargeFacesAreCutIntoTriangles) {
    const LoadedMesh loaded =
        read_off("OFF 5 2 0\n0 0 0\n1 0 0\n1 1 0\n.5 1.5 0\n0 1 0\n5 0 1 2 3 4\n3 0 1 2\n", "t.off");
    EXPECT_EQ(loaded.mesh.face_count(), 4);
    EXPECT_EQ(corners_of(loaded.mesh, 3), (std::vector{0, 1, 2}));
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_TRUE(loaded.warnings[0].sentence.starts_with("t.off:7:")) << loaded.warnings[0].sentence;
}

TEST(ReadOff, ErrorsNameFileAndLine) {
    const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    expect_off_error("t.off:1: the file is empty", "");
    expect_off_error("t.off:1: the file begins with '3'", "3 1 0\n");
    expect_off_error("t.off:1: the file begins with '4OFF'", "4OFF\n1 0 0\n0 0 0 0\n");
    expect_off_error("t.off:1: 'BINARY' is not a number", "OFF BINARY\n");
    expect_off_error("t.off:6: a face names vertex 3, but the file has vertices 0 to 2", head + "3 0 1 3\n");
    expect_off_error("t.off:6: a face names vertex -1", head + "3 0 1 -1\n");
    expect_off_error("t.off:6: a face names 2 corners", head + "2 0 1\n");
    expect_off_error("t.off:6: the line ends", head + "3 0 1\n");
    expect_off_error("t.off:6: the line ends", head + "9223372036854775807 0 1 2\n");
    expect_off_error("the file ends after 0 of 1 faces", head);
    expect_off_error("announces 2000000000 vertices, but only", "OFF\n2000000000 1 0\n0 0 0\n");
    expect_off_error("announces -1 faces", "OFF\n1 -1 0\n0 0 0\n");
    expect_off_error("the file holds no vertex", "OFF\n0 0 0\n");
}

TEST(ReadStl, Text) {
    for (const std::string& end : {std::string("\n"), std::string("\r\n")}) {
        std::string text =
            "solid a # name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n"
            "  endloop\n endfacet\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX -0 0 0\nVERTEX 1 1 0\nVERTEX 0 1.5 "
            "0\nENDLOOP\n"
            "ENDFACET\nendsolid a";
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
            text.replace(at, 1, end);
        expect_two_triangles(read_stl(text, "t.stl").mesh);
    }
}

TEST(ReadStl, BinaryAlsoIfItsHeaderSaysSolid) {
    for (const char* header : {"beltrami", "solid", "solid a\nfacet normal 0 0 1\n"}) {
        const std::string bytes = binary_stl(header, two_triangles);
        expect_two_triangles(read_stl(bytes, "t.stl").mesh);
        expect_two_triangles(read_stl(bytes + "behind the end", "t.stl").mesh);
        expect_stl_error("t.stl: byte 84: the file announces 2 triangles, but only 99 bytes follow",
                         std::string_view(bytes).substr(0, bytes.size() - 1));
    }
}

TEST(ReadStl, MergesOnlyIdenticalCorners) {
    const float near = std::nextafter(1.0F, 2.0F);
    const Mesh mesh =
        read_stl(binary_stl("", {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, {{{0, 0, 0}, {near, 0, 0}, {0, 0, 0}}}}), "t.stl")
            .mesh;
    EXPECT_EQ(mesh.vertex_count(), 4);
    EXPECT_EQ(corners_of(mesh, 1), (std::vector{0, 3, 0}));
}

TEST(ReadStl, Errors) {
    const std::string loop = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    expect_stl_error("t.stl: this is no STL file", "");
    expect_stl_error("t.stl: this is no STL file", "v 0 0 0\n");
    expect_stl_error("t.stl:6: a facet has 2 vertices", loop + "endloop\n");
    expect_stl_error("t.stl:8: a facet has 4 vertices", loop + "vertex 0 1 0\nvertex 1 1 0\nendloop\nendsolid\n");
    expect_stl_error("t.stl:7: the file ends inside a solid", loop + "vertex 0 1 0\nendloop");
    expect_stl_error("t.stl:6: the file ends inside a solid", loop + "endsolid");
    expect_stl_error("t.stl:6: 'vert' is not a statement", loop + "vert 0 1 0\n");
    expect_stl_error("t.stl:6: the line ends", loop + "vertex 0 1\n");
    expect_stl_error("the file holds no vertex", "solid\nendsolid\n");
    expect_stl_error("the file holds no vertex", binary_stl("", {}));
    std::string bytes = binary_stl("", two_triangles);
    bytes.replace(80, 4, "\xFF\xFF\xFF\xFF");
    expect_stl_error("announces 4294967295 triangles, but only 100 bytes follow", bytes);
}

}  // namespace beltrami::io_tests
