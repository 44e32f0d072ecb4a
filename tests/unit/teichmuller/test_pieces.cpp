#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/generate/grids.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/pieces.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beltrami {
namespace {

/// A square of n × n unit cells with the identity on the boundary, and on vertices inside that a test names, nothing
/// nailed down.
struct Pinned {
    Surface surface;
    BoundaryCondition boundary;
};

template <class Test>
Pinned pinned_square(int n, const Test& pinned) {
    const Surface surface(rectangle(n, n, n, n));
    BoundaryCondition boundary;
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
        const Complex z(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
        if (surface.topology.on_boundary[v] || pinned(z)) boundary.pin(v, z);
    }
    return {Surface(split_prescribed(surface, boundary).mesh), boundary};
}

TEST(Pieces, OfACut) {
    const auto [surface, boundary] = pinned_square(8, [](Complex z) { return z.real() == 3; });
    const ProblemPieces cut = pieces_of(surface, boundary);
    EXPECT_TRUE(cut.obstacle.empty());
    ASSERT_EQ(cut.pieces.size(), 2u);
    std::vector<int> faces;
    for (const ProblemPiece& piece : cut.pieces) {
        EXPECT_EQ(piece.surface.topology.boundary_loops.size(), 1u);
        EXPECT_EQ(piece.outer_loop, 0);
        EXPECT_EQ(piece.boundary.vertices.size(), piece.surface.topology.boundary_loops[0].size());
        EXPECT_EQ(piece.pins.size(), piece.boundary.vertices.size());
        for (std::size_t i = 0; i < piece.vertices.size(); ++i)
            EXPECT_EQ(piece.surface.mesh.positions.row(static_cast<Eigen::Index>(i)),
                      surface.mesh.positions.row(piece.vertices[i]));
        ASSERT_EQ(piece.samples.size(), piece.faces.size());
        for (std::size_t i = 0; i < piece.samples.size(); ++i)
            EXPECT_EQ(surface.operators.faces[piece.samples[i]], piece.faces[i]);
        faces.insert(faces.end(), piece.faces.begin(), piece.faces.end());
    }
    std::sort(faces.begin(), faces.end());
    ASSERT_EQ(static_cast<int>(faces.size()), surface.mesh.face_count());
    for (int f = 0; f < surface.mesh.face_count(); ++f) EXPECT_EQ(faces[f], f);
}

TEST(Pieces, ACurveThatEndsInsideCutsNothing) {
    const auto [surface, boundary] = pinned_square(8, [](Complex z) { return z.real() == 3 && z.imag() < 5; });
    const ProblemPieces cut = pieces_of(surface, boundary);
    EXPECT_TRUE(cut.pieces.empty());
    EXPECT_TRUE(cut.obstacle.empty());
}

TEST(Pieces, AClosedCurveCutsARingAndADisk) {
    const auto [surface, boundary] =
        pinned_square(12, [](Complex z) { return std::max(std::abs(z.real() - 6), std::abs(z.imag() - 6)) == 3; });
    const ProblemPieces cut = pieces_of(surface, boundary);
    EXPECT_TRUE(cut.obstacle.empty()) << cut.obstacle;
    ASSERT_EQ(cut.pieces.size(), 2u);
    EXPECT_EQ(cut.pieces[0].surface.topology.boundary_loops.size(), 2u);
    EXPECT_EQ(cut.pieces[1].surface.topology.boundary_loops.size(), 1u);
}

TEST(Pieces, ThatNoMapCanHaveAreNotCut) {
    // The part beyond the line is turned over.
    const Surface surface(rectangle(8, 8, 8, 8));
    BoundaryCondition boundary;
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
        const Complex z(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
        if (surface.topology.on_boundary[v]) boundary.pin(v, z);
        if (z.real() == 3 && !surface.topology.on_boundary[v]) boundary.pin(v, Complex(8.5, z.imag()));
    }
    const ProblemPieces cut = pieces_of(surface, boundary);
    EXPECT_TRUE(cut.pieces.empty());
    EXPECT_FALSE(cut.obstacle.empty());
}

TEST(Pieces, ACurveThatTouchesItselfIsNotCut) {
    // An eight: the part around it meets itself in one vertex.
    const auto [surface, identity] = pinned_square(12, [](Complex z) {
        const auto square = [&](Complex centre) {
            const Complex from = z - centre;
            return std::max(std::abs(from.real()), std::abs(from.imag())) == 2;
        };
        return square({4, 4}) || square({8, 8});
    });
    const ProblemPieces cut = pieces_of(surface, identity);
    EXPECT_TRUE(cut.pieces.empty());
    EXPECT_NE(cut.obstacle.find("3 pieces"), std::string::npos) << cut.obstacle;
    // It is solved as one, and says so.
    BoundaryCondition stretched = identity;
    for (Complex& image : stretched.images) image.real(2 * image.real());
    const ExtremalMap map = extremal_map(surface, stretched);
    EXPECT_TRUE(map.pieces.empty());
    EXPECT_NEAR(map.K, 2, 1e-8);
    EXPECT_NEAR(map.K_lower, 2, 1e-8);
    EXPECT_TRUE(map.one_to_one());
    const Warning obstacle{WarningKind::pieces, cut.obstacle};
    EXPECT_NE(std::find(map.warnings.begin(), map.warnings.end(), obstacle), map.warnings.end());
}

}  // namespace
}  // namespace beltrami
