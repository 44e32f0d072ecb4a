#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <beltrami/base/constants.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/hyperbolic/hyperbolic_places.h>
#include <beltrami/hyperbolic/marking.h>

#include "support/cause_of.h"
#include "support/voxels.h"

namespace beltrami {
namespace {

/// Vertices moved along the surface's tangent directions by up to part of an edge, so that edges have to be flipped.
Mesh uneven(Mesh mesh, double amount) {
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.positions.row(v) += amount * Eigen::RowVector3d(std::sin(12.9898 * v), std::cos(39.425 * v), 0);
    return mesh;
}

CutTree tree_of(const HyperbolicSurface& surface) {
    return cut_tree(surface.original, 0, std::vector<double>(surface.steps.size(), 1.0));
}

std::vector<DiskIsometry> generators(const HyperbolicSurface& surface, const CutTree& tree) {
    return generator_isometries(surface.original, tree, surface.steps);
}

TEST(DiskIsometry, IsAGroupThatActsOnDiskAndHalfPlane) {
    const DiskIsometry p = DiskIsometry::rotation(0.3) * DiskIsometry::translation(Complex(0.7, -0.4)),
                       q = DiskIsometry::translation(Complex(-0.2, 1.1)) * DiskIsometry::rotation(-1.2);
    const Complex z(0.3, 0.2);
    EXPECT_LT(std::abs((p * q)(z)-p(q(z))), 1e-15);
    EXPECT_LT((p * p.inverse()).from_identity(), 1e-15);
    EXPECT_NEAR(p.distance(), std::abs(Complex(0.7, -0.4)), 1e-15);
    EXPECT_NEAR(p.distance(), 2 * std::atanh(std::abs(p(0))), 1e-14);
    EXPECT_LT(std::abs(p.direction() - p(0.0) / std::abs(p(0.0))), 1e-15);
    const Eigen::Matrix2d m = p.on_half_plane();
    EXPECT_NEAR(m.determinant(), 1, 1e-14);
    const Complex i(0, 1), w = i * (1.0 + z) / (1.0 - z), image = (m(0, 0) * w + m(0, 1)) / (m(1, 0) * w + m(1, 1));
    EXPECT_LT(std::abs((image - i) / (image + i) - p(z)), 1e-14);
    EXPECT_LT((p.on_half_plane() * q.on_half_plane() - (p * q).on_half_plane()).norm(), 1e-14);
}

TEST(HyperbolicSurface, AnglesCloseAndTheRelationHolds) {
    for (const double unevenness : {0.0, 0.05}) {
        const Surface surface(uneven(double_torus(0.2), unevenness));
        const HyperbolicSurface found = hyperbolic_surface(surface);
        SCOPED_TRACE(unevenness);
        RecordProperty("newton", found.iterations);
        RecordProperty("flips", std::to_string(found.unfolded.size()) + " + " + std::to_string(found.ptolemy.size()));
        EXPECT_LE(found.iterations, 12);
        EXPECT_LT(found.residual, 1e-10);
        EXPECT_NEAR(found.area(), 4 * kPi, 1e-10);  // Gauss–Bonnet
        EXPECT_LT(found.flatness, 1e-11);
        EXPECT_TRUE(found.inverted.empty());
        const CutTree tree = tree_of(found);
        ASSERT_EQ(tree.generators.size(), 4u);
        const std::vector<DiskIsometry> of = generators(found, tree);
        DiskIsometry relation;
        const std::vector<Letter> word = boundary_word(found.original, tree);
        EXPECT_EQ(word.size(), 8u);
        for (const Letter& letter : word)
            relation = relation * (letter.inverse ? of[letter.generator].inverse() : of[letter.generator]);
        EXPECT_LT(relation.from_identity(), 1e-10);
        for (const DiskIsometry& g : of) EXPECT_GT(g.translation_length(), 0.1);
    }
    EXPECT_GT(hyperbolic_surface(Surface(uneven(double_torus(0.2), 0.05))).ptolemy.size(), 10u);
}

/// The length of the closed geodesic round a tube, in the class of the section y = 0 beyond a hole.
TEST(HyperbolicSurface, LengthsConvergeWithOrderTwo) {
    std::array<double, 3> lengths{};
    std::size_t i = 0;
    for (const double edge : {0.2, 0.1, 0.05}) {
        const Surface surface(double_torus(edge));
        const HyperbolicSurface found = hyperbolic_surface(surface);
        // Of all loops of a homology basis the least length belongs to the same two mirror images at every size.
        const HomologyBasis basis = homology_basis(surface);
        std::map<std::array<int, 2>, int> halfedges;
        for (int h = 0; h < found.original.halfedge_count(); ++h)
            halfedges[{found.original.tail(h), found.original.head(h)}] = h;
        double shortest = 100;
        for (const std::vector<int>& loop : basis.loops) {
            DiskIsometry around;
            for (std::size_t k = 0; k < loop.size(); ++k)
                around = around * found.step(halfedges.at({loop[k], loop[(k + 1) % loop.size()]}));
            shortest = std::min(shortest, around.normalized().translation_length());
        }
        lengths[i++] = shortest;
    }
    for (const double length : lengths) RecordProperty("length", std::to_string(length));
    const double order = std::log2((lengths[0] - lengths[1]) / (lengths[1] - lengths[2]));
    EXPECT_GT(order, 1.7);
    EXPECT_LT(std::abs(lengths[2] - lengths[1]), 2e-2);
}

TEST(HyperbolicSurface, RefusesOtherSurfaces) {
    EXPECT_EQ(test::cause_of([] { hyperbolic_surface(Surface(torus(2, 1, 12, 8))); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([] { hyperbolic_surface(Surface(rectangle(1, 1, 3, 3))); }), Cause::bad_mesh);
}

/// Points are found where they are, through all flips.
TEST(PlacesOf, VerticesAreAtHome) {
    const Surface surface(uneven(double_torus(0.2), 0.05));
    const HyperbolicSurface found = hyperbolic_surface(surface);
    const int n = surface.mesh.vertex_count();
    EquivariantMap map;
    map.bases.resize(static_cast<std::size_t>(n));
    map.frames.resize(static_cast<std::size_t>(n));
    // Vertex 0 is where all are seen from: along a tree of edges.
    const CutTree tree = tree_of(found);
    for (const int v : tree.order) {
        map.bases[v] = 0;
        const int h = tree.to_vertex[v];
        if (h >= 0) map.frames[v] = (map.frames[found.original.tail(h)] * found.step(h)).normalized();
    }
    const std::vector<MeshPoint> places = places_of(found, map);
    for (int v = 0; v < n; ++v) {
        Eigen::RowVector3d at = Eigen::RowVector3d::Zero();
        for (std::size_t i = 0; i < 3; ++i)
            at += places[v].barycentric[i] * surface.mesh.positions.row(places[v].vertices[i]);
        EXPECT_LT((at - surface.mesh.positions.row(v)).norm(), 1e-7) << v;
    }
}

TEST(HyperbolicDomain, LiesInTheDiskInOnePiece) {
    for (const bool quads : {false, true}) {
        const Surface surface(quads ? test::bar_with_holes(2) : double_torus(0.2));
        const HyperbolicSurface metric = hyperbolic_surface(surface);
        const HyperbolicDomain domain = hyperbolic_domain(surface, metric);
        EXPECT_LT(domain.layout.points.rowwise().norm().maxCoeff(), 1);
        EXPECT_GT(domain.layout.points.rows(), surface.mesh.vertex_count());
        if (!quads) {  // the bar is far too coarse for straight faces
            EXPECT_TRUE(domain.distortion.flipped.empty());
            EXPECT_LT(domain.distortion.mean, 0.1);
        }
        EXPECT_LT(domain.relation, 1e-9);
        ASSERT_EQ(domain.paths.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_GT(domain.lengths[i], 0.5);
            EXPECT_NEAR(2 * std::cosh(0.5 * domain.lengths[i]), std::abs(domain.generators[i].on_half_plane().trace()),
                        1e-8);
            for (std::size_t k = 0; k < domain.paths[i].size(); ++k)
                EXPECT_GE(edge_between(surface.topology, domain.paths[i][k],
                                       domain.paths[i][(k + 1) % domain.paths[i].size()]),
                          0);
        }
    }
}

TEST(Marking, TheIdentityIsFlatAndTwistsUndoEachOther) {
    const Surface surface(double_torus(0.2));
    const HyperbolicSurface metric = hyperbolic_surface(surface);
    const HomologyBasis basis = homology_basis(surface);
    const EdgeGroup group{metric.original, metric.steps, surface.topology, basis};
    std::vector<int> identity(static_cast<std::size_t>(surface.mesh.vertex_count()));
    for (std::size_t v = 0; v < identity.size(); ++v) identity[v] = static_cast<int>(v);
    const Marking marking = marking_by_vertices(surface, metric.original, group, identity);
    EXPECT_EQ(marking.mended, 0);
    const Eigen::MatrixXi start = periods_of_images(surface.topology, marking.map, basis.loops);
    EXPECT_EQ(start, Eigen::MatrixXi::Identity(4, 4));
    for (std::size_t l = 0; l < 4; ++l) {
        const EquivariantMap turned = twisted(surface, metric.original, marking.map, basis.loops[l], 1);
        EXPECT_LT(flatness(surface, turned).maxCoeff(), 1e-9);
        const Eigen::MatrixXi periods = periods_of_images(surface.topology, turned, basis.loops);
        // A twist about c takes the class of x to x ± (c·x) c: Picard and Lefschetz.
        const auto j = static_cast<Eigen::Index>(l);
        for (Eigen::Index i = 0; i < 4; ++i)
            for (Eigen::Index m = 0; m < 4; ++m)
                EXPECT_EQ(std::abs(periods(i, m) - (i == m)), m == j ? std::abs(basis.intersections(j, i)) : 0);
        const EquivariantMap back = twisted(surface, metric.original, turned, basis.loops[l], -1);
        for (std::size_t e = 0; e < back.steps.size(); ++e)
            EXPECT_LT((back.steps[e].inverse() * marking.map.steps[e]).from_identity(), 1e-9);
        EXPECT_EQ(back.classes, marking.map.classes);
    }
}

TEST(Marking, ByLoopsIsThatOfTheirImages) {
    const Surface surface(double_torus(0.2));
    const HyperbolicSurface metric = hyperbolic_surface(surface);
    const HomologyBasis basis = homology_basis(surface);
    const EdgeGroup group{metric.original, metric.steps, surface.topology, basis};
    const CutTree tree = tree_of(metric);
    const std::vector<std::vector<int>> paths = generator_paths(metric.original, tree);
    const Marking same = marking_by_loops(surface, metric.original, group, paths, paths);
    EXPECT_LT(same.defect, 1e-8);
    EXPECT_EQ(periods_of_images(surface.topology, same.map, basis.loops), Eigen::MatrixXi::Identity(4, 4));
    std::vector<std::vector<int>> exchanged = paths;
    std::swap(exchanged[0], exchanged[1]);
    EXPECT_EQ(test::cause_of([&] { marking_by_loops(surface, metric.original, group, paths, exchanged); }),
              Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
