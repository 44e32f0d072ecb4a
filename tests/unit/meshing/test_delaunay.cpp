#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/delaunay.h>
#include <beltrami/meshing/quality.h>
#include <beltrami/plane/predicates.h>

namespace beltrami {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TriangulateOptions plain() {
    TriangulateOptions options;
    options.min_angle = 0.0;
    options.smoothing_passes = 0;
    options.split_ears = false;
    return options;
}

PlanarDomain square_with(const std::vector<Eigen::Vector2d>& interior) {
    PlanarDomain domain;
    domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    domain.curves = {0, 1, 2, 3};
    domain.points.insert(domain.points.end(), interior.begin(), interior.end());
    return domain;
}

double total_area(const Mesh& mesh) {
    double area = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) area += face_vector_area(mesh, f).z();
    return area;
}

/// No vertex beyond an inner edge lies inside the circle of the triangle on this side.
void expect_delaunay(const Mesh& mesh) {
    const Topology topo = topology(mesh);
    const auto p = [&](int v) -> Eigen::Vector2d { return mesh.positions.row(v).transpose(); };
    for (int e = 0; e < topo.edge_count(); ++e) {
        const auto& [left, right] = topo.edge_faces[e];
        if (left < 0 || right < 0) continue;
        const std::span<const int> t = mesh.faces[left];
        for (const int v : mesh.faces[right]) {
            if (v == topo.edges[e][0] || v == topo.edges[e][1]) continue;
            EXPECT_LE(incircle(p(t[0]), p(t[1]), p(t[2]), p(v)), 0.0);
        }
    }
}

TEST(Triangulate, RandomPoints) {
    Random random(11);
    std::vector<Eigen::Vector2d> points(2000);
    for (Eigen::Vector2d& p : points) p = {random.uniform(0.001, 0.999), random.uniform(0.001, 0.999)};
    const PlanarDomain domain = square_with(points);
    const Mesh mesh = triangulate(domain, plain());
    EXPECT_EQ(mesh.vertex_count(), 2004);
    EXPECT_EQ(mesh.face_count(), 2 * 2004 - 2 - 4);
    for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(Eigen::Vector2d(mesh.positions.row(v)), domain.points[v]);
    EXPECT_NEAR(total_area(mesh), 1.0, 1e-12);
    expect_delaunay(mesh);
}

TEST(Triangulate, CocircularGridAndCollinearPoints) {
    for (const double turn : {0.0, 0.3}) {  // turned, no coordinate is exact any more
        std::vector<Eigen::Vector2d> points;
        for (int i = 1; i < 40; ++i) {
            for (int j = 1; j < 40; ++j) points.emplace_back(i / 40.0, j / 40.0);
        }
        PlanarDomain domain = square_with(points);
        for (Eigen::Vector2d& p : domain.points) {
            p = Eigen::Vector2d(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                                std::sin(turn) * p.x() + std::cos(turn) * p.y());
        }
        const Mesh mesh = triangulate(domain, plain());
        EXPECT_EQ(mesh.face_count(), 2 * mesh.vertex_count() - 2 - 4);
        EXPECT_NEAR(total_area(mesh), 1.0, 1e-12);
        expect_delaunay(mesh);
    }
    // All interior points on one line, and on one circle.
    std::vector<Eigen::Vector2d> line, circle;
    for (int i = 1; i < 200; ++i) line.emplace_back(i / 200.0, i / 200.0);
    for (int i = 0; i < 200; ++i) {
        const double a = 2.0 * std::numbers::pi * i / 200;
        circle.emplace_back(0.5 + 0.3 * std::cos(a), 0.5 + 0.3 * std::sin(a));
    }
    for (const auto& points : {line, circle}) {
        const Mesh mesh = triangulate(square_with(points), plain());
        EXPECT_EQ(mesh.face_count(), 2 * mesh.vertex_count() - 2 - 4);
        expect_delaunay(mesh);
    }
}

TEST(Triangulate, PointsOnASideBecomeBoundaryVertices) {
    const Mesh mesh = triangulate(square_with({{0.5, 0.0}, {0.25, 0.0}, {1.0, 0.75}}), plain());
    const Topology topo = topology(mesh);
    EXPECT_EQ(topo.boundary_loops[0], (std::vector<int>{0, 5, 4, 1, 6, 2, 3}));
}

