#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/certificate/sharpened_bound.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/rational_space.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// z|z|^{κ−1}e^{is log|z|} on the ring r < |z| < 1: the extremal map, φ = c/z².
struct Turned {
    double kappa, s;
    Turned(double inner, int turns, double stretch)
        : kappa(stretch), s(2 * std::numbers::pi * turns / std::log(inner)) {}
    Complex operator()(Complex z) const {
        const double x = std::log(std::abs(z));
        return z * std::exp(Complex((kappa - 1) * x, s * x));
    }
    Complex ratio() const { return Complex(0.5 * (kappa - 1), 0.5 * s) / Complex(0.5 * (kappa + 1), 0.5 * s); }
    double k() const { return std::abs(ratio()); }
    double K() const { return (1 + k()) / (1 - k()); }
};

/// c/z².
class OfRing final : public DifferentialSpace {
  public:
    explicit OfRing(Complex c) : c_(c) {}
    int size() const override { return 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& p) const override {
        return (c_ * (p.derivatives.array() / p.positions.array()).square()).matrix();
    }
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    Complex c_;
};

const Eigen::VectorXcd kOne = Eigen::VectorXcd::Ones(1);

struct Ring {
    Surface surface;
    Chart chart;
    BoundaryCondition boundary;
    OfRing space;
    Ring(const Mesh& mesh, const Turned& map)
        : surface(mesh),
          chart(domain_chart(surface)),
          boundary(test::boundary_values(surface, map)),
          space(std::conj(map.ratio())) {}
};

TEST(QuadraticMap, OperatorsAreExactForQuadraticPolynomials) {
    const Surface surface(test::jittered_square(5));
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    const auto f = [](Complex p) { return p * p + Complex(0.2, 0.7) * p * std::conj(p) - 0.3 * std::conj(p * p); };
    QuadraticMap map = straight(surface, z);
    for (Complex& p : map) p = f(p);
    const Operators operators = quadratic_operators(surface);
    const Eigen::VectorXcd places = straight(surface, z);
    double area = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto v = surface.operators.stencil(operators.faces[s]);
        Complex p = 0;
        for (int j = 0; j < 3; ++j) p += z[v[j]] * (j == s % 3 ? 2.0 / 3 : 1.0 / 6);
        const auto [dz, dzbar] = operators.derivatives(s, map);
        EXPECT_LT(std::abs(dz - (2.0 * p + Complex(0.2, 0.7) * std::conj(p))), 1e-12);
        EXPECT_LT(std::abs(dzbar - (Complex(0.2, 0.7) * p - 0.6 * std::conj(p))), 1e-12);
        EXPECT_LT(std::abs(operators.derivatives(s, places)[1]), 1e-13);
        area += operators.weights[s];
    }
    EXPECT_NEAR(area, 1, 1e-12);
}

TEST(QuadraticMap, OfAPiecewiseLinearMapHasItsIntegrals) {
    const Ring ring(annulus(0.2, 1, 24), Turned(0.2, 0, 2));
    const Eigen::VectorXcd map = harmonic_map(ring.surface, ring.boundary);
    const ReichStrebel linear = reich_strebel(ring.surface, ring.chart, ring.space, kOne,
                                              beltrami_coefficient(ring.surface.operators, map)),
                       quadratic = reich_strebel_quadratic(ring.surface, ring.chart, ring.space, kOne,
                                                           straight(ring.surface, map));
    ASSERT_TRUE(linear.valid && quadratic.valid && linear.resolved && quadratic.resolved);
    EXPECT_NEAR(linear.lower, quadratic.lower, 1e-6);
    EXPECT_NEAR(linear.estimate, quadratic.estimate, 1e-6);
}

TEST(QuadraticMap, ItsBoundConvergesAndIsFarBetter) {
    // Against a fine one of the same polygon: the polygon's own K* differs from the ring's.
    const Turned map(0.2, 0, 3);
    const Ring ring(annulus(0.2, 1, 12), map);
    double lower[4];
    for (const int n : {0, 1, 2, 3}) {
        SharpenedBoundOptions options;
        options.subdivisions = n;
        const SharpenedBound bound =
            sharpened_bound(ring.surface, ring.boundary, ring.chart, ring.space, kOne, map.k(), options);
        ASSERT_TRUE(bound.integrals.valid);
        EXPECT_TRUE(bound.rigorous);
        EXPECT_EQ(bound.triangles, ring.surface.mesh.face_count() << 2 * n);
        lower[n] = bound.lower;
    }
    EXPECT_LT(lower[0], lower[1]);
    EXPECT_LT(lower[1], lower[2]);
    EXPECT_GT((lower[1] - lower[0]) / (lower[2] - lower[1]), 3.5);  // the polygon's kinks
    ExtremalOptions linear;
    linear.sharpen = -1;
    EXPECT_LT(5 * (lower[3] - lower[0]), lower[3] - extremal_map(ring.surface, ring.boundary, linear).K_lower);
    EXPECT_LT(lower[3] - lower[2], lower[2] - lower[1]);
}

