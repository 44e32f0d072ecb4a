#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh planar_mesh(const std::vector<Complex>& points, const std::vector<std::vector<int>>& faces) {
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t v = 0; v < points.size(); ++v)
        mesh.positions.row(static_cast<Eigen::Index>(v)) << points[v].real(), points[v].imag();
    for (const auto& face : faces) mesh.faces.add(face);
    return mesh;
}

BoundaryCondition identity(const Surface& surface) {
    return test::boundary_values(surface, [](Complex z) { return z; });
}

Surface surface_of(const SplitProblem& split) {
    return split.metric ? Surface(split.mesh, *split.metric) : Surface(split.mesh);
}

/// What split_prescribed promises about any result.
void expect_sound(const Surface& source, const BoundaryCondition& boundary, const SplitProblem& split) {
    const int old = source.mesh.vertex_count();
    ASSERT_EQ(split.mesh.vertex_count(), old + static_cast<int>(split.parents.size()));
    EXPECT_EQ(split.mesh.positions.topRows(old), source.mesh.positions);
    ASSERT_EQ(split.face_parents.size(), static_cast<std::size_t>(split.mesh.face_count()));
    for (std::size_t i = 0; i < split.parents.size(); ++i) {
        Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(source.mesh.positions.cols());
        const int count = split.parents[i][2] < 0 ? 2 : 4;
        for (int j = 0; j < count; ++j) mean += source.mesh.positions.row(split.parents[i][j]) / count;
        EXPECT_LT((mean - split.mesh.positions.row(old + static_cast<Eigen::Index>(i))).norm(), 1e-14);
    }
    const Surface after = surface_of(split);
    EXPECT_NEAR(after.operators.area(), source.operators.area(), 1e-12 * source.operators.area());
    EXPECT_EQ(after.topology.boundary_loops, source.topology.boundary_loops);
    EXPECT_EQ(after.topology.genus, source.topology.genus);
    EXPECT_EQ(after.topology.components, source.topology.components);
    std::vector<char> prescribed(after.mesh.vertex_count(), 0);
    for (const int v : boundary.vertices) prescribed[v] = 1;
    for (int f = 0; f < after.mesh.face_count(); ++f) {
        bool all = true, inner = false;
        for (const int v : after.mesh.faces[f]) all = all && prescribed[v];
        for (int c = after.mesh.faces.first_corner(f);
             c < after.mesh.faces.first_corner(f) + after.mesh.faces.degree(f); ++c)
            inner = inner || (after.topology.edge_faces[after.topology.corner_edges[c]][0] >= 0 &&
                              after.topology.edge_faces[after.topology.corner_edges[c]][1] >= 0);
        EXPECT_FALSE(all && inner) << "face " << f << " is still wholly prescribed";
    }
    for (int e = 0; e < after.topology.edge_count(); ++e) {
        const auto [a, b] = after.topology.edges[e];
        if (after.topology.edge_faces[e][0] < 0 || after.topology.edge_faces[e][1] < 0) continue;
        EXPECT_FALSE(prescribed[a] && prescribed[b] && after.topology.on_boundary[a] && after.topology.on_boundary[b])
            << "the bridge " << a << "–" << b << " is still there";
    }
    // The affine interpolation of the old map is the same map.
    Eigen::VectorXcd f(after.mesh.vertex_count());
    for (int v = 0; v < after.mesh.vertex_count(); ++v) f[v] = {after.mesh.positions(v, 0), after.mesh.positions(v, 1)};
    if (!split.metric && is_planar(source.mesh)) {
        EXPECT_LT(distortion(after.operators, f).max, 1e-12);
    }
}

TEST(PrescribedSplit, LeavesAloneWhatNeedsNothing) {
    const Surface surface(disk(6));
    const SplitProblem split = split_prescribed(surface, identity(surface));
    EXPECT_EQ(split.split_edges, 0);
    EXPECT_EQ(split.mesh.faces, surface.mesh.faces);
    EXPECT_EQ(split.mesh.positions, surface.mesh.positions);
    EXPECT_TRUE(split.parents.empty());
    EXPECT_EQ(split.face_parents.size(), static_cast<std::size_t>(surface.mesh.face_count()));
}

