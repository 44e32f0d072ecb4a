#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/charts/boundary_correspondence.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using Pairs = std::vector<std::array<int, 2>>;

Eigen::RowVector2d at(const Surface& surface, const BoundaryPlace& place) {
    const std::vector<MeshPoint> points{mesh_point(surface, place)};
    return positions_on(surface.mesh, points).row(0);
}

Mesh ring(double inner, double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return circle_domain({}, std::vector<Circle>{{{0.1, 0}, inner}}, options);
}

/// The vertex of a loop nearest to a point.
int nearest(const Surface& surface, int loop, Complex point) {
    const auto& vertices = surface.topology.boundary_loops[loop];
    const auto distance = [&](int v) {
        return std::abs(Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)) - point);
    };
    return *std::min_element(vertices.begin(), vertices.end(), [&](int a, int b) { return distance(a) < distance(b); });
}

TEST(BoundaryCorrespondence, RunsByArcLengthBetweenPairs) {
    // A square of 4 to a finer one of 7, corner to corner: along a side the part of the way is the same.
    const Surface source(test::jittered_square(4)), target(test::jittered_square(7));
    const Pairs corners{{0, 0}, {4, 7}, {24, 63}, {20, 56}};
    const BoundaryCorrespondence found = boundary_correspondence(source, target, corners);
    ASSERT_EQ(found.partner, std::vector<int>{0});
    const auto& loop = source.topology.boundary_loops[0];
    ASSERT_EQ(found.places[0].size(), loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i)
        EXPECT_LT((at(target, found.places[0][i]) - source.mesh.positions.row(loop[i])).norm(), 1e-13) << loop[i];
    // One pair alone says where the loop begins: here a quarter turn further.
    const BoundaryCorrespondence turned = boundary_correspondence(source, target, Pairs{{0, 7}});
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::RowVector2d p = source.mesh.positions.row(loop[i]);
        EXPECT_LT((at(target, turned.places[0][i]) - Eigen::RowVector2d(1 - p.y(), p.x())).norm(), 1e-13) << loop[i];
    }
}

TEST(BoundaryCorrespondence, SendsEveryLoopToItsPartner) {
    const Surface source(ring(0.3, 0.15)), target(ring(0.4, 0.1));
    const Pairs pairs{{nearest(source, 0, 1), nearest(target, 0, Complex(0, 1))},
                      {nearest(source, 1, 0.4), nearest(target, 1, -0.3)}};
    const BoundaryCorrespondence found = boundary_correspondence(source, target, pairs);
    EXPECT_EQ(found.partner, (std::vector<int>{0, 1}));
    const CircleDomainChart circles = circle_domain_chart(target);
    const BoundaryCondition boundary = boundary_on_circles(source, target, circles, found);
    std::size_t next = 0;
    for (int l = 0; l < 2; ++l) {
        const RoundHole circle = circles.circle(l);
        double turned = 0;
        Complex before = 0, first = 0;
        for (const int v : source.topology.boundary_loops[l]) {
            ASSERT_EQ(boundary.vertices[next], v);
            const Complex arm = boundary.images[next++] - circle.centre;
            EXPECT_NEAR(std::abs(arm), circle.radius, 1e-14);
            if (before != 0.0) {
                // The domain on the left on both sides.
                EXPECT_GT((l == 0 ? 1 : -1) * std::arg(arm / before), 0);
                turned += std::arg(arm / before);
            } else {
                first = arm;
            }
            before = arm;
        }
        turned += std::arg(first / before);
        EXPECT_NEAR(turned, (l == 0 ? 2 : -2) * std::numbers::pi, 1e-12);
        // The paired vertices meet exactly.
        const auto at_pair = std::find(boundary.vertices.begin(), boundary.vertices.end(), pairs[l][0]);
        EXPECT_LT(std::abs(boundary.images[at_pair - boundary.vertices.begin()] - circles.chart.vertices[pairs[l][1]]),
                  1e-14);
    }
}

TEST(BoundaryCorrespondence, NamesWhatIsWrong) {
    const Surface square(test::jittered_square(4)), fine(test::jittered_square(7)), source(ring(0.3, 0.2)),
        target(ring(0.4, 0.2));
    const auto refused = [](const Surface& a, const Surface& b, const Pairs& pairs, const std::vector<int>& indices) {
        try {
            boundary_correspondence(a, b, pairs);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_boundary);
            EXPECT_EQ(error.indices(), indices) << error.what();
        }
    };
    refused(square, fine, {}, {0});
    refused(square, source, {{0, 0}}, {});
    refused(square, fine, {{6, 0}}, {6});    // inside
    refused(square, fine, {{0, 9}}, {9});    // inside
    refused(square, fine, {{99, 0}}, {99});  // nowhere
    refused(square, fine, {{0, 0}, {0, 7}}, {0});
    refused(square, fine, {{0, 7}, {4, 7}}, {7});
    refused(square, fine, {{0, 0}, {24, 7}, {4, 63}}, {0, 0});  // another order
    const int outer = nearest(source, 0, 1), other = nearest(source, 0, -1), inner = nearest(source, 1, 0.4),
              there = nearest(target, 0, 1), hole = nearest(target, 1, 0.4);
    refused(source, target, {{outer, there}}, {1});
    refused(source, target, {{outer, there}, {other, hole}}, {other, hole});
    refused(source, target, {{outer, there}, {inner, nearest(target, 0, -1)}}, {0});
}

}  // namespace
}  // namespace beltrami
