#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

Eigen::VectorXcd constant(const Surface& s, Complex nu) {
    return Eigen::VectorXcd::Constant(s.operators.sample_count(), nu);
}

TEST(BeltramiSolver, ReproducesAffineMapsOfAnyCoefficient) {
    for (const Mesh& mesh : {test::jittered_square(8), test::quad_square(6, 0.3), test::mixed_square(7)}) {
        const Surface surface(mesh);
        const Eigen::VectorXcd z = complex_positions(mesh);
        const Complex nu(0.4, -0.35), p(0.8, 0.3);
        const Eigen::VectorXcd exact = p * (z + nu * z.conjugate());
        BoundaryCondition boundary;
        for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, exact[v]);
        BeltramiSolver solver(surface, freedoms(boundary, surface), 1);
        ASSERT_TRUE(solver.decoupled());
        solver.factorize(constant(surface, nu));
        EXPECT_LT((solver.solve(prescribed_values(boundary, surface)) - exact).cwiseAbs().maxCoeff(), 1e-12);
    }
}

TEST(BeltramiSolver, PartlyFreeBoundaryStillReproducesThem) {
    const Mesh mesh = test::jittered_square(8);
    const Surface surface(mesh);
    const Complex nu(-0.2, 0.5);
    const Eigen::VectorXcd exact = complex_positions(mesh) + nu * complex_positions(mesh).conjugate();
    BoundaryCondition two;
    two.pin(0, exact[0]);
    two.pin(40, exact[40]);
    BeltramiSolver solver(surface, freedoms(two, surface), 1);
    ASSERT_FALSE(solver.decoupled());
    solver.factorize(constant(surface, nu));
    EXPECT_LT((solver.solve(prescribed_values(two, surface)) - exact).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(BeltramiSolver, DecoupledAndCoupledFormsAgree) {
    // One interior vertex that slides along a fixed line through its own solution must stay there.
    const Mesh mesh = test::jittered_square(8);
    const Surface surface(mesh);
    const BoundaryCondition boundary =
        test::boundary_values(surface, [](Complex z) { return z * z + 0.5 * std::conj(z); });
    Eigen::VectorXcd nu(surface.operators.sample_count());
    for (int s = 0; s < nu.size(); ++s) nu[s] = std::polar(0.6, 0.37 * s);
    std::vector<Freedom> freedom = freedoms(boundary, surface);
    BeltramiSolver decoupled(surface, freedom, 1);
    decoupled.factorize(nu);
    const Eigen::VectorXcd f = decoupled.solve(prescribed_values(boundary, surface));

    int inner = 0;
    while (surface.topology.on_boundary[inner]) ++inner;
    freedom[inner] = Freedom::sliding;
    BeltramiSolver coupled(surface, freedom, 1);
    ASSERT_FALSE(coupled.decoupled());
    coupled.factorize(nu, Eigen::VectorXcd::Constant(mesh.vertex_count(), std::polar(1.0, 0.8)));
    EXPECT_LT((coupled.solve(f) - f).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT(std::abs(coupled.gradient(f)[inner]), 1e-11);
}

TEST(BeltramiSolver, SolveNearIsTheSameMap) {
    const Surface surface(test::bump(2000));
    const BoundaryCondition boundary = test::boundary_values(surface, test::three_lobes);
    const Eigen::VectorXcd values = prescribed_values(boundary, surface);
    Eigen::VectorXcd nu(surface.operators.sample_count()), near = nu;
    for (int s = 0; s < nu.size(); ++s) {
        nu[s] = std::polar(0.3, 0.01 * s);
        near[s] = std::polar(0.303, 0.01 * s + 0.01);
    }
    BeltramiSolver old(surface, freedoms(boundary, surface), 2), fresh(surface, freedoms(boundary, surface), 2);
    old.factorize(nu);
    const Eigen::VectorXcd f = old.solve(values);
    fresh.factorize(near);
    const Eigen::VectorXcd exact = fresh.solve(values);
    EXPECT_GT((f - exact).cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_LT((old.solve_near(near, values, f) - exact).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_EQ(old.factorization_count(), 1);
    // And far away, with a new factorisation.
    const Eigen::VectorXcd far = -2.5 * near;
    fresh.factorize(far);
    EXPECT_LT((old.solve_near(far, values, f) - fresh.solve(values)).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_EQ(old.factorization_count(), 2);
}

TEST(BeltramiSolver, ANearbySolveDoesNotDependOnWhereTheImageLies) {
    const Surface surface(test::jittered_square(24));
    Eigen::VectorXcd nu(surface.operators.sample_count()), near = nu;
    for (int s = 0; s < nu.size(); ++s) {
        nu[s] = std::polar(0.3, 0.01 * s);
        near[s] = std::polar(0.303, 0.01 * s + 0.01);
    }
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z + 0.2 * z * z; });
    const Eigen::VectorXcd values = prescribed_values(boundary, surface);
    const std::vector<Freedom> freedom = freedoms(boundary, surface);
    BeltramiSolver exact(surface, freedom, 1);
    exact.factorize(near);
    const Eigen::VectorXcd solution = exact.solve(values);
    constexpr double tolerance = 1e-6;
    for (const Complex shift : {Complex(0), Complex(5e3, -2e3)}) {
        BeltramiSolver solver(surface, freedom, 2);
        solver.factorize(nu);
        const Eigen::VectorXcd moved = values.array() + shift, guess = solver.solve(moved);
        const Eigen::VectorXcd found = solver.solve_near(near, moved, guess, tolerance);
        EXPECT_EQ(solver.factorization_count(), 1);
        EXPECT_LT((found.array() - shift - solution.array()).abs().maxCoeff(), 10 * tolerance) << shift;
        for (const int v : boundary.vertices) EXPECT_EQ(found[v], moved[v]);
    }
}

TEST(BeltramiSolver, AnOffsetIsMadeUpFor) {
    // With the offset (∂̄ − ν∂)q the sum f + q is the map that has its boundary values, whatever q is.
    for (const Mesh& mesh : {test::jittered_square(8), test::mixed_square(7)}) {
        const Surface surface(mesh);
        const Complex nu(0.3, -0.2);
        for (const bool whole_boundary : {true, false}) {
            std::vector<Freedom> freedom(mesh.vertex_count(), Freedom::free);
            const auto& loop = surface.topology.boundary_loops[0];
            for (std::size_t i = 0; i < (whole_boundary ? loop.size() : 3); ++i) freedom[loop[i]] = Freedom::fixed;
            BeltramiSolver solver(surface, freedom, 1);
            ASSERT_EQ(solver.decoupled(), whole_boundary);
            solver.factorize(constant(surface, nu));
            const Eigen::VectorXcd values = complex_positions(mesh).unaryExpr([](Complex z) { return z * z * z; });
            const Eigen::VectorXcd q = Eigen::VectorXcd::Random(mesh.vertex_count());
            Eigen::VectorXcd offset(surface.operators.sample_count());
            for (int s = 0; s < offset.size(); ++s) {
                const auto [dz, dzbar] = surface.operators.derivatives(s, q);
                offset[s] = dzbar - nu * dz;
            }
            const Eigen::VectorXcd f = solver.solve(values - q, offset);
            EXPECT_LT((f + q - solver.solve(values)).cwiseAbs().maxCoeff(), 1e-11);
        }
    }
}

TEST(BeltramiSolver, ManyOffsetsAtOnceAreEachOnesSolution) {
    for (const Mesh& mesh : {test::jittered_square(8), test::mixed_square(7)}) {
        const Surface surface(mesh);
        for (const Freedom on_boundary : {Freedom::fixed, Freedom::sliding}) {
            std::vector<Freedom> freedom(mesh.vertex_count(), Freedom::free);
            for (const int v : surface.topology.boundary_loops[0]) freedom[v] = on_boundary;
            freedom[surface.topology.boundary_loops[0][0]] = Freedom::fixed;
            freedom[surface.topology.boundary_loops[0][9]] = Freedom::fixed;
            BeltramiSolver solver(surface, freedom, 1);
            ASSERT_EQ(solver.decoupled(), on_boundary == Freedom::fixed);
            ASSERT_EQ(solver.freedoms(), freedom);
            solver.factorize(constant(surface, {0.3, -0.2}), complex_positions(mesh));
            const Eigen::MatrixXcd offsets = Eigen::MatrixXcd::Random(surface.operators.sample_count(), 9);
            const Eigen::MatrixXcd all = solver.solve_offsets(offsets);
            const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(mesh.vertex_count());
            for (int j = 0; j < offsets.cols(); ++j)
                EXPECT_LT((all.col(j) - solver.solve(zero, offsets.col(j))).cwiseAbs().maxCoeff(),
                          1e-12 * all.cwiseAbs().maxCoeff());
        }
    }
}

TEST(BeltramiSolver, PoissonsEquationIsSolved) {
    const Mesh mesh = disk(24);
    const Surface surface(mesh);
    const Operators& operators = surface.operators;
    std::vector<Freedom> freedom(mesh.vertex_count(), Freedom::free);
    for (const int v : surface.topology.boundary_loops[0]) freedom[v] = Freedom::fixed;
    BeltramiSolver solver(surface, freedom, 1);
    solver.factorize(constant(surface, 0));

    // −Δu = 1 on the unit disk has u = (1 − |z|²)/4.
    Eigen::VectorXd load = Eigen::VectorXd::Zero(mesh.vertex_count());
    for (int s = 0; s < operators.sample_count(); ++s)
        for (const int v : operators.stencil(s)) load[v] += operators.weights[s] / 3;
    const Eigen::VectorXd exact = 0.25 * (1 - complex_positions(mesh).array().abs2());
    EXPECT_LT((solver.solve_poisson(load) - exact).cwiseAbs().maxCoeff(), 1e-3);

    // Any function of the mesh comes back from its own ∫ ∇u·∇v.
    Eigen::VectorXd u = Eigen::VectorXd::Random(mesh.vertex_count());
    for (const int v : surface.topology.boundary_loops[0]) u[v] = 0;
    load.setZero();
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto v = operators.stencil(s);
        const auto g = operators.gradient(s);
        Complex gradient = 0;
        for (int j = 0; j < 3; ++j) gradient += u[v[j]] * g[j];
        for (int j = 0; j < 3; ++j) load[v[j]] += operators.weights[s] * std::real(std::conj(gradient) * g[j]);
    }
    EXPECT_LT((solver.solve_poisson(load) - u).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(BeltramiSolver, NamesVerticesThatNothingHolds) {
    // Two squares side by side; only the first is pinned.
    Mesh mesh = test::jittered_square(3), both = mesh;
    both.positions.resize(32, 2);
    both.positions.topRows(16) = mesh.positions;
    both.positions.bottomRows(16) = mesh.positions.rowwise() + Eigen::RowVector2d(3, 0);
    for (int f = 0; f < mesh.face_count(); ++f)
        both.faces.add({mesh.faces[f][0] + 16, mesh.faces[f][1] + 16, mesh.faces[f][2] + 16});
    const Surface surface(both);
    BoundaryCondition pins;
    pins.pin(0, 0.0);
    pins.pin(3, 1.0);
    BeltramiSolver solver(surface, freedoms(pins, surface), 1);
    try {
        solver.factorize(constant(surface, 0.0));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        ASSERT_FALSE(error.indices().empty());
        for (const int v : error.indices()) EXPECT_GE(v, 16);
    }
}

TEST(Harmonic, IsSecondOrderAccurate) {
    // Re z³ and Im z⁴ on the disk, from boundary values.
    double last = 0;
    for (const int triangles : {1000, 4000, 16000}) {
        const Mesh mesh = disk(disk_rings_for_triangles(triangles));
        const Surface surface(mesh);
        const auto exact = [](Complex z) { return Complex(std::real(z * z * z), std::imag(z * z * z * z)); };
        const Eigen::VectorXcd f = harmonic_map(surface, test::boundary_values(surface, exact));
        double error = 0;
        for (int v = 0; v < mesh.vertex_count(); ++v)
            error = std::max(error, std::abs(f[v] - exact(complex_positions(mesh)[v])));
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.7);
        }
        last = error;
    }
}

TEST(Harmonic, RefusesMissingAndWrongValues) {
    const Surface surface(test::jittered_square(4));
    BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
    const auto cause_of = [&](const BoundaryCondition& b) {
        try {
            harmonic_map(surface, b);
        } catch (const Error& error) {
            return error.cause();
        }
        return Cause::cancelled;
    };
    BoundaryCondition b = boundary;
    b.vertices.pop_back();
    b.images.pop_back();
    EXPECT_EQ(cause_of(b), Cause::bad_boundary);
    b = boundary;
    b.pin(b.vertices[0], 0.0);
    EXPECT_EQ(cause_of(b), Cause::bad_boundary);
    b = boundary;
    b.vertices[2] = 1000;
    EXPECT_EQ(cause_of(b), Cause::bad_boundary);
    b = boundary;
    b.images[2] = {0, std::nan("")};
    EXPECT_EQ(cause_of(b), Cause::bad_boundary);
}

TEST(Lscm, ReproducesSimilaritiesAndIsFreeToPin) {
    const Mesh mesh = test::jittered_square(7);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = complex_positions(mesh);
    BoundaryCondition pins;
    pins.pin(3, Complex(0, 2) * z[3] + 1.0);
    pins.pin(50, Complex(0, 2) * z[50] + 1.0);
    EXPECT_LT(
        (least_squares_conformal_map(surface, pins) - (Complex(0, 2) * z.array() + 1.0).matrix()).cwiseAbs().maxCoeff(),
        1e-10);
    EXPECT_LT(distortion(surface.operators, least_squares_conformal_map(surface, {})).max, 1e-10);
    BoundaryCondition one;
    one.pin(3, 1.0);
    EXPECT_THROW(least_squares_conformal_map(surface, one), Error);
}

}  // namespace
}  // namespace beltrami
