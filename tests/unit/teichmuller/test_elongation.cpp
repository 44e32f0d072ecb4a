#include <beltrami/teichmuller/elongation.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

std::array<int, 4> corners_of(int n) {
    return {0, n, (n + 1) * (n + 1) - 1, n * (n + 1)};
}

/// A square with a bump in space: the stretch of its image sets the scale, the bump the shape.
Surface bumpy_square(int n) {
    Mesh mesh = test::jittered_square(n);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v) {
        const double x = flat(v, 0), y = flat(v, 1);
        mesh.positions.row(v) << x, y, 0.3 * std::exp(-8 * ((x - 0.6) * (x - 0.6) + (y - 0.4) * (y - 0.4)));
    }
    return Surface(std::move(mesh));
}

TEST(Elongation, OnlyWhatIsStretchedThroughout) {
    const Surface source = bumpy_square(12);
    for (const auto& [width, elongated] : {std::pair(1.0, false), {5.0, false}, {10.0, true}, {1000.0, true}}) {
        const Eigen::VectorXcd harmonic = harmonic_map(source, boundary_to_rectangle(source, width, 1, corners_of(12)));
        EXPECT_EQ(is_elongated(source.operators, harmonic), elongated) << width;
        const double clip = clip_of_elongated(source.operators, harmonic);
        EXPECT_GE(clip, 0.95);
        EXPECT_LE(clip, 0.9999);
    }
}

/// K* ≥ (W/H)/D' with D' the energy of the function 0 and 1 on the long sides, which runs straight along the others at
/// best: any D' of an admissible function will do, for instance that of the harmonic map's imaginary part.
TEST(Elongation, LongRectanglesReachTheModulusBound) {
    const Surface source = bumpy_square(12);
    for (const double width : {20.0, 100.0}) {
        const BoundaryCondition boundary = boundary_to_rectangle(source, width, 1, corners_of(12));
        const ExtremalMap result = extremal_map(source, boundary);
        double energy = 0;  // of the imaginary part
        for (int s = 0; s < source.operators.sample_count(); ++s) {
            const auto [dz, dzbar] = source.operators.derivatives(s, result.harmonic);
            energy += source.operators.weights[s] * std::norm(dz - std::conj(dzbar));
        }
        const double bound = width / energy;
        EXPECT_TRUE(result.one_to_one());
        EXPECT_NEAR(result.K, bound, 0.005 * bound);
        EXPECT_NEAR(result.K_lower, bound, 0.005 * bound);
        EXPECT_LE(result.iterations, 12);
        EXPECT_LT(result.distortion.standard_deviation, 2e-3);
    }
}

}  // namespace
}  // namespace beltrami
