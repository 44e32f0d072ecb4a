// Ears and bridges: edges and faces that the prescribed vertices nail down.
#include <gtest/gtest.h>

#include <beltrami/base/error.h>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;

/// A square whose lower left and upper right corners are ears.
Mesh with_ears() {
    return test::square(10, 0.2, [](int, int) { return false; });
}

/// Two disks' worth of square joined by a bridge: an inner edge between two boundary vertices, notches from both sides.
Mesh with_a_bridge() {
    Mesh full = test::square(12, 0, [](int, int) { return false; });
    Mesh mesh;
    // Cells of the middle column are left out but for the middle two.
    std::vector<int> number(full.vertex_count(), -1);
    int count = 0;
    for (int f = 0; f < full.face_count(); ++f) {
        const int cell = f / 2, column = cell % 12, row = cell / 12;
        if (column == 6 && row != 6) continue;
        std::vector<int> corners;
        for (const int v : full.faces[f]) {
            if (number[v] < 0) number[v] = count++;
            corners.push_back(number[v]);
        }
        mesh.faces.add(corners);
    }
    mesh.positions.resize(count, 2);
    for (int v = 0; v < full.vertex_count(); ++v)
        if (number[v] >= 0) mesh.positions.row(number[v]) = full.positions.row(v).head(2);
    return mesh;
}

void expect_split(const Mesh& mesh, int least_edges) {
    const Surface surface(mesh);
    const auto f = [](Complex z) { return z + 0.2 * std::conj(z) + 0.1 * z * z; };
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, f));
    ASSERT_TRUE(result.split);
    const SplitProblem& split = *result.split;
    EXPECT_GE(split.split_edges, least_edges);
    EXPECT_EQ(result.map.size(), split.mesh.vertex_count());
    EXPECT_EQ(split.mesh.vertex_count(), mesh.vertex_count() + static_cast<int>(split.parents.size()));
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_EQ(split.mesh.positions.row(v).head(2), mesh.positions.row(v).head(2));
    for (std::size_t i = 0; i < split.parents.size(); ++i) {
        Complex mean = 0;
        int count = 0;
        for (const int parent : split.parents[i])
            if (parent >= 0) {
                EXPECT_LT(parent, mesh.vertex_count());
                mean += bench::place(mesh, parent);
                ++count;
            }
        EXPECT_TRUE(count == 2 || count == 4);
        const int v = mesh.vertex_count() + static_cast<int>(i);
        EXPECT_LT(std::abs(bench::place(split.mesh, v) - mean / double(count)), 1e-14);
    }
    expect_sound(result);
    EXPECT_EQ(result.phi.size(), Surface(split.mesh).operators.sample_count());
    EXPECT_FALSE(result.warnings.empty());
}

TEST(ExtremalSplit, EarsAtTwoCorners) {
    expect_split(with_ears(), 2);
}
TEST(ExtremalSplit, ABridge) {
    expect_split(with_a_bridge(), 1);
}

TEST(ExtremalSplit, CanBeRefused) {
    const Surface surface(with_ears());
    ExtremalOptions options;
    options.split_prescribed = false;
    const ExtremalMap result = extremal_map(
        surface, test::boundary_values(surface, [](Complex z) { return z + 0.2 * std::conj(z); }), options);
    EXPECT_FALSE(result.split);
    EXPECT_EQ(result.map.size(), surface.mesh.vertex_count());
}

TEST(ExtremalSplit, AStartIsGivenOnTheMeshItself) {
    const Surface surface(with_ears());
    const auto f = [](Complex z) { return z + 0.2 * std::conj(z) + 0.1 * z * z; };
    const BoundaryCondition boundary = test::boundary_values(surface, f);
    const ExtremalMap plain = extremal_map(surface, boundary);
    ExtremalOptions options;
    options.start = test::complex_positions(surface.mesh).unaryExpr(f);
    const ExtremalMap started = extremal_map(surface, boundary, options);
    expect_sound(started);
    ASSERT_TRUE(started.split);
    EXPECT_NEAR(started.k, plain.k, 1e-3);

    for (const Eigen::Index wrong : {options.start->size() - 1, options.start->size() + 1, plain.map.size()}) {
        options.start = Eigen::VectorXcd::Zero(wrong);
        try {
            extremal_map(surface, boundary, options);
            FAIL() << wrong;
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_option);
            EXPECT_NE(std::string(error.what()).find(std::to_string(surface.mesh.vertex_count())), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace beltrami
