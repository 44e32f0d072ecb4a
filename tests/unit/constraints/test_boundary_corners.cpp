#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Complex at(const Surface& surface, int v) {
    return {surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)};
}

std::vector<int> sorted_vertices(const std::vector<BoundaryCorner>& corners) {
    std::vector<int> vertices;
    for (const BoundaryCorner& corner : corners) vertices.push_back(corner.vertex);
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

double largest_bound(const std::vector<BoundaryCorner>& corners) {
    double bound = 1;
    for (const BoundaryCorner& corner : corners) bound = std::max(bound, corner.corner_bound);
    return bound;
}

BoundaryCorner corner_at(const std::vector<BoundaryCorner>& corners, int vertex) {
    for (const BoundaryCorner& corner : corners)
        if (corner.vertex == vertex) return corner;
    ADD_FAILURE() << "no corner at vertex " << vertex;
    return {};
}

TEST(CornerBound, ClosedForms) {
    EXPECT_EQ(corner_bound(kPi, kPi, 3, 3, 1), 1);
    EXPECT_NEAR(corner_bound(kPi, kPi / 2, 1, 1, 1), 2, 1e-14);
    EXPECT_NEAR(corner_bound(kPi / 2, kPi, 1, 1, 1), 2, 1e-14);
    EXPECT_NEAR(corner_bound(kPi, kPi / 2, 1, 1, 0.5), 1, 1e-14) << "the speed of the conformal map";
    EXPECT_NEAR(corner_bound(kPi, kPi, 1, 1, 2), 2, 1e-14);
    // Shear [[1, s], [0, 1]]: σmax = s/2 + √(1 + s²/4), σmin its inverse.
    const double s = std::log(5.0) / kPi, stretch = s / 2 + std::sqrt(1 + s * s / 4);
    EXPECT_NEAR(corner_bound(kPi, kPi, 2, 10, 1), stretch * stretch, 1e-14);
    EXPECT_NEAR(corner_bound(kPi, kPi, 10, 2, 1), stretch * stretch, 1e-14);
    EXPECT_TRUE(std::isinf(corner_bound(kPi, 0, 1, 1, 1)));
}

TEST(BoundaryCorners, SmoothDataHaveNone) {
    const Surface surface(disk(32));
    const std::function<Complex(Complex)> maps[] = {
        [](Complex z) { return z; },
        [](Complex z) { return (z - 0.5) / (1.0 - 0.5 * z); },
        [](Complex z) { return z + 0.2 * z * z; },
        [](Complex z) { return std::polar(1.0, std::arg(z) + 0.5 * std::sin(std::arg(z))); },
        [](Complex z) { return std::polar(1 + 0.2 * std::cos(3 * std::arg(z)), std::arg(z)); },
        [](Complex z) { return Complex(3 * z.real(), z.imag()); },
        test::exact_composition,
    };
    for (const auto& map : maps) EXPECT_TRUE(find_corners(surface, test::boundary_values(surface, map)).empty());
    const Surface ring(annulus(0.4, 1, 120));
    EXPECT_TRUE(find_corners(ring, test::boundary_values(ring, [](Complex z) { return z * std::abs(z); })).empty());
}

TEST(BoundaryCorners, TheBoundOfASmoothPointConvergesToOne) {
    const std::function<Complex(Complex)> maps[] = {
        [](Complex z) { return z + 0.2 * z * z; },
        [](Complex z) { return std::polar(1.0, std::arg(z) + 0.5 * std::sin(std::arg(z))); },
        [](Complex z) { return std::polar(1 + 0.2 * std::cos(3 * std::arg(z)), std::arg(z)); },
    };
    for (const auto& map : maps) {
        double coarse = 0;
        for (const int rings : {16, 64}) {
            const Surface surface(disk(rings));
            const BoundaryCondition boundary = test::boundary_values(surface, map);
            double worst = 0;
            for (int i = 0; i < 6 * rings; i += rings / 2)
                worst = std::max(worst, measure_boundary_point(surface, boundary, 0, i).corner_bound - 1);
            if (rings == 16) coarse = worst;
            if (rings == 64) {
                EXPECT_LT(worst, 4e-4);
                EXPECT_LT(worst, coarse / 8);
            }
        }
    }
}

TEST(BoundaryCorners, SquareToArrowHead) {
    const Surface surface(test::jittered_square(40));
    const Complex tip(0.35, 0.35);
    const BoundaryCondition boundary = test::boundary_values(surface, [&](Complex z) {
        if (z.real() > 1 - 1e-12) return 1.0 + z.imag() * (tip - 1.0);
        if (z.imag() > 1 - 1e-12) return Complex(0, 1) + z.real() * (tip - Complex(0, 1));
        return z;
    });
    const auto corners = find_corners(surface, boundary);
    EXPECT_EQ(sorted_vertices(corners), (std::vector{0, 40, 1640, 1680}));
    const BoundaryCorner pushed = corner_at(corners, 1680);
    const double speed = std::abs(tip - 1.0), beta = 2 * kPi - std::arg((Complex(0, 1) - tip) / (1.0 - tip));
    EXPECT_NEAR(pushed.source_angle, kPi / 2, 1e-9);
    EXPECT_NEAR(pushed.image_angle, beta, 1e-9);
    EXPECT_NEAR(pushed.speed_out, speed, 1e-9);
    EXPECT_NEAR(pushed.speed_in, speed, 1e-9);
    const BoundaryCorner sharp = corner_at(corners, 40);
    EXPECT_NEAR(sharp.image_angle, std::arg(Complex(-1) / (tip - 1.0)), 1e-9);
    EXPECT_NEAR(sharp.speed_out, speed, 1e-9);
    EXPECT_NEAR(sharp.speed_in, 1, 1e-9);
    EXPECT_NEAR(sharp.corner_bound, corner_bound(kPi / 2, sharp.image_angle, speed, 1, 1), 1e-9);
    EXPECT_EQ(sharp.exponent, 1);
}

TEST(BoundaryCorners, SmoothToSquareByArcLength) {
    const Surface surface(disk(32));
    const auto corners = find_corners(surface, boundary_to_rectangle(surface, 1, 1, std::nullopt));
    ASSERT_EQ(corners.size(), 4u);
    for (const BoundaryCorner& corner : corners) {
        EXPECT_NEAR(corner.image_angle, kPi / 2, 1e-9);
        EXPECT_NEAR(corner.corner_bound, 2, 1e-3);
        EXPECT_NEAR(corner.safe_bound, 2, 1e-2);
    }
}

TEST(BoundaryCorners, CornersOfTheSource) {
    DomainOptions options;
    options.edge_length = 0.05;
    const Surface surface(polygon_domain({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}, options));
    const auto own = find_corners(surface, test::boundary_values(surface, [](Complex z) { return z; }));
    EXPECT_EQ(sorted_vertices(own), (std::vector{0, 1, 2, 3, 4, 5}));
    EXPECT_NEAR(largest_bound(own), 1, 1e-9);
    EXPECT_NEAR(corner_at(own, 3).source_angle, 1.5 * kPi, 1e-9);
    const auto square = find_corners(surface, boundary_to_rectangle(surface, 1, 1, std::nullopt));
    EXPECT_EQ(sorted_vertices(square), (std::vector{0, 1, 2, 3, 4, 5}));
    EXPECT_NEAR(corner_at(square, 3).corner_bound, 3, 1e-9) << "3π/2 to π/2";
    EXPECT_NEAR(corner_at(square, 2).corner_bound, 2, 1e-9) << "π/2 to π";
    // Without any prescription the source's own corners are there, and no bound.
    const auto source = find_corners(surface, {});
    EXPECT_EQ(sorted_vertices(source), (std::vector{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(largest_bound(source), 1);
    EXPECT_TRUE(std::isnan(source[0].image_angle) && std::isnan(source[0].speed_in));
}

TEST(BoundaryCorners, Gear) {
    Polygon gear;
    for (int tooth = 0; tooth < 12; ++tooth)
        for (const auto& [t, r] :
             {std::pair{0.0, 1.0}, std::pair{0.15, 1.3}, std::pair{0.5, 1.3}, std::pair{0.65, 1.0}})
            gear.emplace_back(r * std::cos((tooth + t) * kPi / 6), r * std::sin((tooth + t) * kPi / 6));
    DomainOptions options;
    options.edge_length = 0.05;  // 4 to 7 edges a side
    const Surface surface(polygon_domain(gear, {}, options));
    std::vector<int> all(48);
    for (int v = 0; v < 48; ++v) all[v] = v;
    const auto own = find_corners(surface, test::boundary_values(surface, [](Complex z) { return z; }));
    EXPECT_EQ(sorted_vertices(own), all);
    EXPECT_NEAR(largest_bound(own), 1, 1e-9);
    const auto round = find_corners(surface, boundary_to_disk(surface, 0));
    EXPECT_EQ(sorted_vertices(round), all);
    const double sharpest = corner_at(own, 1).source_angle;
    EXPECT_NEAR(corner_at(round, 1).corner_bound, kPi / sharpest, 1e-2);
}

TEST(BoundaryCorners, KinksOfTheSpeed) {
    const Surface surface(disk(32));
    // Arc length between landmarks: angle 0 … 2 goes to 0 … 1, the rest to the rest.
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) {
        const double t = std::arg(z) < -1e-12 ? std::arg(z) + 2 * kPi : std::arg(z), kink = 2 * kPi / 3;
        return std::polar(1.0, t < kink ? t / 2 : kink / 2 + (t - kink) * (2 * kPi - kink / 2) / (2 * kPi - kink));
    });
    const auto corners = find_corners(surface, boundary);
    ASSERT_EQ(corners.size(), 2u);
    const double ratio = 0.5 / ((2 - 1.0 / 3) / (2 - 2.0 / 3));
    for (const BoundaryCorner& corner : corners) {
        const bool first = std::abs(at(surface, corner.vertex) - 1.0) < 1e-9;
        EXPECT_TRUE(first || std::abs(at(surface, corner.vertex) - std::polar(1.0, 2 * kPi / 3)) < 1e-9);
        EXPECT_NEAR(std::log(corner.speed_out / corner.speed_in), std::log(first ? ratio : 1 / ratio), 1e-2);
        EXPECT_NEAR(corner.corner_bound, corner_bound(kPi, kPi, 1, ratio, 1), 1e-2);
    }
}

TEST(BoundaryCorners, Powers) {
    // w|w| on the half plane, carried to the disk: p = 2 at 0 and at ∞, K = 2.
    for (const auto& [rings, tolerance] : {std::pair{16, 0.05}, std::pair{32, 0.015}, std::pair{64, 0.004}}) {
        const Surface surface(disk(rings));
        const Complex i(0, 1);
        const BoundaryCondition boundary = test::boundary_values(surface, [&](Complex z) {
            if (std::abs(z - 1.0) < 1e-12) return Complex(1);
            const double x = (i * (1.0 + z) / (1.0 - z)).real(), y = x * std::abs(x);
            return (y - i) / (y + i);
        });
        const auto corners = find_corners(surface, boundary);
        ASSERT_EQ(corners.size(), 2u);
        for (const BoundaryCorner& corner : corners) {
            EXPECT_NEAR(std::abs(at(surface, corner.vertex).real()), 1, 1e-9);
            EXPECT_NEAR(corner.exponent, 2, tolerance);
            EXPECT_NEAR(corner.corner_bound, 2, tolerance);
            EXPECT_LE(corner.safe_bound, corner.corner_bound);
        }
    }
}

TEST(BoundaryCorners, HolesAndSpace) {
    const Polygon outer{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, hole{{0.6, 0.6}, {0.6, 1.2}, {1.2, 1.2}, {1.2, 0.6}};
    DomainOptions options;
    options.edge_length = 0.05;
    const Surface flat(polygon_domain(outer, {hole}, options));
    const auto corners = find_corners(flat, test::boundary_values(flat, [](Complex z) { return z; }));
    ASSERT_EQ(sorted_vertices(corners), (std::vector{0, 1, 2, 3, 4, 5, 6, 7}));
    for (const BoundaryCorner& corner : corners) {
        EXPECT_NEAR(corner.source_angle, corner.loop == 0 ? kPi / 2 : 1.5 * kPi, 1e-9);
        EXPECT_NEAR(corner.image_angle, corner.source_angle, 1e-9);
        EXPECT_EQ(flat.topology.boundary_loops[corner.loop][corner.position], corner.vertex);
    }
    // Rolled up, the surface has the same angles but for the faces' bending; in its flat metric, exactly.
    Mesh rolled = flat.mesh;
    rolled.positions.resize(flat.mesh.vertex_count(), 3);
    for (int v = 0; v < rolled.vertex_count(); ++v) {
        const Complex z = at(flat, v);
        rolled.positions.row(v) << std::cos(z.real()), std::sin(z.real()), z.imag();
    }
    const auto bent = find_corners(Surface(rolled), {});
    EXPECT_EQ(sorted_vertices(bent), sorted_vertices(corners));
    for (const BoundaryCorner& corner : bent)
        EXPECT_NEAR(corner.source_angle, corner_at(corners, corner.vertex).source_angle, 0.01);
    for (const BoundaryCorner& corner : find_corners(Surface(rolled, corner_positions(flat.mesh)), {}))
        EXPECT_NEAR(corner.source_angle, corner_at(corners, corner.vertex).source_angle, 1e-9);
}

/// A disk whose boundary vertices stand off the circle by up to a part of the edge length.
Mesh jagged_disk(int rings, double amount, bool alternating) {
    Mesh mesh = disk(rings);
    unsigned state = 12345;
    for (int v = mesh.vertex_count() - 6 * rings; v < mesh.vertex_count(); ++v) {
        state = 1664525u * state + 1013904223u;
        const double side = alternating ? (v % 2 ? 1.0 : -1.0) : 2.0 * (state >> 8) / double(1 << 24) - 1;
        mesh.positions.row(v) *= 1 + side * amount / rings;
    }
    return mesh;
}

TEST(BoundaryCorners, JaggedOutlinesHaveNone) {
    for (const bool alternating : {true, false}) {
        const Surface surface(jagged_disk(32, 0.4, alternating));
        EXPECT_TRUE(find_corners(surface, {}).empty());
        EXPECT_TRUE(find_corners(surface, boundary_to_disk(surface, 0.3)).empty());
        // The corners of a square image are found all the same.
        const auto corners = find_corners(surface, boundary_to_rectangle(surface, 1, 1, std::nullopt));
        EXPECT_EQ(corners.size(), 4u);
        for (const BoundaryCorner& corner : corners) {
            EXPECT_NEAR(corner.corner_bound, 2, 0.2);
            EXPECT_LE(corner.safe_bound, corner.corner_bound);
        }
    }
}

TEST(BoundaryCorners, IndependentOfPlaceScaleAndOrder) {
    const Surface surface(disk(24));
    const BoundaryCondition boundary = boundary_to_rectangle(surface, 2, 1, std::nullopt);
    const auto corners = find_corners(surface, boundary);
    Mesh moved = surface.mesh;
    for (int v = 0; v < moved.vertex_count(); ++v) {
        const Complex z = 1e4 * std::polar(1.0, 0.7) * at(surface, v) + Complex(2e4, -1e4);
        moved.positions.row(v) << z.real(), z.imag();
    }
    // Vertices counted backwards: loops start elsewhere.
    const int last = moved.vertex_count() - 1;
    moved.positions = moved.positions.colwise().reverse().eval();
    FaceList faces;
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
        const auto v = surface.mesh.faces[f];
        faces.add({last - v[0], last - v[1], last - v[2]});
    }
    moved.faces = faces;
    BoundaryCondition turned;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        turned.pin(last - boundary.vertices[i], std::polar(1e-5, 2.0) * boundary.images[i] + Complex(1e-4, 0));
    const auto others = find_corners(Surface(moved), turned);
    ASSERT_EQ(others.size(), corners.size());
    for (const BoundaryCorner& corner : corners) {
        const BoundaryCorner other = corner_at(others, last - corner.vertex);
        EXPECT_NEAR(other.source_angle, corner.source_angle, 1e-6);
        EXPECT_NEAR(other.image_angle, corner.image_angle, 1e-6);
        EXPECT_NEAR(other.speed_out * 1e9, corner.speed_out, 1e-6 * corner.speed_out);
        EXPECT_NEAR(other.corner_bound, corner.corner_bound, 1e-6);
    }
    for (std::size_t i = 1; i < corners.size(); ++i) EXPECT_GE(corners[i - 1].significance, corners[i].significance);
}

TEST(BoundaryCorners, PartlyPrescribedAndSmallLoops) {
    const Surface surface(test::jittered_square(20));
    BoundaryCondition half;
    for (const int v : surface.topology.boundary_loops[0])
        if (at(surface, v).imag() < 0.6) half.pin(v, 2.0 * at(surface, v));
    const auto corners = find_corners(surface, half);
    EXPECT_EQ(sorted_vertices(corners), (std::vector{0, 20, 420, 440}));
    EXPECT_NEAR(corner_at(corners, 0).speed_out, 2, 1e-9);
    EXPECT_TRUE(std::isnan(corner_at(corners, 440).speed_out));
    EXPECT_EQ(find_corners(Surface(test::jittered_square(4)), {}).size(), 4u);
    EXPECT_NO_THROW(find_corners(Surface(test::jittered_square(1)), {}));
    EXPECT_TRUE(find_corners(Surface(disk(2)), {}).empty());
    EXPECT_TRUE(find_corners(Surface(torus(2, 1, 8, 6)), {}).empty());
    EXPECT_THROW(measure_boundary_point(surface, half, 1, 0), Error);
    CornerOptions options;
    options.min_turn = 0;
    EXPECT_THROW(find_corners(surface, half, options), Error);
}

TEST(BoundaryCorners, RealScans) {
    const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
    if (!folder || !std::filesystem::exists(folder)) GTEST_SKIP() << "BELTRAMI_TEST_MESHES names no folder of meshes";
    const std::filesystem::path meshes(folder);
    const Surface face(read_mesh(meshes / "human_face.obj").mesh);
    EXPECT_LE(find_corners(face, boundary_to_disk(face, 0.5)).size(), 4u) << "a jagged outline";
    const std::array<int, 4> chosen{610, 106, 2303, 14923};
    const auto square = find_corners(face, boundary_to_rectangle(face, 1, 1, chosen));
    for (const int v : chosen) EXPECT_NEAR(corner_at(square, v).image_angle, kPi / 2, 1e-9);
    EXPECT_NEAR(largest_bound(square), 1.95, 0.06);

    const Surface domain(read_mesh(meshes / "mcqc3d_planar_src.obj").mesh);
    const IndexedRows pins = read_indexed_rows(meshes / "mcqc3d_pins.txt", 1, domain.mesh.vertex_count(), 2, "a pin");
    BoundaryCondition boundary;
    for (Eigen::Index i = 0; i < pins.indices.rows(); ++i)
        boundary.pin(pins.indices(i, 0), {pins.values(i, 0), pins.values(i, 1)});
    const auto kinks = find_corners(domain, boundary);
    EXPECT_GE(kinks.size(), 15u);
    EXPECT_LE(kinks.size(), 25u);
    EXPECT_NEAR(largest_bound(kinks), 2.205, 0.01);
}

}  // namespace
}  // namespace beltrami
