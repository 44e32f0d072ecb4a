#include <beltrami/teichmuller/crowding.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/generate/grids.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {
namespace {

/// A strip of height 1, rolled up a little: a chart shrinks its ends like e^(-width π/2).
Surface strip(int width, int cells = 8) {
    Mesh mesh = rectangle(width, 1, cells * width, cells);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), 0.02 * flat(v, 0) * flat(v, 0);
    return Surface(std::move(mesh));
}

TEST(Crowding, OfLongStripsByArcLength) {
    for (const auto& [width, crowds] : {std::pair(2, false), {4, false}, {14, true}}) {
        const Surface source = strip(width);
        const Eigen::VectorXcd harmonic = harmonic_map(source, boundary_to_disk(source, 0));
        EXPECT_EQ(values_crowd(source, round_disk_chart(source), harmonic), crowds) << width;
    }
}

TEST(Crowding, ProductsAreOrthonormalAndSquaresOfHolomorphicForms) {
    const Surface source = strip(2, 24);
    const BeltramiSolver solver = dirichlet_solver(source);
    const Eigen::VectorXcd harmonic = harmonic_map(source, boundary_to_disk(source, 0));
    const TabulatedSpace space = form_product_space(source, solver, harmonic);
    ASSERT_TRUE(space.complex_coefficients());
    EXPECT_GT(space.size(), 10);
    const Eigen::MatrixXcd& values = *space.tabulated();
    const auto areas = Eigen::Map<const Eigen::VectorXd>(source.operators.weights.data(), values.rows());
    const Eigen::MatrixXcd gram = values.adjoint() * areas.asDiagonal() * values;
    EXPECT_LT((gram - Eigen::MatrixXcd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), 1e-10);
    // Holomorphic: nothing pairs with ∂̄V, V vanishing on the boundary, but what the mesh leaves over.
    Eigen::VectorXcd V(source.operators.vertex_count);
    for (int v = 0; v < V.size(); ++v) {
        const double x = source.mesh.positions(v, 0) / 2, y = source.mesh.positions(v, 1);
        V[v] = Complex(1, 0.5) * std::sin(3 * x) * x * (1 - x) * y * (1 - y);
    }
    Eigen::VectorXcd dbar(values.rows());
    double size = 0;
    for (int s = 0; s < values.rows(); ++s) {
        dbar[s] = source.operators.derivatives(s, V)[1];
        size += areas[s] * std::norm(dbar[s]);
    }
    const Eigen::VectorXcd pairing = values.transpose() * areas.asDiagonal() * dbar;
    EXPECT_LT(pairing.cwiseAbs().maxCoeff(), 0.2 * std::sqrt(size));
}

TEST(Crowding, TheExtremalMapIsEven) {
    const Surface source = strip(14);
    const ExtremalMap result = extremal_map(source, boundary_to_disk(source, 0.3));
    EXPECT_TRUE(result.one_to_one());
    EXPECT_FALSE(result.in_chart);
    EXPECT_TRUE(result.differential.tabulated());
    EXPECT_GE(result.K, result.K_lower_proved);
    EXPECT_GT(result.K_lower_proved, 3);
    EXPECT_LT(result.K, 1.1 * result.K_lower);
    EXPECT_LT(result.distortion.standard_deviation, 0.08);
}

}  // namespace
}  // namespace beltrami
