#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/frames.h>
#include <beltrami/targets/simple_targets.h>

#include "problems/prescribed_coefficients.h"

namespace beltrami {
namespace {

/// The disk of Wong & Zhao's Table 5.1: μ = kz at barycentres, 0 and 1 held, the rest of the rim slides.
struct DiskProblem {
    Surface source;
    PlaneTarget target;
    TargetConstraints constraints;
    Eigen::VectorXcd mu;

    DiskProblem(int levels, double k) : source(bench::disk_of_square(levels)), mu(source.operators.sample_count()) {
        constraints.fixed = {0, 1};
        std::vector<int> rim;
        for (const int v : source.topology.boundary_loops[0])
            if (v != 1) rim.push_back(v);
        constraints.slide(rim, std::make_shared<PlanarSlideCurve>(TargetCurve::circle(0, 1)));
        const Eigen::VectorXcd& z = *source.coordinate();
        for (int s = 0; s < mu.size(); ++s) {
            const auto v = source.operators.stencil(s);
            mu[s] = k * (z[v[0]] + z[v[1]] + z[v[2]]) / 3.0;
        }
    }
    SurfaceFlowMap flow(const SurfaceFlowOptions& options) const {
        return surface_flow(source, target, mu, constraints,
                            target_map(source, target, constraints, source.mesh.positions), options);
    }
};

/// The sphere of Table 5.2: a constant coefficient in the stereographic coordinate, or that of the interpolated exact
/// map; the images of 0, 1 and infinity are held.
struct SphereProblem {
    static constexpr Complex kMu{0.3, 0.3};
    Surface source;
    SphereTarget target;
    TargetConstraints constraints;
    Positions exact;

