#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/distortion_energy.h>
#include <beltrami/unfold/fold_free.h>

#include "../baselines/baseline_shapes.h"

namespace beltrami {
namespace {

using namespace baseline_tests;
using Curvature = DistortionEnergy::Curvature;

Eigen::VectorXcd zero_coefficient(const Surface& source) {
    return Eigen::VectorXcd::Zero(source.operators.sample_count());
}

/// A coefficient without symmetry, |ν| ≤ .6.
Eigen::VectorXcd some_coefficient(const Surface& source) {
    Eigen::VectorXcd nu(source.operators.sample_count());
    for (Eigen::Index s = 0; s < nu.size(); ++s) nu[s] = std::polar(0.35 + 0.25 * std::sin(2.0 * s), 0.7 * s);
    return nu;
}

/// A map without symmetry; folded for large amounts.
Eigen::VectorXcd shaken(const Surface& source, double amount) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-amount, amount);
    Eigen::VectorXcd f = points(source.mesh);
    for (Eigen::Index v = 0; v < f.size(); ++v) {
        const double x = uniform(random), y = uniform(random);
        f[v] = Complex(1.3, 0.4) * f[v] + 0.2 * std::conj(f[v]) + Complex(x, y);
    }
    return f;
}

// ---- the energy -----------------------------------------------------------------------------------------------------

TEST(DistortionTerm, IsTheMipsTermWithoutRegularisation) {
    for (const auto& [r, s] : std::vector<std::array<double, 2>>{{1, 0}, {2, 1}, {1, 0.99}, {0.3, 0.1}})
        EXPECT_NEAR(distortion_term(r, s, {}).value, (r * r + s * s) / (r * r - s * s), 1e-12 * r * r / (r - s));
    EXPECT_DOUBLE_EQ(distortion_term(1.7, 0, {}).value, 1);
}

TEST(DistortionTerm, DerivativesAgreeWithDifferences) {
    const double h = 1e-5;
    for (const auto& [epsilon, area] :
         std::vector<std::array<double, 2>>{{0, 0}, {0.01, 0}, {0.5, 0}, {0.5, 0.3}, {2, 1}})
        for (const auto& [r, s] : std::vector<std::array<double, 2>>{{1, 0.4}, {1.5, 1.2}, {0.6, 0.7}, {0.2, 1.1}}) {
            if (epsilon == 0 && r <= s) continue;
            if (epsilon == 0.01 && r < s) continue;  // differences are useless where q bends within h
            const auto at = [e = epsilon, l = area](double x, double y) { return distortion_term(x, y, {e, l}); };
            const DistortionTerm q = at(r, s), right = at(r + h, s), left = at(r - h, s), up = at(r, s + h),
                                 down = at(r, s - h);
            const auto expect = [&](double derivative, double difference, const char* which) {
                EXPECT_NEAR(derivative, difference, 1e-6 * (1 + std::abs(derivative)))
                    << which << ' ' << r << ' ' << s << ' ' << epsilon;
            };
            expect(q.r, (right.value - left.value) / (2 * h), "r");
            expect(q.s, (up.value - down.value) / (2 * h), "s");
            expect(q.rr, (right.r - left.r) / (2 * h), "rr");
            expect(q.ss, (up.s - down.s) / (2 * h), "ss");
            expect(q.rs, (up.r - down.r) / (2 * h), "rs");
            expect(q.around_a, q.r / r, "around a");
            expect(q.around_b, q.s / s, "around b");
        }
}

TEST(DistortionTerm, KeepsItsDigitsInDeepFolds) {
    // χ = ε²/(2(√(ε²+D²) − D)): for D = −1 and small ε, q → 4 (r² + s²) |D| / ε².
    const DistortionTerm q = distortion_term(0, 1, {1e-9, 0});
    EXPECT_NEAR(q.value / 4e18, 1, 1e-12);
    EXPECT_TRUE(std::isfinite(q.rr) && std::isfinite(q.ss) && std::isfinite(q.around_a));
}

class Energy : public testing::TestWithParam<bool> {
  protected:
    Surface source_{square(4, GetParam())};
};

