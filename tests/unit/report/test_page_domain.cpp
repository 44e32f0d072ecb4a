#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/report/fundamental_polygon.h>
#include <beltrami/report/page_domain.h>
#include <beltrami/teichmuller/torus_map.h>

namespace beltrami {
namespace {

/// Side pairings of the regular octagon with angles of π/4, opposite sides.
std::vector<DiskIsometry> of_octagon() {
    // Half of the distance of opposite sides: cosh = cot(π/8).
    const double apart = 2 * std::acosh(1 / std::tan(kPi / 8));
    std::vector<DiskIsometry> result;
    for (int i = 0; i < 4; ++i) result.push_back(DiskIsometry::translation(std::polar(apart, i * kPi / 4)));
    return result;
}

TEST(DirichletPolygon, OfTheRegularOctagon) {
    const HyperbolicPolygon found = dirichlet_polygon(of_octagon(), 4 * kPi);
    ASSERT_EQ(found.sides.size(), 8U);
    EXPECT_NEAR(found.area, 4 * kPi, 1e-12);
    // Corners at the distance whose cosh is cot²(π/8).
    const double radius = std::tanh(0.5 * std::acosh(std::pow(std::tan(kPi / 8), -2)));
    for (const Complex corner : found.corners) EXPECT_NEAR(std::abs(corner), radius, 1e-12);
    const std::vector<Complex> side = found.points_of_side(0, 8);
    EXPECT_EQ(side.size(), 9U);
    for (const Complex point : side) {  // as far from 0 as from its image
        const Complex other = found.sides[0].place();
        EXPECT_NEAR(std::abs(point), std::abs((point - other) / (1.0 - std::conj(other) * point)), 1e-12);
    }
}

TEST(DirichletPolygon, DoesNotDependOnTheGenerators) {
    std::vector<DiskIsometry> words = of_octagon();
    words[1] = words[0] * words[1];
    words[2] = words[1].inverse() * words[2] * words[0];
    const HyperbolicPolygon found = dirichlet_polygon(words, 4 * kPi);
    ASSERT_EQ(found.sides.size(), 8U);
    EXPECT_NEAR(found.area, 4 * kPi, 1e-10);
}

TEST(DirichletPolygon, IsNoneWhereItsAreaIsNotThatOfTheQuotient) {
    EXPECT_TRUE(dirichlet_polygon({DiskIsometry::translation(1.0)}, 4 * kPi).sides.empty());
}

TEST(PageDomain, OfADoubleTorusHasTheAreaOfTheSurface) {
    const Surface surface(double_torus(0.15));
    const HyperbolicSurface metric = hyperbolic_surface(surface);
    const HyperbolicDomain domain = hyperbolic_domain(surface, metric);
    const HyperbolicPolygon polygon = dirichlet_polygon(domain.generators, 4 * kPi);
    EXPECT_GE(polygon.sides.size(), 8U);
    EXPECT_LE(polygon.sides.size(), 18U);  // 12g − 6
    EXPECT_NEAR(polygon.area, 4 * kPi, 1e-6);
    // Each side is paired with another one.
    for (const DiskIsometry& side : polygon.sides) {
        int pairs = 0;
        for (const DiskIsometry& other : polygon.sides) pairs += (side * other).from_identity() < 1e-6;
        EXPECT_EQ(pairs, 1);
    }
    const PageDomain page = page_domain(surface, metric, domain);
    ASSERT_EQ(page.outline.size(), 2U);  // the circle and the polygon
    EXPECT_EQ(page.mesh.face_count(), surface.mesh.face_count());
    EXPECT_GT(page.mesh.vertex_count(), surface.mesh.vertex_count());
    for (int f = 0; f < page.mesh.face_count(); ++f)
        for (int j = 0; j < 3; ++j)
            EXPECT_EQ(page.joined[static_cast<std::size_t>(page.mesh.faces[f][j])], surface.mesh.faces[f][j]);
    EXPECT_EQ(page.at_copies(surface.mesh.positions), page.mesh.positions);
}

TEST(PageDomain, MovesZerosToTheCopiesOfTheirVertices) {
    const Surface surface(double_torus(0.2));
    const HyperbolicSurface metric = hyperbolic_surface(surface);
    const PageDomain page = page_domain(surface, metric, hyperbolic_domain(surface, metric));
    PageDifferential phi;
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
        const auto v = surface.mesh.faces[f];
        phi.points.push_back({{f, {v[2], v[0], v[1]}, {0.2, 0.3, 0.5}}, 1, false});
    }
    const PageDifferential moved = page.at_copies(phi, surface.mesh);
    for (const CriticalPoint& point : moved.points) {
        const auto v = page.mesh.faces[point.place.face];
        EXPECT_EQ(point.place.vertices, (std::array<int, 3>{v[2], v[0], v[1]}));
    }
}

/// Directions on a torus of revolution, from those of its flat metric: parallels and meridians are its lines.
TEST(PageDomain, OfATorusHasTheDirectionsOfTheAffineMap) {
    const int nu = 48, nv = 24;
    const Surface source(torus(2, 1, nu, nv)), target(torus(std::sqrt(2.0), 1, nu, nv));
    const FlatTorus flat = flat_torus(source);
    const TorusMap map = torus_map(source, target);
    const PageDifferential phi = page_differential(source, flat, map.mu);
    EXPECT_TRUE(phi.points.empty());
    // The map stretches along one of the two circles; the rotational symmetry leaves no other direction.
    double along_parallel = 0, along_meridian = 0;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const auto v = source.mesh.faces[f];
        const Eigen::Vector3d x = (source.mesh.point(v[1]) - source.mesh.point(v[0])).normalized();
        const Eigen::Vector3d normal = face_vector_area(source.mesh, f).normalized();
        const double angle = phi.angles[f];
        const Eigen::Vector3d direction = std::cos(angle) * x + std::sin(angle) * normal.cross(x);
        const Eigen::Vector3d middle =
            (source.mesh.point(v[0]) + source.mesh.point(v[1]) + source.mesh.point(v[2])) / 3;
        const double parallel = std::abs(direction.dot(Eigen::Vector3d(-middle.y(), middle.x(), 0).normalized()));
        along_parallel = std::max(along_parallel, parallel);
        along_meridian = std::max(along_meridian, std::sqrt(std::max(0.0, 1 - parallel * parallel)));
    }
    EXPECT_LT(std::min(along_parallel, along_meridian), 0.15);

    const PageDomain page = page_domain(source, flat);
    ASSERT_EQ(page.outline.size(), 1U);
    double doubled = 0;
    const Positions& outline = page.outline[0];
    for (Eigen::Index i = 0; i + 1 < outline.rows(); ++i)
        doubled += outline(i, 0) * outline(i + 1, 1) - outline(i + 1, 0) * outline(i, 1);
    EXPECT_NEAR(0.5 * doubled, flat.tau.imag(), 1e-12);
    // The faces lie over it: their middles in it.
    const Complex origin(outline(0, 0), outline(0, 1));
    for (int f = 0; f < page.mesh.face_count(); ++f) {
        Complex middle = 0;
        for (const int v : page.mesh.faces[f]) middle += Complex(page.layout(v, 0), page.layout(v, 1)) / 3.0;
        const double beta = (middle - origin).imag() / flat.tau.imag(),
                     alpha = (middle - origin).real() - beta * flat.tau.real();
        EXPECT_TRUE(alpha > -1e-9 && alpha < 1 + 1e-9 && beta > -1e-9 && beta < 1 + 1e-9);
    }
}

}  // namespace
}  // namespace beltrami
