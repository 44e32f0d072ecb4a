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