TEST(Triangulate, SegmentsThroughAThicketAreRecovered) {
    // A zigzag with long thin teeth whose sides are nothing near Delaunay, over random points.
    Random random(4);
    PlanarDomain domain;
    const int teeth = 12;
    for (int i = 0; i < teeth; ++i) {
        domain.points.emplace_back(i, 0.0);
        domain.points.emplace_back(i + 0.5, 10.0);
    }
    domain.points.emplace_back(teeth, 0.0);
    domain.points.emplace_back(teeth, -1.0);
    domain.points.emplace_back(0.0, -1.0);
    const int n = static_cast<int>(domain.points.size());
    double area = 0.0;
    for (int i = 0; i < n; ++i) {
        domain.segments.push_back({i, (i + 1) % n});
        domain.curves.push_back(i);
        const Eigen::Vector2d &a = domain.points[i], &b = domain.points[(i + 1) % n];
        area -= 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    for (int i = 0; i < 300; ++i)
        domain.points.emplace_back(random.uniform(0.01, teeth - 0.01), random.uniform(-0.99, -0.01));
    const Mesh mesh = triangulate(domain, plain());
    EXPECT_EQ(mesh.vertex_count(), static_cast<int>(domain.points.size()));
    EXPECT_NEAR(total_area(mesh), area, 1e-12);
    expect_delaunay(mesh);
    const Topology topo = topology(mesh);
    EXPECT_EQ(static_cast<int>(topo.boundary_loops[0].size()), n);
    EXPECT_EQ(topo.boundary_loops.size(), 1u);

    TriangulateOptions options;
    const Mesh fine = triangulate(domain, options);
    EXPECT_NEAR(total_area(fine), area, 1e-11);
    EXPECT_TRUE(require_sound(fine).empty());
}

TEST(Triangulate, AnglesReachTheBoundAndSizesFollowTheField) {
    TriangulateOptions options;
    options.min_angle = 30.0 * kDegree;
    options.size = [](const Eigen::Vector2d& p) { return 0.01 + 0.1 * p.x(); };
    const Mesh mesh = triangulate(square_with({}), options);
    EXPECT_GE(quality(mesh).min_angle, 29.999 * kDegree);
    EXPECT_EQ(quality(mesh).ears, 0);
    double sum = 0.0;
    const Topology topo = topology(mesh);
    for (const auto& [a, b] : topo.edges) {
        const Eigen::Vector2d middle = 0.5 * (mesh.positions.row(a) + mesh.positions.row(b)).transpose();
        const double ratio = (mesh.point(a) - mesh.point(b)).norm() / options.size(middle);
        EXPECT_LT(ratio, 2.0);
        sum += ratio / topo.edge_count();
    }
    EXPECT_NEAR(sum, 1.0, 0.15);
}

TEST(Triangulate, SidesOfASharpCornerAreSplitAtEqualDistances) {
    for (const double angle : {30.0, 10.0, 3.0}) {
        SCOPED_TRACE(angle);
        PlanarDomain wedge;
        const Eigen::Vector2d direction(std::cos(angle * kDegree), std::sin(angle * kDegree));
        // Sides that split in halves would never meet: 1 and 0.7.
        wedge.points = {{0, 0}, {1, 0}, {1, 1}, {0.7 * direction.x(), 0.7 * direction.y()}};
        wedge.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
        wedge.curves = {0, 1, 2, 3};
        const Mesh mesh = triangulate(wedge);
        EXPECT_TRUE(require_sound(mesh).empty());
        EXPECT_LT(mesh.face_count(), 150);
        const Topology topo = topology(mesh);
        const std::vector<int>& loop = topo.boundary_loops[0];
        EXPECT_NEAR(mesh.point(loop[1]).norm(), mesh.point(loop.back()).norm(), 1e-12);
        EXPECT_EQ(std::log2(mesh.point(loop[1]).x()), std::round(std::log2(mesh.point(loop[1]).x())));
    }
}

TEST(Triangulate, TheSameTwice) {
    TriangulateOptions options;
    options.size = [](const Eigen::Vector2d&) { return 0.05; };
    const Mesh a = triangulate(square_with({}), options), b = triangulate(square_with({}), options);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.faces, b.faces);
}

TEST(Triangulate, RefusesWithThePlace) {
    const auto indices_of = [](const PlanarDomain& domain) -> std::vector<int> {
        try {
            triangulate(domain, plain());
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_option) << error.what();
            return error.indices();
        }
        ADD_FAILURE() << "accepted";
        return {};
    };
    EXPECT_EQ(indices_of(square_with({{0.5, 0.5}, {0.2, 0.2}, {0.5, 0.5}})), (std::vector<int>{4, 6}));
    EXPECT_EQ(indices_of(square_with({{0.5, 0.5}, {2.0, 0.2}})), (std::vector<int>{5}));
    EXPECT_EQ(indices_of(square_with({{0.5, NAN}})), (std::vector<int>{4}));
    PlanarDomain crossing = square_with({});
    std::swap(crossing.points[0], crossing.points[1]);
    std::vector<int> sides = indices_of(crossing);
    std::sort(sides.begin(), sides.end());
    EXPECT_EQ(sides, (std::vector<int>{1, 3}));
    PlanarDomain wild = square_with({});
    wild.segments[2] = {2, 17};
    EXPECT_EQ(indices_of(wild), (std::vector<int>{2}));

    TriangulateOptions endless;
    endless.size = [](const Eigen::Vector2d&) { return 1e-4; };
    endless.max_vertices = 1000;
    try {
        triangulate(square_with({}), endless);
        FAIL() << "no end to refinement";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
    }
    TriangulateOptions steep;
    steep.min_angle = 35.0 * kDegree;
    EXPECT_THROW(triangulate(square_with({}), steep), Error);
}

TEST(Spread, PiecesFollowTheSize) {
    const std::vector<double> even = spread(3.0, [](double) { return 0.5; });
    ASSERT_EQ(even.size(), 7u);
    for (int i = 0; i <= 6; ++i) EXPECT_NEAR(even[i], i / 6.0, 1e-12);
    const std::vector<double> graded = spread(1.0, [](double t) { return 0.01 + 0.1 * t; });
    EXPECT_EQ(graded.front(), 0.0);
    EXPECT_EQ(graded.back(), 1.0);
    for (std::size_t i = 0; i + 1 < graded.size(); ++i) {
        const double middle = 0.5 * (graded[i] + graded[i + 1]);
        EXPECT_NEAR((graded[i + 1] - graded[i]) / (0.01 + 0.1 * middle), 1.0, 0.05);
    }
    EXPECT_EQ(spread(
                  1.0, [](double) { return 50.0; }, 3)
                  .size(),
              4u);
    EXPECT_THROW(spread(1.0, [](double) { return 0.0; }), Error);
    EXPECT_THROW(spread(1.0, [](double) { return NAN; }), Error);
}

}  // namespace
}  // namespace beltrami
