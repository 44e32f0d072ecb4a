#include <clocale>
#include <cmath>
#include <limits>
#include <locale>

#include <beltrami/io/read_mesh.h>
#include <beltrami/io/write_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A triangle and a quad with awkward numbers.
Mesh awkward_mesh() {
    Mesh mesh;
    mesh.positions = rows({{0.1, -0.0, 1.0 / 3}, {1e300, 4.9e-324, -1e-5}, {nan, 1, 1e22}, {0, 123456789.125, -1}});
    mesh.positions(3, 0) = std::numeric_limits<double>::infinity();
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({3, 2, 1, 0});
    return mesh;
}

Positions awkward_map() {
    return rows({{0.1, 0.7}, {-0.0, 1e-17}, {2.0 / 3, 5}, {1e17, -3}});
}

}  // namespace

TEST(WriteMesh, ReadingGivesTheSameBits) {
    const TemporaryFolder folder;
    const Mesh mesh = awkward_mesh();
    write_obj(folder / "a.obj", mesh);
    write_off(folder / "a.off", mesh);
    write_ply(folder / "a.ply", mesh);
    write_ply(folder / "b.ply", mesh, {}, {}, PlyEncoding::ascii);
    for (const char* name : {"a.obj", "a.off", "a.ply", "b.ply"}) {
        SCOPED_TRACE(name);
        expect_same(read_mesh(folder / name).mesh, mesh);
    }
}

TEST(WriteMesh, ManyRandomNumbersComeBack) {
    const TemporaryFolder folder;
    std::mt19937_64 random(1);
    Mesh mesh;
    mesh.positions.resize(3000, 3);
    for (double& x : mesh.positions.reshaped()) {
        do {
            x = std::bit_cast<double>(random());
        } while (std::isnan(x));
    }
    mesh.faces.add({2999, 0, 1});
    for (const char* name : {"a.obj", "a.off", "a.ply"}) {
        write_mesh(folder / name, {.mesh = mesh});
        expect_same(read_mesh(folder / name).mesh, mesh);
    }
}

TEST(WriteMesh, PlanarMeshStaysPlanarInPlyAndGetsZeroElsewhere) {
    const TemporaryFolder folder;
    Mesh mesh = awkward_mesh();
    mesh.positions = Positions(mesh.positions.leftCols(2));
    write_mesh(folder / "a.ply", {.mesh = mesh});
    expect_same(read_mesh(folder / "a.ply").mesh, mesh);
    write_mesh(folder / "a.obj", {.mesh = mesh});
    const Mesh spatial = read_mesh(folder / "a.obj").mesh;
    ASSERT_EQ(spatial.positions.cols(), 3);
    EXPECT_TRUE(spatial.positions.col(2).isZero(0));
}

TEST(WriteMesh, ObjKeepsSeamsOfTheMeshsOwnTexture) {
    const TemporaryFolder folder;
    Mesh mesh = awkward_mesh();
    mesh.texture = TextureCoordinates{rows({{.1, .2}, {.3, 1e-9}}), {1, 0, -1, 0, 1, 1, 0}};
    write_obj(folder / "a.obj", mesh, mesh.texture);
    expect_same(read_mesh(folder / "a.obj").mesh, mesh);
    write_mesh(folder / "b.obj", {.mesh = mesh});
    expect_same(read_mesh(folder / "b.obj").mesh, mesh);
    write_obj(folder / "c.obj", mesh);
    EXPECT_FALSE(read_mesh(folder / "c.obj").mesh.texture);
}

TEST(WriteMesh, MapComesBackAsTextureInEveryFormat) {
    const TemporaryFolder folder;
    Mesh mesh = awkward_mesh();
    mesh.texture = TextureCoordinates{rows({{5, 5}}), std::vector<int>(7, 0)};  // the map goes before it
    Mesh wanted = mesh;
    wanted.texture = texture_of_map(mesh, awkward_map());
    for (const char* name : {"a.obj", "a.PLY", "a.off"}) {
        SCOPED_TRACE(name);
        write_mesh(folder / name, {.mesh = mesh, .map = awkward_map()});
        expect_same(read_mesh(folder / name).mesh, wanted);
    }
    EXPECT_NE(get(folder / "a.obj").find("\nf 1/1 2/2 3/3\nf 4/4 3/3 2/2 1/1\n"), std::string::npos);
}