TEST(SharpenedBound, TwoTurnsOfARing) {
    const Turned map(0.05, 2, 1);
    JitterOptions jitter;
    jitter.amplitude = 0.2;
    for (const Mesh& mesh : {annulus(0.05, 1, 120, 66), annulus(0.05, 1, 120, 66, jitter)}) {
        const Ring ring(mesh, map);
        // k is too large by what a c-step on this mesh finds.
        const SharpenedBound bound = sharpened_bound(ring.surface, ring.boundary, ring.chart, ring.space, kOne, 0.91);
        ASSERT_TRUE(bound.integrals.valid && bound.rigorous);
        EXPECT_LT(bound.lower, map.K());
        EXPECT_GT(bound.lower, 0.995 * map.K());
        EXPECT_NEAR(bound.integrals.estimate, map.K(), 0.005 * map.K());
    }
}

TEST(SharpenedBound, QuadsAndSurfacesInSpaceAreCutAndNotProved) {
    Mesh mesh = test::quad_disk(8);
    const Surface flat(mesh);
    const BoundaryCondition boundary = test::boundary_values(flat, test::exact_composition);
    ExtremalOptions options;
    options.sharpen = 0;
    const ExtremalMap quads = extremal_map(flat, boundary, options);
    const Surface triangles = cut_into_triangles(flat);
    EXPECT_EQ(triangles.mesh.face_count(), 2 * flat.mesh.face_count());
    EXPECT_NEAR(triangles.operators.area(), flat.operators.area(), 1e-12);
    EXPECT_NEAR(quads.K_lower, extremal_map(triangles, boundary, options).K_lower, 2e-3);
    EXPECT_GT(quads.K_lower, 2.99);
    const Surface bump(test::bump(1500));
    const ExtremalMap curved = extremal_map(bump, test::boundary_values(bump, test::exact_composition), options);
    EXPECT_LT(curved.K - curved.K_lower, 0.01);
    for (const Bound& bound : curved.bounds) EXPECT_FALSE(bound.kind == Bound::Kind::reich_strebel && bound.rigorous);
}

TEST(SharpenedBound, RefinedProblemsAreTheSameProblem) {
    // A metric of its own, with quads: area, boundary and frames go along.
    const Mesh mesh = test::mixed_square(4);
    Positions metric = corner_positions(mesh);
    metric.col(0) *= 2;
    const Surface surface(mesh, metric);
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z + 0.2 * z * z; });
    const RefinedProblem fine = refined_problem(surface, boundary);
    EXPECT_NEAR(fine.surface.operators.area(), surface.operators.area(), 1e-12);
    EXPECT_EQ(fine.boundary.vertices.size(), 2 * boundary.vertices.size());
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const Eigen::VectorXcd affine = 2.0 * z + 0.5 * z.conjugate();
    const Eigen::VectorXcd coarse_mu = beltrami_coefficient(surface.operators, affine),
                           fine_mu = beltrami_coefficient(fine.surface.operators, fine.interpolated(affine));
    for (const Complex mu : fine_mu) {
        double nearest = 1;
        for (const Complex other : coarse_mu) nearest = std::min(nearest, std::abs(std::abs(mu) - std::abs(other)));
        EXPECT_LT(nearest, 1e-12);
    }
}

