#include <beltrami/teichmuller/quadratic_products.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The map whose K* is 3, from φ = 1 and k = 0.3, which are not its own.
QuadraticProducts of_exact_composition(int rings, QuadraticProductsOptions options = {}) {
    const Surface surface(disk(rings));
    const BoundaryCondition boundary = test::boundary_values(surface, test::exact_composition);
    const Eigen::VectorXcd phi = Eigen::VectorXcd::Ones(surface.operators.sample_count());
    options.tolerance = 1e-3;
    options.max_iterations = 30;
    return quadratic_products(surface, boundary, harmonic_map(surface, boundary), phi, 0.3, options);
}

TEST(QuadraticProducts, TendToAKnownMapWithTheThirdPowerOfTheEdges) {
    double last = 0;
    for (const int rings : {12, 24}) {
        const QuadraticProducts found = of_exact_composition(rings);
        EXPECT_TRUE(found.settled);
        ASSERT_TRUE(found.integrals.valid);
        EXPECT_EQ(found.held, 0);
        EXPECT_FALSE(found.integrals.resolved);  // an estimate: φ is tabulated
        EXPECT_LE(found.integrals.lower, found.integrals.estimate);
        EXPECT_LE(found.integrals.estimate, found.integrals.upper);
        const double error = std::abs(found.integrals.estimate - 3);
        if (last > 0) {
            EXPECT_LT(error, last / 8);
        }
        last = error;
    }
    EXPECT_LT(last, 3e-4);  // with linear elements on the same mesh 1/I⁻ of the map itself is 2.9949
}

TEST(QuadraticProducts, PhiIsGivenAtTheTriangles) {
    const int rings = 16;
    const Surface surface(disk(rings));
    const QuadraticProducts found = of_exact_composition(rings);
    ASSERT_EQ(found.phi.size(), surface.mesh.face_count());
    ASSERT_EQ(found.space->tabulated()->rows(), surface.mesh.face_count());
    EXPECT_NEAR(found.direction.norm(), 1, 1e-12);
    // φ = g′² = (1 + 0.6 z)² up to a factor, in the frames of a planar mesh.
    Complex along = 0;
    double size = 0, exact_size = 0;
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
        Complex z = 0;
        for (const int v : surface.operators.stencil(f)) z += (*surface.coordinate())[v] / 3.0;
        const Complex exact = (1.0 + 0.6 * z) * (1.0 + 0.6 * z);
        along += surface.operators.weights[f] * std::conj(exact) * found.phi[f];
        size += surface.operators.weights[f] * std::norm(found.phi[f]);
        exact_size += surface.operators.weights[f] * std::norm(exact);
    }
    EXPECT_GT(std::real(along), (1 - 1e-3) * std::sqrt(size * exact_size));
}

TEST(QuadraticProducts, WhatIsHeldHasToBeLittle) {
    QuadraticProductsOptions options;
    options.clip = 0.4;  // of a map with |μ| = ½
    const QuadraticProducts found = of_exact_composition(8, options);
    EXPECT_GT(found.held, 0.5);
    EXPECT_FALSE(found.integrals.valid);
}

TEST(QuadraticProducts, CanBeCancelled) {
    QuadraticProductsOptions options;
    options.progress = [](int step, double) { return step < 2; };
    EXPECT_THROW(of_exact_composition(8, options), Error);
}

}  // namespace
}  // namespace beltrami
