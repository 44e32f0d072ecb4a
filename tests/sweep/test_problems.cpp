#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/fold_free.h>

#include "problems/elliptic.h"
#include "problems/feasibility.h"
#include "problems/problems.h"

namespace beltrami::bench {
namespace {

class NamedProblems : public testing::TestWithParam<NamedProblem> {};

TEST_P(NamedProblems, IsFeasible) {
    const Problem problem = GetParam().make(GetParam().edge_length);
    EXPECT_EQ(problem.name, GetParam().name);
    EXPECT_FALSE(problem.statement.empty());
    EXPECT_GT(problem.mesh.face_count(), 500);
    EXPECT_LT(problem.mesh.face_count(), 60'000);
    EXPECT_EQ(infeasibility(problem), "");
    for (const auto& known : {problem.witness, problem.exact}) {
        if (!known) continue;
        const MapQuality quality = map_quality(problem, *known);
        EXPECT_EQ(quality.flipped, 0);
        EXPECT_LT(quality.pin_error, 1e-14);
    }
    EXPECT_TRUE(!problem.exact || problem.exact_k);
    std::set<int> pinned;
    for (const int v : problem.boundary.vertices) EXPECT_TRUE(pinned.insert(v).second) << v;
}

INSTANTIATE_TEST_SUITE_P(All, NamedProblems, testing::ValuesIn(named_problems()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Problems, AnUnknownNameIsAnError) {
    EXPECT_THROW(named_problem("none"), Error);
}

// |μ| of the interpolated exact maps tends to exact_k. The error is of first order in h where φ has neither zeros nor
// poles; the poles of the four points and the corner of half_plane_square keep their own size, so the mean is looked
// at.
TEST(Problems, ExactMapsHaveTheirDilatation) {
    for (const NamedProblem& entry : named_problems()) {
        double last = 0;
        for (const double factor : {2.0, 1.0}) {
            const Problem problem = entry.make(factor * entry.edge_length);
            if (!problem.exact || problem.name == "half_plane_square") break;
            const Distortion found = distortion(operators(problem.mesh), *problem.exact);
            const double error = std::hypot(found.mean - *problem.exact_k, found.standard_deviation);
            if (factor == 1.0) {
                EXPECT_LT(error, 0.04) << problem.name;
                EXPECT_LT(error, 0.65 * last) << problem.name;
            }
            last = error;
        }
    }
}

// μ = ⅓ z/z̄ on the half-plane: |μ| is constant, but the map has no tangent at the two fixed points ±1 on the circle.
TEST(Problems, TheHalfPlaneMapIsConstantAwayFromItsEnds) {
    double last = 0;
    for (const double edge_length : {0.06, 0.03}) {
        const Problem problem = half_plane_square(edge_length);
        const Eigen::VectorXcd mu = beltrami_coefficient(operators(problem.mesh), *problem.exact);
        double worst = 0;
        for (int f = 0; f < problem.mesh.face_count(); ++f) {
            bool near = false;
            for (const int v : problem.mesh.faces[f]) near = near || std::abs(problem.mesh.positions(v, 0)) > 0.7;
            if (!near) worst = std::max(worst, std::abs(std::abs(mu[f]) - 1.0 / 3));
        }
        EXPECT_TRUE(last == 0 || worst < 0.75 * last) << worst << " after " << last;
        last = worst;
    }
    EXPECT_LT(last, 0.05);
}

TEST(Problems, HarmonicStartsFoldWhereTheyShould) {
    for (const auto& [name, least] : {std::pair("three_lobes", 100), std::pair("screw", 500),
                                      std::pair("pierced_ball", 100), std::pair("annulus_one_turn", 0)}) {
        const Problem problem = named_problem(name);
        const Eigen::VectorXcd start = harmonic_map(Surface(problem.mesh), problem.boundary);
        const int flips = map_quality(problem, start).flipped;
        EXPECT_GE(flips, least) << name;
        RecordProperty(name, flips);
    }
}

TEST(Problems, AFoldFreeMapKeepsTheCadPartsFeaturesOnTheirLines) {
    Problem problem = cad_part(0.1);
    std::set<int> pinned(problem.boundary.vertices.begin(), problem.boundary.vertices.end());
    for (const FeatureCurve& curve : problem.features)
        for (std::size_t i = 0; i < curve.vertices.size(); ++i)
            if (pinned.insert(curve.vertices[i]).second) problem.boundary.pin(curve.vertices[i], curve.images[i]);
    const Surface surface(problem.mesh);
    FoldFreeOptions options;
    options.tolerance = 1e-2;
    const FoldFreeMap map =
        fold_free_map(surface, freedoms(problem.boundary, surface), Eigen::VectorXcd::Zero(surface.mesh.face_count()),
                      harmonic_map(surface, problem.boundary), options);
    EXPECT_TRUE(map.fold_free);
    EXPECT_EQ(map_quality(problem, map.map).flipped, 0);
    EXPECT_LT(map_quality(problem, map.map).pin_error, 1e-14);
}

// No closed form is at hand for a fold-free map of these: one is computed.
TEST(Problems, FoldFreeMapsExistWhereNoWitnessIsGiven) {
    for (const NamedProblem& entry : named_problems()) {
        const Problem problem = entry.make(1.5 * entry.edge_length);
        if (problem.witness) continue;
        const Surface surface(problem.mesh);
        FoldFreeOptions options;
        options.tolerance = 1e-2;
        const FoldFreeMap map = fold_free_map(surface, freedoms(problem.boundary, surface),
                                              Eigen::VectorXcd::Zero(surface.mesh.face_count()),
                                              harmonic_map(surface, problem.boundary), options);
        EXPECT_TRUE(map.fold_free) << problem.name;
        EXPECT_EQ(map_quality(problem, map.map).flipped, 0) << problem.name;
    }
}

TEST(Problems, FeaturesOfTheCadPartAreOnTheirLines) {
    const Problem problem = cad_part(0.08);
    ASSERT_EQ(problem.features.size(), 8u);
    std::vector<std::vector<Complex>> image(problem.mesh.vertex_count());
    for (std::size_t i = 0; i < problem.boundary.vertices.size(); ++i)
        image[problem.boundary.vertices[i]].push_back(problem.boundary.images[i]);
    for (const FeatureCurve& curve : problem.features) {
        ASSERT_EQ(curve.vertices.size(), curve.images.size());
        EXPECT_GT(curve.vertices.size(), 10u);
        for (std::size_t i = 0; i < curve.vertices.size(); ++i) {
            const double fixed =
                curve.fixed == FeatureCurve::Fixed::u ? curve.images[i].real() : curve.images[i].imag();
            EXPECT_NEAR(fixed, curve.value, 1e-12) << curve.name;
            image[curve.vertices[i]].push_back(curve.images[i]);
        }
    }
    // Curves that meet agree where they do.
    for (const auto& places : image)
        for (const Complex place : places) EXPECT_LT(std::abs(place - places[0]), 1e-12);
}

TEST(Feasibility, NamesWhatIsWrong) {
    Problem problem = moved_hole(0.1);
    const Topology shape = topology(problem.mesh);
    const BoundaryCondition good = problem.boundary;
    const auto move_hole = [&](auto&& f) {
        problem.boundary = good;
        for (std::size_t i = 0; i < good.vertices.size(); ++i) {
            const auto& hole = shape.boundary_loops[1];
            if (std::find(hole.begin(), hole.end(), good.vertices[i]) != hole.end())
                problem.boundary.images[i] = f(good.images[i]);
        }
    };
    EXPECT_EQ(infeasibility(problem), "");
    move_hole([](Complex z) { return z + 5.0; });
    EXPECT_EQ(infeasibility(problem), "hole 1 lies outside");
    move_hole([](Complex z) { return z + 0.6; });
    EXPECT_NE(infeasibility(problem).find("meet"), std::string::npos);
    move_hole([](Complex z) { return std::conj(z); });
    EXPECT_EQ(infeasibility(problem), "the image of loop 1 runs the wrong way");
    problem.boundary = good;
    problem.boundary.vertices.pop_back();
    problem.boundary.images.pop_back();
    EXPECT_NE(infeasibility(problem).find("has no image"), std::string::npos);
}

TEST(Feasibility, CountsTurns) {
    const Problem plain = annulus_turns(0.06, 0);
    for (const int turns : {-2, -1, 0, 1, 2}) {
        const Problem turned = annulus_turns(0.06, turns);
        for (std::size_t i = 0; i < turned.boundary.images.size(); ++i)
            EXPECT_LT(std::abs(turned.boundary.images[i] - plain.boundary.images[i]), 1e-14);
        EXPECT_EQ(turned.turns, (std::vector<int>{0, turns}));
        EXPECT_EQ(relative_turns(turned, *turned.exact, *plain.exact), turned.turns);
    }
    // One hole of many turned once more, by a twist with small support.
    const Problem many = holes_27(0.02);
    const Topology shape = topology(many.mesh);
    Complex centre = 0;
    for (const int v : shape.boundary_loops[5]) centre += (*many.witness)[v];
    centre /= static_cast<double>(shape.boundary_loops[5].size());
    double reach = 0;
    for (const int v : shape.boundary_loops[5]) reach = std::max(reach, std::abs((*many.witness)[v] - centre));
    Eigen::VectorXcd twisted = *many.witness;
    for (Complex& z : twisted) {
        const double t = std::clamp((std::abs(z - centre) - reach) / 0.08, 0.0, 1.0);
        z = centre + (z - centre) * std::polar(1.0, 2 * kPi * t);
    }
    std::vector<int> expected(28, 0);
    expected[5] = -1;
    EXPECT_EQ(relative_turns(many, twisted, *many.witness), expected);
}

TEST(Elliptic, CompleteIntegrals) {
    EXPECT_DOUBLE_EQ(complete_elliptic(0), kPi / 2);
    EXPECT_NEAR(complete_elliptic(std::sqrt(0.5)), 1.8540746773013719, 1e-15);
    EXPECT_NEAR(carlson_rf(0, 0.5, 1).real(), 1.8540746773013719, 1e-13);
}

TEST(Elliptic, DiskAndRectangle) {
    // Four equal arcs make a square.
    EXPECT_NEAR(DiskRectangle(kPi / 4).width() / DiskRectangle(kPi / 4).height(), 1, 1e-14);
    const DiskRectangle map(0.6);
    const double w = map.width() / 2, h = map.height() / 2;
    const auto distance = [](Complex a, Complex b) { return std::abs(a - b); };
    EXPECT_LT(distance(map.to_rectangle(std::polar(1.0, 0.6)), {w, h}), 1e-7);
    EXPECT_LT(distance(map.to_rectangle(std::polar(1.0, kPi - 0.6)), {-w, h}), 1e-7);
    EXPECT_LT(distance(map.to_rectangle(std::polar(1.0, -0.6)), {w, -h}), 1e-7);
    EXPECT_LT(distance(map.to_rectangle(1.0), w), 1e-12);
    EXPECT_LT(distance(map.to_rectangle(0.0), 0), 1e-12);
    for (const double r : {0.3, 0.9, 1.0})
        for (int i = 0; i < 40; ++i) {
            const Complex z = std::polar(r, 2 * kPi * (i + 0.1) / 40), image = map.to_rectangle(z);
            EXPECT_LE(std::abs(image.real()), w + 1e-12);
            EXPECT_LE(std::abs(image.imag()), h + 1e-12);
            EXPECT_LT(distance(map.to_disk(image), z), 1e-10) << z;
            // Conformal: the difference quotients along both axes agree.
            if (r > 0.95) continue;
            const double step = 1e-5;
            const Complex along = map.to_rectangle(z + step) - map.to_rectangle(z - step);
            const Complex up = map.to_rectangle(z + Complex(0, step)) - map.to_rectangle(z - Complex(0, step));
            EXPECT_LT(std::abs(up / along - Complex(0, 1)), 1e-7);
        }
}

}  // namespace
}  // namespace beltrami::bench