TEST(WriteMesh, PlyHoldsColumns) {
    const TemporaryFolder folder;
    const Mesh mesh = awkward_mesh();
    const std::vector<Column> faces{{"mu_re", Eigen::Vector2d(.25, nan)}, {"K", Eigen::Vector2d(-nan, 1e-7)}};
    const std::vector<Column> vertices{
        {"u", awkward_map().col(0)}, {"v", awkward_map().col(1)}, {"h", Eigen::Vector4d(1, 2, 3, 4)}};
    write_ply(folder / "a.ply", mesh, faces, vertices, PlyEncoding::ascii);
    const std::string text = get(folder / "a.ply");
    EXPECT_NE(
        text.find("\nproperty double h\nelement face 2\nproperty list uchar int vertex_indices\nproperty double mu_re\n"
                  "property double K\nend_header\n"),
        std::string::npos)
        << text;
    EXPECT_TRUE(text.ends_with("\n3 0 1 2 0.25 nan\n4 3 2 1 0 nan 1e-07\n")) << text;

    Mesh wanted = mesh;
    wanted.texture = texture_of_map(mesh, awkward_map());
    expect_same(read_mesh(folder / "a.ply").mesh, wanted);
    write_ply(folder / "b.ply", mesh, faces, vertices);
    expect_same(read_mesh(folder / "b.ply").mesh, wanted);
    // Two faces of 1 + 3·4 and 1 + 4·4 bytes and two doubles each end the file: K of the last is its last 8 bytes.
    double last = 0;
    const std::string bytes = get(folder / "b.ply");
    std::memcpy(&last, bytes.data() + bytes.size() - 8, 8);
    EXPECT_EQ(last, 1e-7);
}

TEST(WriteMesh, ShadesAreColoursInEveryFormat) {
    const TemporaryFolder folder;
    const Mesh mesh = awkward_mesh();
    const std::vector<Shade> shades{Shade::light, Shade::dark};
    for (const char* name : {"a.obj", "a.off", "a.ply"}) {
        write_mesh(folder / name, {.mesh = mesh, .shades = shades});
        expect_same(read_mesh(folder / name).mesh, mesh);
        EXPECT_THROW(write_mesh(folder / name, {.mesh = mesh, .shades = {Shade::dark}}), Error);
    }
    EXPECT_NE(get(folder / "a.obj").find("\nusemtl light\nf 1 2 3\nusemtl dark\nf 4 3 2 1\n"), std::string::npos);
    EXPECT_TRUE(get(folder / "a.off").ends_with("\n3 0 1 2 240 240 240\n4 3 2 1 0 40 40 40\n"));
    write_ply(folder / "b.ply", mesh, {}, {}, PlyEncoding::ascii, shades);
    EXPECT_TRUE(get(folder / "b.ply").ends_with("\n3 0 1 2 240 240 240\n4 3 2 1 0 40 40 40\n"));
    EXPECT_TRUE(get(folder / "a.ply").ends_with("\x28\x28\x28"));
    // A column may not take the name of a colour.
    EXPECT_THROW(write_ply(folder / "c.ply", mesh, {{"red", Eigen::Vector2d(1, 2)}}, {}, PlyEncoding::ascii, shades),
                 Error);
}

