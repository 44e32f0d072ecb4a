#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh bowl(double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    Mesh mesh = circle_domain({}, {{{-0.4, 0.1}, 0.25}, {{0.45, -0.2}, 0.2}}, options);
    Positions points(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        points.row(v) << x, y, 0.4 * std::sin(2 * x + y);
    }
    mesh.positions = points;
    return mesh;
}

TEST(ChartPlaces, ArePlacesThatTheChartMapsThere) {
    const Surface source(bowl(0.1));
    const CircleDomainChart chart = circle_domain_chart(source);
    std::vector<Complex> points;
    std::vector<MeshPoint> known;
    for (int f = 0; f < source.mesh.face_count(); f += 3) {
        const auto v = source.mesh.faces[f];
        const double a = 0.2 + 0.01 * (f % 20), b = 0.3;
        known.push_back({f, {v[0], v[1], v[2]}, {a, b, 1 - a - b}});
        points.push_back(known.back().interpolate(chart.chart.vertices));
    }
    const std::vector<MeshPoint> places = locate_in_chart(source, chart.chart.vertices, points);
    const Positions found = positions_on(source.mesh, places), wanted = positions_on(source.mesh, known);
    ASSERT_EQ(found.cols(), 3);
    EXPECT_LT((found - wanted).cwiseAbs().maxCoeff(), 1e-12);
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(places[i].face, known[i].face);
    // Vertices come back as themselves.
    const std::vector<Complex> vertices(chart.chart.vertices.begin(), chart.chart.vertices.end());
    const Positions back = positions_on(source.mesh, locate_in_chart(source, chart.chart.vertices, vertices));
    EXPECT_LT((back - source.mesh.positions).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ChartPlaces, PointsBetweenChordAndArcGoToTheBoundary) {
    const Surface source(bowl(0.1));
    const CircleDomainChart chart = circle_domain_chart(source);
    const auto& outer = source.topology.boundary_loops[0];
    double longest = 0;
    for (std::size_t i = 0; i < outer.size(); ++i)
        longest = std::max(
            longest, std::abs(chart.chart.vertices[outer[i]] - chart.chart.vertices[outer[(i + 1) % outer.size()]]));
    std::vector<Complex> points;
    for (int i = 0; i < 500; ++i) points.push_back(std::polar(1.0, 0.0125 * i));
    const std::vector<MeshPoint> places = locate_in_chart(source, chart.chart.vertices, points);
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_LT(std::abs(places[i].interpolate(chart.chart.vertices) - points[i]), 1.01 * longest * longest / 8);
        int on_rim = 0;
        for (int j = 0; j < 3; ++j)
            on_rim += places[i].barycentric[j] > 0 && source.topology.on_boundary[places[i].vertices[j]];
        EXPECT_GE(on_rim, 1);
    }
    try {
        locate_in_chart(source, chart.chart.vertices, std::vector<Complex>{0.0, Complex(1.5, 0)});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_boundary);
        EXPECT_EQ(error.indices(), std::vector<int>{1});
    }
}

TEST(ChartPlaces, AnglesRunThroughEveryLoopOnce) {
    const Surface source(bowl(0.1));
    const CircleDomainChart chart = circle_domain_chart(source);
    for (int l = 0; l < 3; ++l) {
        const auto& loop = source.topology.boundary_loops[l];
        const int n = static_cast<int>(loop.size());
        const RoundHole circle = chart.circle(l);
        const double direction = l == 0 ? 1 : -1;
        for (int i = 0; i < n; ++i) {
            const double from = std::arg(chart.chart.vertices[loop[i]] - circle.centre);
            double to = std::arg(chart.chart.vertices[loop[(i + 1) % n]] - circle.centre);
            to = from + std::remainder(to - from, 2 * kPi);
            EXPECT_GT(direction * (to - from), 0);
            for (const double t : {0.25, 0.75}) {
                for (const double turns : {-1.0, 0.0, 2.0}) {
                    const BoundaryPlace place =
                        boundary_place(source, chart, l, from + t * (to - from) + 2 * kPi * turns);
                    EXPECT_EQ(place.loop, l);
                    EXPECT_EQ(place.edge, i);
                    EXPECT_NEAR(place.fraction, t, 1e-9);
                    const MeshPoint point = mesh_point(source, place);
                    EXPECT_EQ(point.vertices[0], loop[i]);
                    EXPECT_EQ(point.vertices[1], loop[(i + 1) % n]);
                    EXPECT_EQ(point.barycentric[2], 0);
                    int corners = 0;
                    for (const int v : source.mesh.faces[point.face])
                        for (const int w : point.vertices) corners += v == w;
                    EXPECT_EQ(corners, 3);
                }
            }
        }
    }
}

}  // namespace
}  // namespace beltrami
