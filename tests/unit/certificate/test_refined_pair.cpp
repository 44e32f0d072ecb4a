#include <beltrami/certificate/refined_pair.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/certificate/refined_problem.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/dirichlet_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// A square of which all but a cell at the middle of one side is stretched: a corner of 3π/2 at each end of the step.
BoundaryCondition stepped(const Surface& source) {
    return test::boundary_values(source, [](Complex z) {
        const double down = z.imag() == 0 ? 0.3 * std::max(0.0, 0.5 - 2 * std::abs(z.real() - 0.5)) : 0.0;
        return Complex(2 * z.real(), z.imag() + down);
    });
}

TEST(RefinedPair, AnAffineMapLeavesNothingToRefine) {
    const Surface source(test::jittered_square(6));
    const auto stretch = [](Complex z) { return Complex(2.5 * z.real() + 0.4 * z.imag(), z.imag()); };
    const Eigen::VectorXcd map = test::complex_positions(source.mesh).unaryExpr(stretch);
    const RefinedPair pair = refined_pair_bound(source, test::boundary_values(source, stretch), map);
    const double K = distortion(source.operators, map).max_dilatation();
    EXPECT_NEAR(pair.K, K, 1e-9 * K);
    EXPECT_EQ(pair.rounds, 0);
    EXPECT_EQ(pair.faces, source.mesh.face_count());
}

TEST(RefinedPair, ProvesAsMuchAsUniformRefinementWithFewerFaces) {
    const Surface source(test::jittered_square(12));
    const BoundaryCondition boundary = stepped(source);
    const Eigen::VectorXcd map = dirichlet_solver(source).solve(prescribed_values(boundary, source));
    ASSERT_TRUE(image_under(source, map));
    RefinedProblem uniform{source, boundary, {}};
    Eigen::VectorXcd on_uniform = map;
    for (int level = 0; level < 2; ++level) {
        RefinedProblem finer = refined_problem(uniform.surface, uniform.boundary);
        on_uniform = finer.interpolated(on_uniform);
        uniform = std::move(finer);
    }
    const double wanted = pair_bound(uniform.surface, *image_under(uniform.surface, on_uniform)).K;
    RefinedPairOptions options;
    options.enough = wanted;
    const RefinedPair pair = refined_pair_bound(source, boundary, map, options);
    EXPECT_GE(pair.K, (1 - 2e-3) * wanted);  // less than that is not refined for
    EXPECT_GT(wanted, pair_bound(source, *image_under(source, map)).K + 0.01);
    EXPECT_LT(pair.faces, uniform.surface.mesh.face_count() / 2);
    EXPECT_LT(pair.K, distortion(source.operators, map).max_dilatation());
    // It goes no further than it has to, and no further than it may.
    options.enough = 1;
    EXPECT_EQ(refined_pair_bound(source, boundary, map, options).rounds, 0);
    options = {};
    options.most_faces = 600;
    const RefinedPair few = refined_pair_bound(source, boundary, map, options);
    EXPECT_GT(few.rounds, 0);
    EXPECT_LT(few.faces, 4 * 600);
}

TEST(RefinedPair, OfAFoldedMapThePolygonIsTriangulated) {
    const Surface source(disk(8));
    const BoundaryCondition boundary = test::boundary_values(source, test::exact_composition);
    Eigen::VectorXcd map =
        test::complex_positions(source.mesh).unaryExpr([](Complex z) { return test::exact_composition(z); });
    map[0] += 3;  // the centre
    ASSERT_FALSE(image_under(source, map));
    RefinedPairOptions options;
    options.most_faces = 2'000;
    const RefinedPair pair = refined_pair_bound(source, boundary, map, options);
    EXPECT_GT(pair.K, pair_bound(source, *filled_image(source, map)).K);
    EXPECT_LT(pair.K, 3.0292);  // verified from above for these polygons
    EXPECT_GT(pair.K, 2.95);
}

}  // namespace
}  // namespace beltrami