TEST(WriteMesh, PlyKeepsOtherProperties) {
    const TemporaryFolder folder;
    const std::string text =
        "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty uchar red\nproperty float heat\nproperty list uchar short tags\nelement face 1\nproperty list "
        "uchar "
        "int vertex_indices\nproperty int label\nproperty double K\nend_header\n0 0 0 7 .5 0\n1 0 0 8 .25 2 -3 4\n"
        "0 1 0 9 .125 1 5\n3 0 1 2 -6 77\n";
    const LoadedMesh loaded = read_ply(text, "t.ply");
    Eigen::VectorXd K(1);
    K << 2;
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::binary_little_endian}) {
        write_ply(folder / "a.ply", loaded.mesh, {{"K", K}}, {}, encoding, {}, loaded.attributes);
        const LoadedMesh again = read_mesh(folder / "a.ply");
        EXPECT_EQ(again.attributes.header, loaded.attributes.header);
        ASSERT_EQ(again.attributes.vertex_columns.size(), 3U);
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(again.attributes.vertex_columns[c].name, loaded.attributes.vertex_columns[c].name);
            EXPECT_EQ(again.attributes.vertex_columns[c].type, loaded.attributes.vertex_columns[c].type);
            EXPECT_EQ(again.attributes.vertex_columns[c].values, loaded.attributes.vertex_columns[c].values);
            EXPECT_EQ(again.attributes.vertex_columns[c].offsets, loaded.attributes.vertex_columns[c].offsets);
        }
        ASSERT_EQ(again.attributes.face_columns.size(), 2U);  // K is the new one
        EXPECT_EQ(again.attributes.face_columns[0].values, (std::vector<double>{2}));
        EXPECT_EQ(again.attributes.face_columns[1].values, (std::vector<double>{-6}));
    }
}

TEST(WriteMesh, ObjKeepsMaterialsGroupsAndColours) {
    const TemporaryFolder folder;
    const std::string text =
        "mtllib a b.mtl\no thing\nv 0 0 0 1 .5 .25\nv 1 0 0 0 0 0\nv 1 1 0 .1 .2 .3\nv 0 1 0 1 1 1\nv 2 0 0 1 1 1\n"
        "f 1 2 3\ng left right\nusemtl red paint\nf 1 3 4\nusemtl blue\nf 2 5 3\n";
    const LoadedMesh loaded = read_obj(text, "t.obj");
    write_mesh(folder / "a.obj", {.mesh = loaded.mesh, .attributes = loaded.attributes});
    const std::string written = get(folder / "a.obj");
    EXPECT_EQ(written,
              "mtllib a b.mtl\nv 0 0 0 1 0.5 0.25\nv 1 0 0 0 0 0\nv 1 1 0 0.1 0.2 0.3\nv 0 1 0 1 1 1\nv 2 0 0 1 1 1\n"
              "o thing\nf 1 2 3\ng left right\nusemtl red paint\nf 1 3 4\nusemtl blue\nf 2 5 3\n");
    // Colours go from format to format.
    write_mesh(folder / "a.ply", {.mesh = loaded.mesh, .attributes = loaded.attributes});
    const FileAttributes ply = read_mesh(folder / "a.ply").attributes;
    ASSERT_EQ(ply.vertex_columns.size(), 3U);
    EXPECT_EQ(ply.vertex_columns[1].name, "green");
    EXPECT_EQ(ply.vertex_columns[1].type, NumberType::uint8);
    EXPECT_EQ(ply.vertex_columns[1].values, (std::vector<double>{128, 0, 51, 255, 255}));
    write_mesh(folder / "b.obj", {.mesh = loaded.mesh, .attributes = ply});
    EXPECT_EQ(read_mesh(folder / "b.obj").attributes.vertex_columns[1].values[2], 51 / 255.0);
}

TEST(WriteMesh, MapsWithSeamsArePerCorner) {
    const TemporaryFolder folder;
    Mesh mesh;
    mesh.positions = rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    const TextureCoordinates seams{rows({{0, 0}, {1, 0}, {1, 1}, {7, 0}, {8, 1}, {7, 1}}), {0, 1, 2, 3, 4, 5}};
    for (const char* name : {"a.obj", "a.ply"}) {
        write_mesh(folder / name, {.mesh = mesh, .corner_map = seams});
        const Mesh again = read_mesh(folder / name).mesh;
        ASSERT_TRUE(again.texture);
        EXPECT_EQ(again.texture->corners, seams.corners);
        expect_same_bits(again.texture->points, seams.points);
    }
    expect_error(Cause::bad_option, "seams",
                 [&] { write_mesh(folder / "a.off", {.mesh = mesh, .corner_map = seams}); });
}