TEST(SharpenedBound, BadMapsAreNoWitnesses) {
    const Ring ring(annulus(0.2, 1, 24), Turned(0.2, 0, 2));
    const Eigen::VectorXcd good = harmonic_map(ring.surface, ring.boundary);
    const auto integrals = [&](const QuadraticMap& map) {
        return reich_strebel_quadratic(ring.surface, ring.chart, ring.space, kOne, map);
    };
    ASSERT_TRUE(integrals(straight(ring.surface, good)).valid);
    EXPECT_FALSE(integrals(straight(ring.surface, good.conjugate())).valid);
    QuadraticMap map = straight(ring.surface, good);
    const Eigen::Index middle = good.size() + ring.surface.topology.edge_count() / 2;
    // One midpoint thrown far: folded, and straightened again.
    map[middle] += 5.0;
    EXPECT_FALSE(integrals(map).valid);
    EXPECT_TRUE(straighten(ring.surface, map).empty());
    EXPECT_LT((map - straight(ring.surface, good)).norm(), 1e-12);
    map[middle] = std::nan("");
    EXPECT_FALSE(integrals(map).valid);
    EXPECT_TRUE(straighten(ring.surface, map).empty());
    // A vertex beyond its neighbours: nothing to straighten.
    map = straight(ring.surface, good);
    int inner = 0;
    while (ring.surface.topology.on_boundary[inner]) ++inner;
    map[inner] += 3.0;
    EXPECT_FALSE(straighten(ring.surface, map).empty());
    EXPECT_FALSE(integrals(map).valid);
    map[inner] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(integrals(map).valid);
    // What another map has there mends it, and nothing else moves; a map that is turned over itself mends nothing.
    QuadraticMap bent = straight(ring.surface, good);
    int edge = ring.surface.topology.edge_count() - 1;
    const auto on_rim = [&](int end) {
        return ring.surface.topology.on_boundary[ring.surface.topology.edges[edge][end]];
    };
    while (on_rim(0) || on_rim(1)) --edge;
    const Eigen::Index far = good.size() + edge;
    bent[far] += 1e-4;
    const Complex kept_point = bent[far];
    bent[inner] += 3.0;
    EXPECT_TRUE(mend(ring.surface, bent, good).empty());
    EXPECT_TRUE(integrals(bent).valid);
    EXPECT_EQ(bent[inner], good[inner]);
    EXPECT_EQ(bent[far], kept_point);
    EXPECT_FALSE(mend(ring.surface, map, good.conjugate()).empty());
    // Coefficients of piecewise linear maps.
    Eigen::VectorXcd mu = beltrami_coefficient(ring.surface.operators, good);
    const auto linear = [&] { return reich_strebel(ring.surface, ring.chart, ring.space, kOne, mu); };
    ASSERT_TRUE(linear().valid);
    const Complex kept = mu[7];
    for (const Complex bad : {Complex(1), Complex(0, 1.5), Complex(std::nan(""), 0)}) {
        mu[7] = bad;
        EXPECT_FALSE(linear().valid);
    }
    mu[7] = kept;
    EXPECT_FALSE(
        reich_strebel(ring.surface, ring.chart, ring.space, Eigen::VectorXcd::Constant(1, std::nan("")), mu).valid);
    // Another φ than that of the map gives a bound, only a worse one; φ = 0 gives none.
    const ReichStrebel other = reich_strebel(ring.surface, ring.chart, OfRing(Complex(0, 1)), kOne, mu);
    EXPECT_TRUE(other.valid);
    EXPECT_LT(other.lower, 1.01);
    EXPECT_EQ(reich_strebel(ring.surface, ring.chart, ring.space, 0.0 * kOne, mu).lower, 1);
    EXPECT_THROW(quadratic_operators(Surface(test::quad_square(3, 0.1))), Error);
}

TEST(SharpenedBound, OfExtremalMapsOfLargeDilatation) {
    // The record's own numbers: K within 3 % and K_lower within 1.5 %, up to K = 20.
    const auto check = [](int turns, double stretch, double K_error, double lower_error) {
        const Turned map(0.05, turns, stretch);
        const Surface surface(annulus(0.05, 1, 120, 66));
        Constraints constraints(test::boundary_values(surface, map));
        constraints.correspondence.turns = {0, turns};
        const ExtremalMap found = extremal_map(surface, constraints);
        EXPECT_NEAR(found.K / map.K(), 1, K_error) << map.K();
        EXPECT_GT(found.K_lower / map.K(), 1 - lower_error) << map.K();
        EXPECT_LE(found.K_lower, std::min(found.K, map.K()));
        EXPECT_LE(found.K, found.K_max);
        bool averaged = false;
        for (const Bound& bound : found.bounds) {
            if (bound.kind == Bound::Kind::averaged_estimate) {
                averaged = true;
                EXPECT_FALSE(bound.rigorous);
                EXPECT_NEAR(bound.K / map.K(), 1, 0.03);
            }
            EXPECT_EQ(bound.rigorous, bound.kind == Bound::Kind::reich_strebel ||
                                          bound.kind == Bound::Kind::edge_corner || bound.kind == Bound::Kind::moduli ||
                                          bound.kind == Bound::Kind::pair || bound.of == Bound::Of::mesh ||
                                          bound.kind == Bound::Kind::attained);
        }
        EXPECT_TRUE(averaged);
        EXPECT_EQ(found.homotopy.holes[0].turns, turns);
    };
    check(2, 1, 0.005, 0.005);
    check(-1, 0.4, 0.005, 0.005);
}

}  // namespace
}  // namespace beltrami