    explicit SphereProblem(int levels)
        : source(octahedral_sphere(levels)), exact(bench::stretched_sphere(source.mesh.positions, kMu)) {
        constraints.fixed = {0, 4, 5};
    }
    SurfaceFlowMap flow(const Eigen::VectorXcd& mu, const SurfaceFlowOptions& options) const {
        return surface_flow(source, target, mu, constraints,
                            target_map(source, target, constraints, source.mesh.positions), options);
    }
    double vertex_error(const SurfaceFlowMap& flow) const {
        return (positions_of(flow.map.points) - exact).rowwise().norm().maxCoeff();
    }
};

SurfaceFlowOptions by(FlowScheme scheme, double tolerance = 1e-8) {
    SurfaceFlowOptions options;
    options.scheme = scheme;
    options.tolerance = tolerance;
    options.least_decrease = 0;
    return options;
}

TEST(DiskStretch, HasItsCoefficientAndKeepsTheCircle) {
    const bench::DiskStretch f(0.6);
    EXPECT_LT(f.residual(), 1e-12);
    EXPECT_LT(std::abs(f(Complex(0, 1)) - Complex(0.854224976237, 0.519903539104)), 1e-11);
    const Complex z(0.3, 0.4);
    EXPECT_LT(std::abs(f(z) - Complex(0.561294187411, 0.300369571141)), 1e-11);
    const double h = 1e-5;
    const Complex fx = (f(z + h) - f(z - h)) / (2 * h), fy = (f(z + Complex(0, h)) - f(z - Complex(0, h))) / (2 * h);
    const Complex i(0, 1);
    EXPECT_LT(std::abs((fx + i * fy) / (fx - i * fy) - 0.6 * z), 1e-9);
}

/// Wong & Zhao's Table 5.1 has unrooted errors .0458, .0176, .0052, .0013 after 12, 13, 12, 10 steps there.
TEST(SurfaceFlow, ReachesTheErrorsOfTheDiskTable) {
    const std::array<double, 6> theirs{0.0800, 0.0813, 0.0458, 0.0176, 0.0052, 0.0013};
    const std::array<int, 6> their_steps{4, 12, 12, 13, 12, 10};
    const bench::DiskStretch exact(0.6);
    double coarser = 0;
    for (int level = 0; level < 6; ++level) {
        const DiskProblem problem(level, 0.6);
        const SurfaceFlowMap flow = problem.flow(by(FlowScheme::perturbation));
        EXPECT_EQ(flow.termination, Termination::converged);
        EXPECT_TRUE(flow.distortion.flipped.empty());
        EXPECT_LE(flow.history.back().squared_error, 1.001 * theirs[level]) << level;
        EXPECT_LE(flow.iterations, their_steps[level] + 3) << level;
        double error = 0;
        for (int v = 0; v < problem.source.mesh.vertex_count(); ++v) {
            const Eigen::Vector3d& there = flow.map.points[v].position;
            error = std::max(error, std::abs(Complex(there.x(), there.y()) - exact((*problem.source.coordinate())[v])));
        }
        if (level == 5) {
            EXPECT_GT(std::log2(coarser / error), 1.65);
        }
        coarser = error;
    }
}

/// The other schemes make another error small, of the same size.
TEST(SurfaceFlow, TheBarrierHasTheSameLimit) {
    const DiskProblem problem(4, 0.6);
    const SurfaceFlowMap barrier = problem.flow(by(FlowScheme::barrier)),
                         perturbation = problem.flow(by(FlowScheme::perturbation));
    EXPECT_LT(barrier.history.back().squared_error, perturbation.history.back().squared_error);
    EXPECT_LT((positions_of(barrier.map.points) - positions_of(perturbation.map.points)).rowwise().norm().maxCoeff(),
              0.05);
}

/// Table 5.2: .1145, .0412, .0138 at levels 3, 4, 5.
TEST(SurfaceFlow, ReachesTheErrorsOfTheSphereTable) {
    const std::array<double, 3> theirs{0.1145, 0.0412, 0.0138};
    for (int level = 3; level < 6; ++level) {
        const SphereProblem problem(level);
        const Eigen::VectorXcd mu = mu_at_samples(
            problem.source, Eigen::VectorXcd::Constant(problem.source.mesh.face_count(), SphereProblem::kMu),
            CoefficientFrame::stereographic);
        const SurfaceFlowMap flow = problem.flow(mu, by(FlowScheme::perturbation, 1e-5));
        EXPECT_LE(flow.history.back().squared_error, 1.3 * theirs[level - 3]) << level;
        EXPECT_TRUE(flow.distortion.flipped.empty());
    }
}

/// A map is found again from its coefficient alone, at any level, by every scheme.
TEST(SurfaceFlow, FindsAMapOfTheSphereAgainInSixSteps) {
    for (const FlowScheme scheme : {FlowScheme::perturbation, FlowScheme::residual, FlowScheme::barrier})
        for (int level = 0; level < 5; ++level) {
            const SphereProblem problem(level);
            SurfaceFlowOptions options = by(scheme, 1e-9);
            options.max_iterations = 6;
            const Eigen::VectorXcd mu = beltrami_coefficient(problem.source.operators, problem.exact, problem.exact);
            const SurfaceFlowMap flow = problem.flow(mu, options);
            EXPECT_LT(problem.vertex_error(flow), 1e-9) << to_string(scheme) << level;
            EXPECT_LT(flow.error.sup, 1e-8);
        }
}

TEST(SurfaceFlow, RefusesWhatItCannotUse) {
    const SphereProblem problem(1);
    const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(problem.source.operators.sample_count());
    const auto cause_of = [&](const Eigen::VectorXcd& mu, const SurfaceFlowOptions& options) {
        try {
            problem.flow(mu, options);
        } catch (const Error& error) {
            return error.cause();
        }
        return Cause::cancelled;
    };
    EXPECT_EQ(cause_of(none.head(3), {}), Cause::bad_option);
    EXPECT_EQ(cause_of(Eigen::VectorXcd::Constant(none.size(), 1), {}), Cause::bad_option);
    SurfaceFlowOptions options;
    options.tolerance = 0;
    EXPECT_EQ(cause_of(none, options), Cause::bad_option);
    TargetConstraints twice = problem.constraints;
    twice.fixed.push_back(4);
    EXPECT_THROW(target_map(problem.source, problem.target, twice, problem.exact), Error);
    Positions folded = problem.source.mesh.positions;
    folded.row(6) = -folded.row(6);
    EXPECT_THROW(
        surface_flow(problem.source, problem.target, none, problem.constraints,
                     target_map(problem.source, problem.target, problem.constraints, folded), by(FlowScheme::barrier)),
        Error);
}

TEST(Frames, StereographicCoefficientsNeedTheUnitSphere) {
    const Surface source(octahedral_sphere(1, 2));
    EXPECT_THROW(
        mu_at_samples(source, Eigen::VectorXcd::Zero(source.mesh.face_count()), CoefficientFrame::stereographic),
        Error);
}

}  // namespace
}  // namespace beltrami
