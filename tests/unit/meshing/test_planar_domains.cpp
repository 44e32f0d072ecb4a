#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/meshing/quality.h>

namespace beltrami {
namespace {

constexpr double degree = kPi / 180.0;

double area_of_positive_faces(const Mesh& mesh) {
    double area = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        EXPECT_GT(face_vector_area(mesh, f).z(), 0.0);
        area += face_vector_area(mesh, f).z();
    }
    return area;
}

std::vector<Circle> many_holes() {
    std::vector<Circle> holes;
    for (int i = 0; i < 27; ++i) {
        const double angle = 2.399963 * i, r = 0.85 * std::sqrt((i + 0.5) / 27);
        holes.push_back({{r * std::cos(angle), r * std::sin(angle)}, 0.06});
    }
    return holes;
}

TEST(CircleDomain, BoundaryVerticesLieOnTheirCircles) {
    const std::vector<Circle> holes = many_holes();
    for (const double jitter : {0.0, 0.3}) {
        DomainOptions options{.edge_length = 0.04};
        options.jitter.amplitude = jitter;
        const Mesh mesh = circle_domain({{0, 0}, 1.0}, holes, options);
        EXPECT_TRUE(require_sound(mesh).empty());
        const Topology topo = topology(mesh);
        EXPECT_EQ(topo.euler_characteristic, 1 - 27);
        ASSERT_EQ(topo.boundary_loops.size(), 28u);
        for (const int v : topo.boundary_loops[0]) EXPECT_NEAR(mesh.point(v).norm(), 1.0, 1e-15);
        std::vector<int> seen(27, 0);
        for (std::size_t k = 1; k < 28; ++k) {
            int hole = 0;
            const auto gap = [&](int h, int v) {
                return std::abs((mesh.point(v).head<2>() - holes[h].centre).norm() - holes[h].radius);
            };
            while (hole < 26 && gap(hole, topo.boundary_loops[k][0]) > 1e-9) ++hole;
            ++seen[hole];
            for (const int v : topo.boundary_loops[k]) EXPECT_LT(gap(hole, v), 1e-15);
            EXPECT_GE(topo.boundary_loops[k].size(), 16u);
        }
        for (const int count : seen) EXPECT_EQ(count, 1);
        if (jitter == 0.0) {
            EXPECT_GE(quality(mesh).min_angle, 25.0 * degree);
        }
    }
}

TEST(CircleDomain, AreaConvergesWithOrderTwo) {
    const std::vector<Circle> holes{{{0.4, 0.1}, 0.25}, {{-0.3, -0.4}, 0.2}};
    const double exact = kPi * (1.0 - 0.25 * 0.25 - 0.2 * 0.2);
    double last = 0.0;
    for (const double h : {0.1, 0.05, 0.025, 0.0125}) {
        DomainOptions options{.edge_length = h};
        options.least_hole_edges = 6;
        const double error = std::abs(area_of_positive_faces(circle_domain({}, holes, options)) - exact);
        if (last > 0.0) {
            EXPECT_NEAR(std::log2(last / error), 2.0, 0.35);
        }
        last = error;
    }
    EXPECT_LT(last, 2e-4);
}

TEST(CircleDomain, EdgeLengthsAreAsAskedFor) {
    for (const double h : {0.1, 0.03})
        EXPECT_NEAR(quality(circle_domain({}, {}, {.edge_length = h})).mean_edge, h, 0.05 * h);
    DomainOptions graded{.edge_length = 0.1, .hole_edge_length = 0.01};
    const Mesh mesh = circle_domain({}, {{{0.3, 0}, 0.2}}, graded);
    const Topology topo = topology(mesh);
    EXPECT_NEAR(topo.loop_lengths[1] / static_cast<double>(topo.boundary_loops[1].size()), 0.01, 0.001);
    EXPECT_NEAR(topo.loop_lengths[0] / static_cast<double>(topo.boundary_loops[0].size()), 0.1, 0.02);
    EXPECT_GE(quality(mesh).min_angle, 25.0 * degree);
}

TEST(CircleDomain, NearlyTouchingHoles) {
    for (const double gap : {1e-1, 1e-2, 1e-3, 1e-4}) {
        SCOPED_TRACE(gap);
        const Mesh mesh = circle_domain({}, {{{0.3, 0}, 0.2}, {{-0.1 - gap, 0}, 0.2}}, {.edge_length = 0.05});
        EXPECT_TRUE(require_sound(mesh).empty());
        EXPECT_EQ(topology(mesh).euler_characteristic, -1);
        EXPECT_GE(quality(mesh).min_angle, 15.0 * degree);
        EXPECT_LT(mesh.face_count(), 6000);
    }
}

TEST(CircleDomain, RefusesTouchingCircles) {
    const auto indices_of = [](const std::vector<Circle>& holes) -> std::vector<int> {
        try {
            circle_domain({}, holes);
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_option);
            return error.indices();
        }
        ADD_FAILURE() << "accepted";
        return {};
    };
    EXPECT_EQ(indices_of({{{0, 0}, 0.1}, {{0.8, 0}, 0.2}}), (std::vector<int>{1}));
    EXPECT_EQ(indices_of({{{0, 0}, 0.1}, {{0.5, 0}, 0.1}, {{0.1, 0}, 0.1}}), (std::vector<int>{0, 2}));
    EXPECT_EQ(indices_of({{{0, 0}, 0.1}, {{0, 0}, 0.01}}), (std::vector<int>{0, 1}));
    EXPECT_EQ(indices_of({{{0, 0}, -0.1}}), (std::vector<int>{0}));
    EXPECT_EQ(indices_of({{{NAN, 0}, 0.1}}), (std::vector<int>{0}));
    EXPECT_THROW(circle_domain({{0, 0}, 0.0}, {}), Error);
    EXPECT_THROW(circle_domain({{0, NAN}, 1.0}, {}), Error);
    EXPECT_THROW(circle_domain({}, {}, {.edge_length = 0.0}), Error);
    EXPECT_THROW(circle_domain({}, {}, {.edge_length = 1e-9}), Error);
    EXPECT_THROW(circle_domain({}, {}, {.edge_length = NAN}), Error);
}

