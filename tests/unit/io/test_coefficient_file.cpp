#include <beltrami/io/coefficient_file.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/write_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

Mesh two_faces() {
    Mesh mesh;
    mesh.positions.resize(5, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1, 2, 0;
    mesh.faces.add({0, 1, 2, 3});
    mesh.faces.add({1, 4, 2});
    return mesh;
}

TEST(CoefficientFile, PlyComesBackBitForBit) {
    const TemporaryFolder folder;
    const Eigen::VectorXcd mu = 0.7 * Eigen::VectorXcd::Random(2);
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::binary_little_endian}) {
        write_ply(folder / "mu.ply", two_faces(), {{"mu_im", mu.imag()}, {"K", mu.real()}, {"mu_re", mu.real()}}, {},
                  encoding);
        EXPECT_EQ(read_coefficient(folder / "mu.ply", 2), mu);
        EXPECT_EQ(read_mesh(folder / "mu.ply").mesh.faces, two_faces().faces);
    }
}

TEST(CoefficientFile, OfFacesThatAreCutMeanNothing) {
    const LoadedMesh loaded = read_ply(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nelement face 3\n"
        "property float mu_re\nproperty list uchar int vertex_indices\nproperty float mu_im\nend_header\n"
        "0 0\n1 0\n1 1\n0 1\n2 0\n0.5 3 0 1 2 0.25\n0.75 5 0 1 4 2 3 0.5\n-0.5 3 1 4 2 0\n",
        "t.ply");
    EXPECT_EQ(loaded.mesh.face_count(), 5);  // that with five corners is three triangles
    EXPECT_FALSE(loaded.face_mu);
    ASSERT_FALSE(loaded.warnings.empty());
    EXPECT_NE(loaded.warnings.back().sentence.find("coefficients of the faces go"), std::string::npos);
}

TEST(CoefficientFile, LinesComeInAnyOrder) {
    const TemporaryFolder folder;
    put(folder / "mu.txt", "# face re im\n2 0.5 -.25\n\n0 0 0\n1 -0.1 1e-1 # the last\n");
    Eigen::VectorXcd mu(3);
    mu << 0.0, Complex(-0.1, 0.1), Complex(0.5, -0.25);
    EXPECT_EQ(read_coefficient(folder / "mu.txt", 3), mu);
}

TEST(CoefficientFile, NamesWhatIsWrong) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::string& part, const std::string& text) {
        put(folder / "mu.txt", text);
        expect_error(Cause::unreadable, part, [&] { read_coefficient(folder / "mu.txt", 2); });
    };
    fails("no coefficient of face 1", "0 0 0\n");
    fails("names face 0 twice", "0 0 0\n0 0.1 0\n1 0 0\n");
    fails("mu.txt:2", "0 0 0\n2 0.1 0\n");
    fails("mu.txt:1", "0 0\n");
    fails("face 1 has |μ| = 1.25", "0 0 0\n1 0.75 1\n");
    fails("face 0 has |μ|", "0 nan 0\n1 0 0\n");
    write_ply(folder / "plain.ply", two_faces());
    expect_error(Cause::unreadable, "no properties mu_re and mu_im",
                 [&] { read_coefficient(folder / "plain.ply", 2); });
    write_ply(folder / "mu.ply", two_faces(), {{"mu_re", Eigen::Vector2d(0, 0)}, {"mu_im", Eigen::Vector2d(0, 0)}});
    expect_error(Cause::unreadable, "of 2 faces, the mesh has 3", [&] { read_coefficient(folder / "mu.ply", 3); });
}

}  // namespace

}  // namespace beltrami::io_tests