TEST_P(Energy, IsOneForMapsWithTheCoefficient) {
    const Complex nu(0.3, -0.4);
    const Eigen::VectorXcd z = points(source_.mesh);
    Eigen::VectorXcd f(z.size());
    for (Eigen::Index v = 0; v < z.size(); ++v) f[v] = Complex(2, 5) * (z[v] + nu * std::conj(z[v])) + Complex(1, 1);
    for (const double power : {1.0, 2.0, 50.0}) {
        const DistortionEnergy energy(source_.operators,
                                      Eigen::VectorXcd::Constant(source_.operators.sample_count(), nu), power);
        EXPECT_NEAR(energy.value(f, {}).mean, 1, 1e-12);
        EXPECT_GT(energy.value(z, {}).mean, 1.1);
    }
}

TEST_P(Energy, GradientAgreesWithDifferences) {
    const Eigen::VectorXcd f = shaken(source_, 0.05), folded = shaken(source_, 0.3);
    for (const double power : {1.0, 3.0, 20.0})
        for (const double epsilon : {0.0, 0.3}) {
            const DistortionEnergy energy(source_.operators, some_coefficient(source_), power);
            const Eigen::VectorXcd& at = epsilon > 0 ? folded : f;
            ASSERT_EQ(energy.value(at, {epsilon, 0}).smallest_determinant<0, epsilon> 0);
            const Eigen::VectorXcd gradient = energy.gradient(at, {epsilon, 0});
            const double size = gradient.cwiseAbs().maxCoeff(), h = 1e-6;
            ASSERT_GT(size, 0);
            for (Eigen::Index v = 0; v < at.size(); ++v)
                for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
                    Eigen::VectorXcd right = at, left = at;
                    right[v] += h * direction;
                    left[v] -= h * direction;
                    const double difference =
                        (energy.value(right, {epsilon, 0}).mean - energy.value(left, {epsilon, 0}).mean) / (2 * h);
                    EXPECT_NEAR(std::real(std::conj(direction) * gradient[v]), difference, 1e-6 * size)
                        << v << ' ' << power << ' ' << epsilon;
                }
        }
}

