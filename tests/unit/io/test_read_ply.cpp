#include <beltrami/io/binary_source.h>
#include <beltrami/io/read_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

Mesh ply(std::string_view bytes) {
    return read_ply(bytes, "t.ply").mesh;
}

void expect_ply_error(const std::string& part, std::string_view bytes) {
    expect_error(Cause::unreadable, part, [&] { read_ply(bytes, "t.ply"); });
}

/// Builds the body of a binary PLY.
class Bytes {
  public:
    Bytes(std::string header, std::endian order) : bytes_(std::move(header)), order_(order) {}

    template <class Number>
    Bytes& add(std::initializer_list<Number> values) {
        for (const Number value : values) {
            const auto raw = to_bytes(value, order_);
            bytes_.append(raw.data(), raw.size());
        }
        return *this;
    }
    const std::string& str() const { return bytes_; }

  private:
    std::string bytes_;
    std::endian order_;
};

const std::string ascii_head =
    "ply\nformat ascii 1.0\ncomment C:\\x\\\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ascii_vertices = "0 0 0\n1 0 0\n0 1 0\n";

}  // namespace

TEST(ReadPly, Ascii) {
    const Mesh mesh = ply(
        "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 2\r\nproperty list uchar float values\r\nproperty int "
        "id\r\nelement vertex 4\r\nproperty uchar red\r\nproperty double y\r\nproperty double x\r\nproperty float z\r\n"
        "element none 2000000000\r\nelement face 2\r\nproperty int flags\r\nproperty list uchar int vertex_index\r\n"
        "property list uchar float texcoord\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n2 1 2 7\r\n0 7\r\n"
        "255 0 .5 0\r\n0 0 1 0\r\n\r\n0 1 1 0\r\n0 1 0 0\r\n-1 4 0 1 2 3 0\r\n-1 3 2 1 0 6 0 0 0 0 0 0\r\n5");
    expect_same_bits(mesh.positions, rows({{.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    ASSERT_EQ(mesh.face_count(), 2);
    EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(corners_of(mesh, 1), (std::vector{2, 1, 0}));
    ASSERT_TRUE(mesh.texture);  // of the second face alone
    EXPECT_EQ(mesh.texture->corners, (std::vector{-1, -1, -1, -1, 0, 1, 2}));
}

TEST(ReadPly, TextureOfFaceCorners) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nelement face 2\n"
        "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n0 0\n1 0\n1 1\n0 1\n";
    // Vertex 0 has one point in both faces, vertex 2 two.
    const Mesh mesh = ply(head + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 .5 1 0 1\n");
    ASSERT_TRUE(mesh.texture);
    EXPECT_EQ(mesh.texture->corners, (std::vector{0, 1, 2, 0, 3, 4}));
    expect_same_bits(mesh.texture->points, rows({{0, 0}, {1, 0}, {1, 1}, {.5, 1}, {0, 1}}));
    expect_ply_error("t.ply:14: a face with 3 corners has 4 numbers in its list texcoord instead of 6",
                     head + "3 0 1 2 4 0 0 1 0\n3 0 2 3 0\n");
}

TEST(ReadPly, KeepsWhatElseTheFileSays) {
    const LoadedMesh loaded = read_ply(
        "ply\nformat ascii 1.0\ncomment made  by hand\nelement vertex 3\nproperty float x\nproperty uchar red\n"
        "property float y\nproperty list uchar short tags\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property int label\nend_header\n0 7 0 0\n1 8 0 2 -3 4\n0 9 1 1 5\n3 0 1 2 -6\n",
        "t.ply");
    const FileAttributes& kept = loaded.attributes;
    EXPECT_EQ(kept.header, (std::vector<std::string>{"comment made by hand"}));
    ASSERT_EQ(kept.vertex_columns.size(), 2U);
    EXPECT_EQ(kept.vertex_columns[0].name, "red");
    EXPECT_EQ(kept.vertex_columns[0].type, NumberType::uint8);
    EXPECT_EQ(kept.vertex_columns[0].values, (std::vector<double>{7, 8, 9}));
    EXPECT_EQ(kept.vertex_columns[1].values, (std::vector<double>{-3, 4, 5}));
    EXPECT_EQ(kept.vertex_columns[1].offsets, (std::vector{0, 0, 2, 3}));
    ASSERT_EQ(kept.face_columns.size(), 1U);
    EXPECT_EQ(kept.face_columns[0].values, (std::vector<double>{-6}));
}

TEST(ReadPly, EveryTypeInBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const std::string name = order == std::endian::little ? "little" : "big";
        Bytes bytes("ply\nformat binary_" + name +
                        "_endian 1.0\nelement vertex 3\nproperty char a\nproperty double x\n"
                        "property uint8 b\nproperty float32 y\nproperty int16 c\nproperty short z\nproperty uint d\n"
                        "element face 2\nproperty list ushort uint vertex_indices\nproperty list int8 int16 other\n"
                        "property uint16 e\nend_header\n",
                    order);
        for (int vertex = 0; vertex < 3; ++vertex) {
            bytes.add<std::int8_t>({-1})
                .add<double>({0.1 * vertex})
                .add<std::uint8_t>({200})
                .add<float>({-1.5F * static_cast<float>(vertex)});
            bytes.add<std::int16_t>({-300, static_cast<std::int16_t>(-1000 + vertex)})
                .add<std::uint32_t>({4000000000U});
        }
        bytes.add<std::uint16_t>({3})
            .add<std::uint32_t>({0, 1, 2})
            .add<std::int8_t>({2})
            .add<std::int16_t>({5, 6})
            .add<std::uint16_t>({60000});
        bytes.add<std::uint16_t>({4}).add<std::uint32_t>({2, 1, 0, 1}).add<std::int8_t>({0}).add<std::uint16_t>({1});
        const Mesh mesh = ply(bytes.str());
        expect_same_bits(mesh.positions, rows({{0.0, -0.0, -1000}, {0.1, -1.5, -999}, {0.2, -3, -998}}));
        ASSERT_EQ(mesh.face_count(), 2);
        EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
        EXPECT_EQ(corners_of(mesh, 1), (std::vector{2, 1, 0, 1}));
    }
}

TEST(ReadPly, FirstByteOfBinaryDataMayBeALineEnd) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string header =
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nend_header\n";
        for (std::size_t at = 0; (at = header.find('\n', at)) != std::string::npos; at += end.size())
            header.replace(at, 1, end);
        expect_same_bits(ply(header + "\n\r").positions, rows({{10, 13}}));
        expect_same_bits(ply(header + "\r\n").positions, rows({{13, 10}}));
    }
}

TEST(ReadPly, PlanarMeshAndTextureOfEveryName) {
    for (const auto& [u, v] : {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v")}) {
        const Mesh mesh = ply(fmt::format(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double {}\n"
            "property double {}\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 .1 .2\n1 0 .3 nan\n0 1 .5 .6\n3 2 1 0\n",
            v, u));
        ASSERT_TRUE(mesh.texture);
        EXPECT_EQ(mesh.positions.cols(), 2);
        EXPECT_EQ(mesh.texture->points(0, 0), .2);
        EXPECT_EQ(mesh.texture->points(0, 1), .1);
        EXPECT_TRUE(std::isnan(mesh.texture->points(1, 0)));
        EXPECT_EQ(mesh.texture->corners, (std::vector{2, 1, 0}));
    }
}

TEST(ReadPly, FacesMayComeBeforeVertices) {
    const Mesh mesh =
        ply("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
            "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n" +
            ascii_vertices);
    EXPECT_EQ(corners_of(mesh, 0), (std::vector{0, 1, 2}));
    EXPECT_EQ(mesh.vertex_count(), 3);
}

TEST(ReadPly, ErrorsNameThePlace) {
    expect_ply_error("t.ply:1: the file does not begin with 'ply'", "");
    expect_ply_error("t.ply:1: the file does not begin with 'ply'", "\x89PNG\r\n");
    expect_ply_error("t.ply:2: 'ascii2' is not a format", "ply\nformat ascii2 1.0\n");
    expect_ply_error("t.ply:2: the header names no format", "ply\nend_header\n");
    expect_ply_error("the file ends before 'end_header'", "ply\nformat ascii 1.0\n");
    expect_ply_error("t.ply:2: 'elements' is not a statement", "ply\nelements vertex 3\n");
    expect_ply_error("t.ply:2: a property comes before", "ply\nproperty int x\n");
    expect_ply_error("t.ply:3: element 'a' is declared twice", "ply\nelement a 1\nelement a 1\n");
    expect_ply_error("t.ply:2: -1 elements 'a'", "ply\nelement a -1\n");
    expect_ply_error("t.ply:2: '1e3' is not a number", "ply\nelement a 1e3\n");
    expect_ply_error("t.ply:3: 'int64' is not a type", "ply\nelement a 1\nproperty int64 x\n");
    expect_ply_error("have no properties x and y",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n");
    expect_ply_error("have no properties x and y", "ply\nformat ascii 1.0\nend_header\n");
    expect_ply_error("the faces have no list vertex_indices",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nelement face "
                     "1\nproperty int a\nend_header\n0 0\n0\n");
    expect_ply_error("t.ply:14: a face names vertex 3, but the file has vertices 0 to 2",
                     ascii_head + ascii_vertices + "3 0 1 3\n");
    expect_ply_error("a face names vertex -1", ascii_head + ascii_vertices + "3 0 1 -1\n");
    expect_ply_error("a face names vertex 1.5", ascii_head + ascii_vertices + "3 0 1 1.5\n");
    expect_ply_error("a face names vertex nan", ascii_head + ascii_vertices + "3 0 1 nan\n");
    expect_ply_error("t.ply:14: a face names 2 corners", ascii_head + ascii_vertices + "2 0 1\n");
    expect_ply_error("t.ply:14: a list has -3 entries", ascii_head + ascii_vertices + "-3 0 1 2\n");
    expect_ply_error("t.ply:14: the line ends", ascii_head + ascii_vertices + "3 0 1\n");
    expect_ply_error("t.ply:14: the line holds more values", ascii_head + ascii_vertices + "3 0 1 2 3\n");
    expect_ply_error("t.ply:15: the file ends before its last element", ascii_head + ascii_vertices + "\n");
    expect_ply_error("t.ply:11: 'a' is not a number", ascii_head + "a 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
}

TEST(ReadPly, FalseCountsAreSeenBeforeAnythingIsAllocated) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const std::string head = fmt::format("ply\nformat {} 1.0\nelement vertex ", format);
        const std::string tail = "\nproperty float x\nproperty float y\nend_header\n0 0\n";
        expect_ply_error("the header announces 2000000000 elements 'vertex'", head + "2000000000" + tail);
        expect_ply_error("too many to be indexed", head + "9000000000000000000" + tail);
    }
    Bytes bytes(
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nelement face 1\n"
        "property list uint uchar vertex_indices\nend_header\n",
        std::endian::big);
    bytes.add<std::uint8_t>({0, 0}).add<std::uint32_t>({4000000000U}).add<std::uint8_t>({0, 0, 0});
    expect_ply_error(fmt::format("t.ply: byte {}: the file ends in the middle", bytes.str().size()), bytes.str());
}

TEST(ReadPly, LineEndsOfTheHeaderMayDiffer) {
    // Whatever the first byte of the data, here that of a float 0, 10 and 13.
    using Ends = std::pair<std::string, std::string>;
    for (const auto& [others, last] : {Ends("\n", "\n"), Ends("\r\n", "\r\n"), Ends("\n", "\r\n"), Ends("\n", " \n")}) {
        std::string head;
        for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 3", "property uchar x",
                                 "property uchar y", "element face 1", "property list uchar uchar vertex_indices"})
            head += line + others;
        for (const std::uint8_t first : {0, 10, 13}) {
            Bytes bytes(head + "end_header" + last, std::endian::little);
            bytes.add<std::uint8_t>({first, 1, 2, 3, 4, 5, 3, 0, 1, 2});
            const Mesh mesh = ply(bytes.str());
            EXPECT_EQ(mesh.positions(0, 0), first);
            EXPECT_EQ(mesh.positions(2, 1), 5);
        }
    }
}

TEST(ReadPly, LargeFacesAreNamedByTheirByte) {
    Bytes bytes(
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nelement face 1\n"
        "property list uchar uchar vertex_indices\nend_header\n",
        std::endian::little);
    bytes.add<std::uint8_t>({0, 0, 5, 0, 0, 0, 0, 0});
    const LoadedMesh loaded = read_ply(bytes.str(), "t.ply");
    EXPECT_EQ(loaded.mesh.face_count(), 3);
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].sentence.find("byte"), std::string::npos) << loaded.warnings[0].sentence;
}

}  // namespace beltrami::io_tests