TEST(PrescribedSplit, Ears) {
    // A grid whose diagonals all run one way has an ear at two of its corners.
    const Surface surface(test::jittered_square(4));
    const SplitProblem split = split_prescribed(surface, identity(surface));
    expect_sound(surface, identity(surface), split);
    EXPECT_EQ(split.split_edges, 2);
    EXPECT_EQ(split.mesh.face_count(), surface.mesh.face_count() + 4);
    for (const auto& parents : split.parents) EXPECT_EQ(parents[2], -1);
    // Nothing is prescribed around the other corner.
    BoundaryCondition part;
    for (const int v : {0, 1, 5, 6}) part.pin(v, {surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)});
    EXPECT_EQ(split_prescribed(surface, part).split_edges, 1) << "the longest edge of two faces, 0–6";
}

TEST(PrescribedSplit, StripsWithoutInnerVertices) {
    // One to three edges of a triangle.
    const Surface strip(planar_mesh({0, 1, 2, {0, 1}, {1, 1}, {2, 1}}, {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}));
    SplitProblem split = split_prescribed(strip, identity(strip));
    EXPECT_EQ(split.split_edges, 3);
    EXPECT_EQ(split.mesh.face_count(), 2 + 2 + 3 + 3);
    expect_sound(strip, identity(strip), split);
    const Surface star(
        planar_mesh({0, 2, {1, 2}, {1, -1}, {3, 2}, {-1, 2}}, {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 5}}));
    split = split_prescribed(star, identity(star));
    EXPECT_EQ(split.split_edges, 3);
    EXPECT_EQ(split.mesh.face_count(), 4 + 2 * 3);
    expect_sound(star, identity(star), split);
    const Surface alone(planar_mesh({0, 2, {1, 2}}, {{0, 1, 2}}));
    EXPECT_EQ(split_prescribed(alone, identity(alone)).split_edges, 0);
}

TEST(PrescribedSplit, Quads) {
    const Surface strip(
        planar_mesh({0, 1, 2, 3, {0, 1}, {1, 1}, {2, 1}, {3, 1}}, {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}}));
    const SplitProblem split = split_prescribed(strip, identity(strip));
    EXPECT_EQ(split.split_edges, 2);
    EXPECT_EQ(split.parents.size(), 5u);
    EXPECT_EQ(split.mesh.face_count(), 5 + 6 + 5);
    expect_sound(strip, identity(strip), split);
    // A grid of quads has no bridge: its corner faces have a free vertex.
    const Surface grid(test::quad_square(4, 0.1));
    EXPECT_EQ(split_prescribed(grid, identity(grid)).split_edges, 0);
    // A pinned quad in the inside; the others of the grid stay quads.
    BoundaryCondition pins = identity(grid);
    for (const int v : {6, 7, 11, 12}) pins.pin(v, {grid.mesh.positions(v, 0), grid.mesh.positions(v, 1)});
    const SplitProblem inner = split_prescribed(grid, pins);
    EXPECT_GT(inner.split_edges, 0);
    expect_sound(grid, pins, inner);
}

TEST(PrescribedSplit, AHoleBesideTheBoundary) {
    // One layer of triangles between the hole and the outer boundary: bridges all around.
    const Surface surface(annulus(0.6, 1, 16, 1));
    const SplitProblem split = split_prescribed(surface, identity(surface));
    EXPECT_EQ(split.split_edges, 32);
    expect_sound(surface, identity(surface), split);
    // With one loop free nothing is nailed down.
    BoundaryCondition outer;
    for (const int v : surface.topology.boundary_loops[0])
        outer.pin(v, Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)));
    EXPECT_EQ(split_prescribed(surface, outer).split_edges, 0);
}