TEST(PolygonDomain, CornersAndInteriorPointsComeFirst) {
    const Polygon outer{{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}};  // clockwise
    const Polygon hole{{0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}, {0.3, 0.6}};
    DomainOptions options{.edge_length = 0.1};
    options.interior_points = {{0.8, 0.8}, {1.5, 0.5}};
    options.jitter = {.amplitude = 0.3, .seed = 5};
    const Mesh mesh = polygon_domain(outer, {hole}, options);
    std::vector<Eigen::Vector2d> expected = outer;
    expected.insert(expected.end(), hole.begin(), hole.end());
    expected.insert(expected.end(), options.interior_points.begin(), options.interior_points.end());
    for (std::size_t v = 0; v < expected.size(); ++v) EXPECT_EQ(mesh.point(static_cast<int>(v)).head<2>(), expected[v]);
    EXPECT_NEAR(area_of_positive_faces(mesh), 3.0 - 0.09, 1e-12);
    const Topology topo = topology(mesh);
    EXPECT_EQ(topo.boundary_loops.size(), 2u);
    EXPECT_FALSE(topo.on_boundary[10] || topo.on_boundary[11]);
}

TEST(PolygonDomain, GradedTowardsCornersSourcesAndHoles) {
    DomainOptions options{.edge_length = 0.2};
    options.corner_edge_length = 0.01;
    options.hole_edge_length = 0.02;
    options.sources = {{{1.5, 0.5}, 0.005}};
    const Mesh mesh = polygon_domain({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, {{{2, 1}, {2.3, 1}, {2.3, 1.4}}}, options);
    EXPECT_GE(quality(mesh).min_angle, 20.0 * degree);
    const Topology topo = topology(mesh);
    double near_source = 1.0, near_corner = 1.0, longest = 0.0;
    for (const auto& [a, b] : topo.edges) {
        const double length = (mesh.point(a) - mesh.point(b)).norm();
        const Eigen::Vector2d middle = 0.5 * (mesh.point(a) + mesh.point(b)).head<2>();
        if ((middle - Eigen::Vector2d(1.5, 0.5)).norm() < 0.03) near_source = std::min(near_source, length);
        if (middle.norm() < 0.03) near_corner = std::min(near_corner, length);
        longest = std::max(longest, length);
    }
    EXPECT_LT(near_source, 0.008);
    EXPECT_LT(near_corner, 0.015);
    EXPECT_GT(longest, 0.15);
    EXPECT_NEAR(topo.loop_lengths[1] / static_cast<double>(topo.boundary_loops[1].size()), 0.015, 0.006);
}

TEST(PolygonDomain, SharpCornersEndAndCostLittle) {
    for (const double angle : {40.0, 20.0, 10.0, 5.0, 1.0}) {
        SCOPED_TRACE(angle);
        const double c = std::cos(angle * degree), s = std::sin(angle * degree);
        const Mesh wedge = polygon_domain({{0, 0}, {1, 0}, {c, s}}, {}, {.edge_length = 0.1});
        EXPECT_NEAR(area_of_positive_faces(wedge), 0.5 * s, 1e-13);
        EXPECT_LT(wedge.face_count(), 300);
        EXPECT_GE(quality(wedge).min_angle, std::min(0.99 * angle, 18.0) * degree);  // the corner itself is the worst
        // A notch of the same angle, seen from outside, costs nothing at all.
        const Mesh notch =
            polygon_domain({{0, 0}, {c, -s}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}, {c, s}}, {}, {.edge_length = 0.1});
        EXPECT_GE(quality(notch).min_angle, 20.0 * degree);
        EXPECT_LT(notch.face_count(), 1500);
    }
    // A star whose five points are 5 degrees sharp: two sharp corners share no side, every side has one.
    Polygon star;
    for (int i = 0; i < 5; ++i) {
        const double a = 72.0 * i * degree;
        star.emplace_back(std::cos(a), std::sin(a));
        star.emplace_back(0.053 * std::cos(a + 36.0 * degree), 0.053 * std::sin(a + 36.0 * degree));
    }
    const Mesh mesh = polygon_domain(star, {}, {.edge_length = 0.1});
    EXPECT_EQ(topology(mesh).euler_characteristic, 1);
    EXPECT_GT(quality(mesh).min_angle, 2.0 * degree);
    EXPECT_LT(mesh.face_count(), 1000);
    // A sliver with a sharp corner on either end of its sides.
    const Mesh sliver = polygon_domain({{0, 0}, {1, 0}, {0.5, 0.02}}, {}, {.edge_length = 0.1});
    EXPECT_LT(sliver.face_count(), 500);
    EXPECT_NEAR(area_of_positive_faces(sliver), 0.01, 1e-14);
}

