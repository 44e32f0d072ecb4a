#include <beltrami/generate/grids.h>
#include <beltrami/teichmuller/pieces.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beltrami {
namespace {

/// The square [0,8]² of unit cells with the identity on the boundary, and on vertices inside that a test names.
template <class Test>
ProblemPieces pieces_with(const Surface& surface, const Test& pinned) {
    BoundaryCondition boundary;
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
        const Complex z(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
        if (surface.topology.on_boundary[v] || pinned(z)) boundary.pin(v, z);
    }
    return pieces_of(surface, boundary);
}

TEST(Pieces, OfACut) {
    const Surface surface(rectangle(8, 8, 8, 8));
    const ProblemPieces cut = pieces_with(surface, [](Complex z) { return z.real() == 3; });
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
    const Surface surface(rectangle(8, 8, 8, 8));
    const ProblemPieces cut = pieces_with(surface, [](Complex z) { return z.real() == 3 && z.imag() < 5; });
    EXPECT_TRUE(cut.pieces.empty());
    EXPECT_TRUE(cut.obstacle.empty());
}

TEST(Pieces, AClosedCurveCutsARingAndADisk) {
    const Surface surface(rectangle(12, 12, 12, 12));
    const ProblemPieces cut = pieces_with(surface, [](Complex z) {
        return std::max(std::abs(z.real() - 6), std::abs(z.imag() - 6)) == 3 &&
               std::abs(z.real() - 6) + std::abs(z.imag() - 6) < 6;  // without its corners
    });
    ASSERT_TRUE(cut.pieces.empty() || cut.pieces.size() == 2u) << cut.obstacle;
    const ProblemPieces whole =
        pieces_with(surface, [](Complex z) { return std::max(std::abs(z.real() - 6), std::abs(z.imag() - 6)) == 3; });
    // A corner of the curve may be a face with three pinned vertices: a piece in which nothing is free.
    if (whole.obstacle.empty()) {
        ASSERT_EQ(whole.pieces.size(), 2u);
        EXPECT_EQ(whole.pieces[0].surface.topology.boundary_loops.size(), 2u);
        EXPECT_EQ(whole.pieces[1].surface.topology.boundary_loops.size(), 1u);
    } else {
        EXPECT_TRUE(whole.pieces.empty());
        EXPECT_NE(whole.obstacle.find("no vertex is free"), std::string::npos) << whole.obstacle;
    }
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

}  // namespace
}  // namespace beltrami