TEST(PrescribedSplit, PinnedCurvesStay) {
    const Surface surface(test::square(8, 0, [](int, int) { return false; }));
    const int ears = 2;
    const auto at = [&](int i, int j) { return 9 * j + i; };
    const auto place = [&](int v) { return Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)); };
    BoundaryCondition boundary = identity(surface);
    for (int i = 2; i <= 6; ++i) boundary.pin(at(i, 4), place(at(i, 4)));
    EXPECT_EQ(split_prescribed(surface, boundary).split_edges, ears);
    // A bend where the curve and a diagonal close a triangle: its longest edge, the diagonal, is split.
    boundary.pin(at(4, 5), place(at(4, 5)));
    const SplitProblem bent = split_prescribed(surface, boundary);
    EXPECT_EQ(bent.split_edges, ears + 1);
    EXPECT_TRUE(std::find(bent.parents.begin(), bent.parents.end(), std::array{at(3, 4), at(4, 5), -1, -1}) !=
                bent.parents.end());
    expect_sound(surface, boundary, bent);
    // Two neighbours whose straight connection another pin blocks.
    BoundaryCondition blocked = identity(surface);
    blocked.pin(at(3, 4), {0.3, 0.5});
    blocked.pin(at(4, 4), {0.5, 0.5});
    EXPECT_EQ(split_prescribed(surface, blocked).split_edges, ears);
    blocked.pin(at(6, 2), {0.4, 0.5});
    const SplitProblem opened = split_prescribed(surface, blocked);
    EXPECT_EQ(opened.split_edges, ears + 1);
    EXPECT_TRUE(std::find(opened.parents.begin(), opened.parents.end(), std::array{at(3, 4), at(4, 4), -1, -1}) !=
                opened.parents.end());
    expect_sound(surface, blocked, opened);
}

TEST(PrescribedSplit, MetricAndTextureComeAlong) {
    // Sheared reference shapes, and a texture with a seam and a corner without a texture point.
    Mesh mesh = test::mixed_square(3);
    const auto shear = [](double x, double y) { return Eigen::RowVector2d(x + 0.4 * y, 2 * y); };
    Positions corners(mesh.faces.corner_count(), 2);
    mesh.texture.emplace();
    mesh.texture->points.resize(mesh.faces.corner_count(), 2);
    for (int c = 0; c < corners.rows(); ++c) {
        const int v = mesh.faces.vertices()[c];
        corners.row(c) = shear(mesh.positions(v, 0), mesh.positions(v, 1));
        mesh.texture->points.row(c) = 3 * corners.row(c);
        mesh.texture->corners.push_back(c);
    }
    mesh.texture->corners[4] = -1;
    const Surface surface(mesh, corners);
    BoundaryCondition boundary;  // everything is pinned, so every interior edge that may be is split
    for (int v = 0; v < mesh.vertex_count(); ++v) boundary.pin(v, {mesh.positions(v, 0), mesh.positions(v, 1)});
    const SplitProblem split = split_prescribed(surface, boundary);
    ASSERT_GT(split.split_edges, 3);
    ASSERT_TRUE(split.metric && split.mesh.texture);
    expect_sound(surface, boundary, split);
    int missing = 0;
    for (int c = 0; c < split.mesh.faces.corner_count(); ++c) {
        const int v = split.mesh.faces.vertices()[c];
        const Eigen::RowVector2d expected = shear(split.mesh.positions(v, 0), split.mesh.positions(v, 1));
        EXPECT_LT((split.metric->row(c) - expected).norm(), 1e-14);
        const int t = split.mesh.texture->corners[c];
        if (t < 0) {
            ++missing;
        } else {
            EXPECT_LT((split.mesh.texture->points.row(t) - 3 * expected).norm(), 1e-14);
        }
    }
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, 12);
    // Without a seam the new texture points are shared: as many as there are vertices.
    Mesh plain = test::jittered_square(4);
    plain.texture = TextureCoordinates{plain.positions, plain.faces.vertices()};
    const Surface flat(plain);
    const SplitProblem shared = split_prescribed(flat, identity(flat));
    EXPECT_EQ(shared.mesh.texture->points, shared.mesh.positions);
    EXPECT_EQ(shared.mesh.texture->corners, shared.mesh.faces.vertices());
}

TEST(PrescribedSplit, SurfacesInSpace) {
    Mesh mesh = test::jittered_square(4);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), flat(v, 0) * flat(v, 1);
    const Surface surface(mesh);
    const SplitProblem split = split_prescribed(surface, identity(surface));
    EXPECT_EQ(split.split_edges, 2);
    expect_sound(surface, identity(surface), split);
}

}  // namespace
}  // namespace beltrami