TEST(PolygonDomain, ThinSlits) {
    for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        SCOPED_TRACE(width);
        const double w = width / 2.0;
        const Mesh mesh = polygon_domain({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
                                         {{{-0.5, -w}, {0.5, -w}, {0.5, w}, {-0.5, w}}}, {.edge_length = 0.1});
        EXPECT_TRUE(require_sound(mesh).empty());
        EXPECT_EQ(topology(mesh).euler_characteristic, 0);
        EXPECT_NEAR(area_of_positive_faces(mesh), 4.0 - width, 1e-12);
        EXPECT_GE(quality(mesh).min_angle, 25.0 * degree);
        EXPECT_LT(mesh.face_count(), 4000);
    }
}

TEST(PolygonDomain, EarsAreAvoided) {
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const double h : {0.3, 0.1, 0.05})
        EXPECT_EQ(quality(polygon_domain(square, {}, {.edge_length = h})).ears, 0) << h;
    // A corridor one edge wide: every triangle of it would have three boundary vertices.
    const Polygon corridor{{0, 0}, {3, 0}, {3, 0.1}, {0, 0.1}};
    DomainOptions options{.edge_length = 0.1};
    EXPECT_EQ(quality(polygon_domain(corridor, {}, options)).ears, 0);
    options.split_ears = false;
    EXPECT_GT(quality(polygon_domain(corridor, {}, options)).ears, 10);
}

TEST(PolygonDomain, RefusesImpossibleOutlines) {
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const auto refused = [](const Polygon& outer, const std::vector<Polygon>& holes = {}) {
        try {
            polygon_domain(outer, holes);
        } catch (const Error& error) {
            return error.cause() == Cause::bad_option;
        }
        return false;
    };
    EXPECT_TRUE(refused({{0, 0}, {1, 0}}));
    EXPECT_TRUE(refused({{0, 0}, {1, 0}, {0, 1}, {1, 1}}));  // crosses itself
    EXPECT_TRUE(refused({{0, 0}, {1, 0}, {1, 0}, {0, 1}}));  // corner twice
    EXPECT_TRUE(refused({{0, 0}, {1, 0}, {2, 0}}));          // no area
    EXPECT_TRUE(refused({{0, 0}, {1, NAN}, {0, 1}}));
    EXPECT_TRUE(refused(square, {{{2, 2}, {3, 2}, {2, 3}}}));              // outside
    EXPECT_TRUE(refused(square, {{{0.5, 0.5}, {1.5, 0.5}, {0.5, 0.7}}}));  // sticks out
    EXPECT_TRUE(
        refused(square, {{{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}}, {{0.2, 0.2}, {0.3, 0.2}, {0.2, 0.3}}}));  // nested
    EXPECT_TRUE(
        refused(square, {{{0.1, 0.1}, {0.5, 0.1}, {0.1, 0.5}}, {{0.2, 0.2}, {0.8, 0.2}, {0.2, 0.8}}}));  // overlap
}

}  // namespace
}  // namespace beltrami