TEST(FileAttributes, GoWithVerticesAndFaces) {
    FileAttributes attributes;
    attributes.vertex_columns = {{"red", NumberType::uint8, {}, {0, 10, 21}, {}},
                                 {"tags", NumberType::int16, NumberType::uint8, {1, 2, 3}, {0, 1, 1, 3}}};
    attributes.face_columns = {{"heat", NumberType::float32, {}, {.5, 1.5}, {}}};
    attributes.states = {{{"usemtl", "a"}}, {{"usemtl", "b"}}};
    attributes.face_states = {0, 1};
    const FileAttributes part = carried(attributes, {{2}, {0, 1}, {0, 2}, {}}, {1, 1, 0});
    EXPECT_EQ(part.vertex_columns[0].values, (std::vector<double>{21, 5, 11, 0}));
    EXPECT_EQ(part.vertex_columns[1].values, (std::vector<double>{2, 3, 1, 1}));
    EXPECT_EQ(part.vertex_columns[1].offsets, (std::vector{0, 2, 3, 4, 4}));
    EXPECT_EQ(part.face_columns[0].values, (std::vector<double>{1.5, 1.5, .5}));
    EXPECT_EQ(part.face_states, (std::vector{1, 1, 0}));
}

TEST(WriteMesh, LocaleChangesNothing) {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const TemporaryFolder folder;
    Mesh mesh = awkward_mesh();
    mesh.positions.conservativeResize(2000, 3);
    mesh.positions.bottomRows(1996).setConstant(12345.5);
    mesh.faces.add({1997, 1998, 1999});
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    for (const char* name : {"a.obj", "a.off"}) write_mesh(folder / name, {.mesh = mesh});
    write_ply(folder / "a.ply", mesh, {}, {}, PlyEncoding::ascii);
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
    for (const char* name : {"a.obj", "a.off", "a.ply"}) expect_same(read_mesh(folder / name).mesh, mesh);
}

TEST(WriteMesh, RefusesWhatDoesNotFit) {
    const TemporaryFolder folder;
    const Mesh mesh = awkward_mesh();
    const auto expect_refusal = [&](const std::string& part, const std::function<void()>& call) {
        expect_error(Cause::bad_option, part, call);
        EXPECT_EQ(folder.entry_count(), 0);
    };
    for (const char* name : {"a.obj", "a.off", "a.ply"}) {
        expect_refusal("the map to be written is 3×2",
                       [&] { write_mesh(folder / name, {.mesh = mesh, .map = awkward_map().topRows(3)}); });
    }
    expect_refusal("do not fit the mesh", [&] {
        write_obj(folder / "a.obj", mesh, TextureCoordinates{awkward_map(), {0, 1}});
    });
    expect_refusal("do not fit the mesh", [&] {
        write_obj(folder / "a.obj", mesh, TextureCoordinates{awkward_map(), {0, 1, 2, 3, 4, 0, 0}});
    });
    const Eigen::Vector2d two(1, 2);
    const Eigen::Vector4d four(1, 2, 3, 4);
    expect_refusal("column K has 4 values instead of 2", [&] { write_ply(folder / "a.ply", mesh, {{"K", four}}); });
    expect_refusal("cannot be called ''", [&] { write_ply(folder / "a.ply", mesh, {{"", two}}); });
    expect_refusal("cannot be called 'a b'", [&] { write_ply(folder / "a.ply", mesh, {{"a b", two}}); });
    expect_refusal("cannot be called 'K'", [&] { write_ply(folder / "a.ply", mesh, {{"K", two}, {"K", two}}); });
    expect_refusal("cannot be called 'x'", [&] { write_ply(folder / "a.ply", mesh, {}, {{"x", four}}); });
    expect_error(Cause::unwritable, "the extension '.stl' is none of",
                 [&] { write_mesh(folder / "a.stl", {.mesh = mesh}); });
    EXPECT_EQ(folder.entry_count(), 0);
}

}  // namespace beltrami::io_tests