Eigen::MatrixXd full(const DistortionEnergy::Element& e) {
    Eigen::MatrixXd matrix(e.unknowns, e.unknowns);
    int slot = 0;
    for (int i = 0; i < e.unknowns; ++i)
        for (int j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = e.hessian[slot++];
    return matrix;
}

TEST_P(Energy, ExactHessianAgreesWithDifferencesOfTheGradient) {
    // With p = 1 a sample's gradient depends on nothing else.
    const DistortionEnergy energy(source_.operators, some_coefficient(source_), 1);
    for (const double epsilon : {0.0, 0.3}) {
        const Eigen::VectorXcd f = shaken(source_, epsilon > 0 ? 0.3 : 0.05);
        const auto at = energy.value(f, {epsilon, 0});
        for (int s = 0; s < source_.operators.sample_count(); ++s) {
            const Eigen::MatrixXd hessian = full(energy.element(s, f, {epsilon, 0}, at, Curvature::exact));
            const double h = 1e-6;
            for (int j = 0; j < hessian.cols(); ++j) {
                Eigen::VectorXcd right = f, left = f;
                const Complex direction = j % 2 ? Complex(0, 1) : Complex(1, 0);
                right[source_.operators.stencil(s)[j / 2]] += h * direction;
                left[source_.operators.stencil(s)[j / 2]] -= h * direction;
                const auto ahead = energy.element(s, right, {epsilon, 0}, at, Curvature::exact);
                const auto behind = energy.element(s, left, {epsilon, 0}, at, Curvature::exact);
                for (int i = 0; i < hessian.rows(); ++i)
                    EXPECT_NEAR(hessian(i, j), (ahead.gradient[i] - behind.gradient[i]) / (2 * h),
                                1e-5 * hessian.cwiseAbs().maxCoeff());
            }
        }
    }
}

TEST_P(Energy, ProjectedHessianIsSemidefiniteAndNoSmallerThanTheExactOne) {
    for (const double epsilon : {0.0, 0.1}) {
        const Eigen::VectorXcd f = shaken(source_, epsilon > 0 ? 0.3 : 0.05);
        const DistortionEnergy energy(source_.operators, some_coefficient(source_), 1);
        const auto at = energy.value(f, {epsilon, 0});
        int indefinite = 0;
        for (int s = 0; s < source_.operators.sample_count(); ++s) {
            const Eigen::MatrixXd projected = full(energy.element(s, f, {epsilon, 0}, at, Curvature::projected));
            const Eigen::MatrixXd exact = full(energy.element(s, f, {epsilon, 0}, at, Curvature::exact));
            const auto smallest = [](const Eigen::MatrixXd& m) { return symmetric_eigen(m).values[0]; };
            const double size = exact.cwiseAbs().maxCoeff();
            EXPECT_GE(smallest(projected), -1e-12 * size);
            EXPECT_GE(smallest(projected - exact), -1e-12 * size);
            indefinite += smallest(exact) < -1e-6 * size;
            if ((projected - exact).norm() > 1e-6 * size) {
                EXPECT_LT(smallest(exact), 0) << "a semidefinite one was changed";
            }
        }
        EXPECT_GT(indefinite, source_.operators.sample_count() / 2) << "nothing was projected";
    }
}

TEST_P(Energy, StepToFoldIsWhereTheFirstSampleCollapses) {
    const Eigen::VectorXcd f = points(source_.mesh), d = shaken(source_, 0.6) - 1.2 * f;
    const DistortionEnergy energy(source_.operators, some_coefficient(source_), 1);
    const double t = energy.step_to_fold(f, d);
    ASSERT_TRUE(std::isfinite(t));
    EXPECT_GT(energy.value(f + 0.999 * t * d, {}).smallest_determinant, 0);
    EXPECT_LT(energy.value(f + 1.001 * t * d, {1, 0}).smallest_determinant, 0);
    EXPECT_FALSE(energy.value(f + 1.001 * t * d, {}).finite());
    // Growing never folds.
    EXPECT_EQ(energy.step_to_fold(f, f), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(energy.step_to_fold(f, -f), 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(TrianglesAndQuads, Energy, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Quads" : "Triangles"; });

// ---- untangling -----------------------------------------------------------------------------------------------------

struct Lobes {
    Surface source{ringed_disk(27)};  // 4374 triangles
    BoundaryCondition boundary = prescribe(source, three_lobes);
    Eigen::VectorXcd harmonic = harmonic_map(source, boundary);
};

TEST(FoldFreeMap, UntanglesTheHarmonicMapToThreeLobes) {
    const Lobes lobes;
    ASSERT_GT(distortion(lobes.source.operators, lobes.harmonic).flipped.size(), 100u);
    const FoldFreeMap result = fold_free_map(lobes.source, freedoms(lobes.boundary, lobes.source),
                                             zero_coefficient(lobes.source), lobes.harmonic);
    EXPECT_EQ(result.status, FoldFreeStatus::converged);
    EXPECT_TRUE(result.fold_free);
    const Distortion d = distortion(lobes.source.operators, result.map);
    EXPECT_TRUE(d.flipped.empty());
    EXPECT_LT(d.max, 0.5);
    for (std::size_t i = 0; i < lobes.boundary.vertices.size(); ++i)
        EXPECT_EQ(result.map[lobes.boundary.vertices[i]], lobes.boundary.images[i]);
    EXPECT_LE(result.iterations, 40);
    EXPECT_LE(result.factorizations, 50);
    ASSERT_EQ(static_cast<int>(result.history.size()), result.iterations + 1);
    EXPECT_GT(result.history.front().epsilon, 0);
    EXPECT_EQ(result.history.back().epsilon, 0);
    // Once it is free of folds it stays so, and the energy falls.
    for (std::size_t i = 1; i < result.history.size(); ++i)
        if (result.history[i - 1].epsilon == 0) {
            EXPECT_GT(result.history[i].smallest_determinant, 0);
            EXPECT_LE(result.history[i].energy, result.history[i - 1].energy);
        }
}

TEST(FoldFreeMap, UntanglesNoise) {
    for (const bool quads : {false, true}) {
        const Surface source(square(12, quads));
        const BoundaryCondition boundary = prescribe(source, [](Complex z) { return z; });
        Eigen::VectorXcd start = points(source.mesh);
        const Eigen::VectorXcd noise = shaken(source, 2.0);
        const std::vector<Freedom> freedom = freedoms(boundary, source);
        for (Eigen::Index v = 0; v < start.size(); ++v)
            if (freedom[v] == Freedom::free) start[v] = noise[v];
        ASSERT_GT(distortion(source.operators, start).flipped.size(),
                  static_cast<std::size_t>(source.mesh.face_count() / 3));
        const FoldFreeMap result = fold_free_map(source, freedom, zero_coefficient(source), start);
        EXPECT_EQ(result.status, FoldFreeStatus::converged) << "quads " << quads;
        EXPECT_LT(difference(result.map, points(source.mesh)), 1e-5)
            << "the conformal map with these boundary values is the identity";
    }
}

TEST(FoldFreeMap, TurnsAReflectedFreeMapOver) {
    const Surface source(ringed_disk(6));
    const Eigen::VectorXcd z = points(source.mesh);
    const FoldFreeMap result =
        fold_free_map(source, std::vector<Freedom>(z.size(), Freedom::free), zero_coefficient(source), z.conjugate());
    EXPECT_EQ(result.status, FoldFreeStatus::converged);
    EXPECT_LT(difference_up_to_similarity(result.map, z), 1e-6);
}

TEST(FoldFreeMap, FindsTheAffineMapOfAConstantCoefficient) {
    const Surface source(square(10, true));
    const Eigen::VectorXcd z = points(source.mesh);
    const Complex nu(0.2, 0.5);
    const Eigen::VectorXcd affine = z + nu * z.conjugate();
    for (const int pins : {0, 1, 2}) {
        std::vector<Freedom> freedom(z.size(), Freedom::free);
        for (int i = 0; i < pins; ++i) freedom[37 * i] = Freedom::fixed;
        Eigen::VectorXcd start = z;
        for (int i = 0; i < pins; ++i) start[37 * i] = affine[37 * i];
        const FoldFreeMap result =
            fold_free_map(source, freedom, Eigen::VectorXcd::Constant(source.operators.sample_count(), nu), start);
        EXPECT_EQ(result.status, FoldFreeStatus::converged);
        EXPECT_NEAR(result.history.back().energy, 1, 1e-10);
        EXPECT_LT(difference_up_to_similarity(result.map, affine), 1e-5) << pins;
        for (int i = 0; i < pins; ++i) EXPECT_EQ(result.map[37 * i], affine[37 * i]);
        if (pins == 2) {
            EXPECT_LT(difference(result.map, affine), 1e-5);
        }
    }
}

/// f = e^{.6(g + k conj g)}, g = z + .3z², has μ = k conj(g′)/g′.
struct TeichmuellerExample {
    static constexpr double k = 0.5;
    explicit TeichmuellerExample(int rings)
        : source(ringed_disk(rings)), exact(source.mesh.vertex_count()), nu(source.operators.sample_count()) {
        const Eigen::VectorXcd z = points(source.mesh);
        for (Eigen::Index v = 0; v < z.size(); ++v) exact[v] = image(z[v]);
        for (int s = 0; s < source.operators.sample_count(); ++s) {
            Complex centroid = 0;
            for (const int v : source.operators.stencil(s)) centroid += z[v] / 3.0;
            const Complex derivative = 1.0 + 0.6 * centroid;
            nu[s] = k * std::conj(derivative) / derivative;
        }
    }
    static Complex image(Complex z) {
        const Complex g = z + 0.3 * z * z;
        return std::exp(0.6 * (g + k * std::conj(g)));
    }
    Surface source;
    Eigen::VectorXcd exact, nu;
    double distance(const Eigen::VectorXcd& start, const Eigen::VectorXcd& coefficient) const {
        const BoundaryCondition boundary = prescribe(source, image);
        const FoldFreeMap result = fold_free_map(source, freedoms(boundary, source), coefficient, start);
        EXPECT_EQ(result.status, FoldFreeStatus::converged);
        return difference(result.map, exact);
    }
};

TEST(FoldFreeMap, StaysNearTheTeichmuellerMapInItsMetric) {
    const TeichmuellerExample coarse(10), fine(20);
    const double from_exact = fine.distance(fine.exact, fine.nu);
    EXPECT_LT(from_exact, 1e-3);
    EXPECT_LT(from_exact, 0.35 * coarse.distance(coarse.exact, coarse.nu)) << "of second order";
    EXPECT_GT(fine.distance(fine.exact, Eigen::VectorXcd::Zero(fine.nu.size())), 10 * from_exact)
        << "nu does not matter";
    // The start does not matter.
    const BoundaryCondition boundary = prescribe(fine.source, TeichmuellerExample::image);
    EXPECT_NEAR(fine.distance(harmonic_map(fine.source, boundary), fine.nu), from_exact, 1e-6);
}

TEST(FoldFreeMap, RepairsFoldsInTheMetricOfACoefficient) {
    const TeichmuellerExample example(16);
    Eigen::VectorXcd start = example.exact;
    for (Eigen::Index v = 0; v < 200; ++v) start[v] += std::polar(0.4, 2.4 * v);
    ASSERT_GT(distortion(example.source.operators, start).flipped.size(), 50u);
    EXPECT_NEAR(example.distance(start, example.nu), example.distance(example.exact, example.nu), 1e-6);
}

TEST(FoldFreeMap, LargePowersLowerTheLargestDilatation) {
    const Lobes lobes;
    double previous = 1;
    for (const double power : {1.0, 8.0, 64.0}) {
        FoldFreeOptions options;
        options.power = power;
        const FoldFreeMap result = fold_free_map(lobes.source, freedoms(lobes.boundary, lobes.source),
                                                 zero_coefficient(lobes.source), lobes.harmonic, options);
        EXPECT_EQ(result.status, FoldFreeStatus::converged) << power;
        EXPECT_EQ(result.history.back().power, power);
        const double largest = distortion(lobes.source.operators, result.map).max;
        EXPECT_LT(largest, previous - 0.02) << power;
        previous = largest;
    }
    EXPECT_GT(previous, 0.29073 - 0.005) << "below the extremal dilatation of this problem";
    EXPECT_LT(previous, 0.34);
}

TEST(FoldFreeMap, DoesNotDependOnUnits) {
    const Surface source(ringed_disk(10));
    const BoundaryCondition boundary = prescribe(source, three_lobes);
    const std::vector<Freedom> freedom = freedoms(boundary, source);
    const Eigen::VectorXcd start = harmonic_map(source, boundary);
    const FoldFreeMap reference = fold_free_map(source, freedom, some_coefficient(source), start);
    ASSERT_EQ(reference.status, FoldFreeStatus::converged);
    for (const double from : {1e-6, 1e6})
        for (const Complex to : {Complex(1e-6, 0), Complex(0, 1e6)}) {
            const Surface other(scaled(source.mesh, from));
            const FoldFreeMap result = fold_free_map(other, freedom, some_coefficient(source), start * to);
            EXPECT_EQ(result.status, FoldFreeStatus::converged);
            EXPECT_EQ(result.iterations, reference.iterations);
            EXPECT_LT(difference(result.map / to, reference.map), 1e-8);
        }
}

// ---- what cannot be done
// ---------------------------------------------------------------------------------------------

TEST(FoldFreeMap, SaysWhenTheBoundaryRunsTheWrongWay) {
    const Surface source(ringed_disk(6));
    const BoundaryCondition boundary = prescribe(source, [](Complex z) { return std::conj(z); });
    const FoldFreeMap result =
        fold_free_map(source, freedoms(boundary, source), zero_coefficient(source), harmonic_map(source, boundary));
    EXPECT_EQ(result.status, FoldFreeStatus::impossible);
    EXPECT_FALSE(result.fold_free);
    EXPECT_EQ(result.iterations, 0);
}

TEST(FoldFreeMap, NamesFacesThatFixedVerticesFold) {
    const Surface source(square(6, false));
    const BoundaryCondition all = prescribe(source, [](Complex z) { return z; });
    // The corner triangle has no free vertex; its middle one is pushed across the opposite edge.
    BoundaryCondition pushed;
    int face = -1;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        bool fixed = true;
        for (const int v : source.mesh.faces[f]) fixed = fixed && source.topology.on_boundary[v];
        if (fixed) face = f;
    }
    ASSERT_GE(face, 0);
    int corner = -1;  // the vertex of that face with one or two edges only
    for (const int v : source.mesh.faces[face]) {
        int faces = 0;
        for (const int w : source.mesh.faces.vertices()) faces += w == v;
        if (faces == 1) corner = v;
    }
    ASSERT_GE(corner, 0);
    for (std::size_t i = 0; i < all.vertices.size(); ++i)
        pushed.pin(all.vertices[i], all.vertices[i] == corner ? Complex(0.5, 0.5) : all.images[i]);
    FoldFreeOptions options;
    options.max_iterations = 50;
    const FoldFreeMap result = fold_free_map(source, freedoms(pushed, source), zero_coefficient(source),
                                             harmonic_map(source, pushed), options);
    EXPECT_EQ(result.status, FoldFreeStatus::impossible);
    EXPECT_FALSE(result.fold_free);
    ASSERT_EQ(result.unrepairable.size(), 1u);
    EXPECT_EQ(result.unrepairable[0], face);
}

TEST(FoldFreeMap, GivesUpOnABoundaryThatCrossesItself) {
    const Surface source(ringed_disk(8));
    // A small part of the boundary is drawn backwards; the area stays positive.
    const BoundaryCondition boundary = prescribe(source, [](Complex z) {
        const double t = std::arg(z);
        return std::polar(1.0, t + 1.5 * std::sin(t));
    });
    const FoldFreeMap result =
        fold_free_map(source, freedoms(boundary, source), zero_coefficient(source), harmonic_map(source, boundary));
    EXPECT_FALSE(result.fold_free);
    EXPECT_NE(result.status, FoldFreeStatus::converged);
    EXPECT_LE(result.iterations, 400);
}

void expect_error(Cause cause, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), cause) << error.what();
    }
}

TEST(FoldFreeMap, RejectsImpossibleArguments) {
    const Surface source(ringed_disk(2));
    const Eigen::VectorXcd z = points(source.mesh);
    const std::vector<Freedom> free(z.size(), Freedom::free);
    std::vector<Freedom> sliding = free;
    sliding[3] = Freedom::sliding;
    Eigen::VectorXcd large = zero_coefficient(source);
    large[5] = 1;
    expect_error(Cause::bad_boundary, [&] { fold_free_map(source, sliding, zero_coefficient(source), z); });
    expect_error(Cause::bad_option, [&] { fold_free_map(source, free, large, z); });
    expect_error(Cause::bad_option, [&] { fold_free_map(source, free, zero_coefficient(source), z.head(3)); });
    expect_error(Cause::bad_boundary, [&] {
        fold_free_map(source, free, zero_coefficient(source), Eigen::VectorXcd::Constant(z.size(), 2.0));
    });
    expect_error(Cause::bad_boundary, [&] { fold_free_map(source, free, zero_coefficient(source), z * std::nan("")); });
    for (const auto& change : std::vector<std::function<void(FoldFreeOptions&)>>{
             [](FoldFreeOptions& o) { o.power = 0.5; }, [](FoldFreeOptions& o) { o.power = std::nan(""); },
             [](FoldFreeOptions& o) { o.max_iterations = -1; }, [](FoldFreeOptions& o) { o.tolerance = 0; }}) {
        FoldFreeOptions options;
        change(options);
        expect_error(Cause::bad_option, [&] { fold_free_map(source, free, zero_coefficient(source), z, options); });
    }
    FoldFreeOptions cancel;
    cancel.progress = [](int, double) { return false; };
    expect_error(Cause::cancelled,
                 [&] { fold_free_map(source, free, zero_coefficient(source), z + 0.3 * z.conjugate(), cancel); });
}

}  // namespace
}  // namespace beltrami
