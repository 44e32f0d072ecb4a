// Maps with a prescribed coefficient whose boundary slides: Examples 1 to 3 of Ng, Gu & Lui 2014.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "problems/swirl.h"
#include "support/onto.h"

#include <beltrami/flow/beltrami_flow.h>
#include <beltrami/mesh/planar.h>

namespace beltrami {
namespace {

using bench::image_domain;
using bench::swirl;
using bench::swirl_coefficient;
using test::circles_target;
using test::disk_with_holes;
using test::Hole;

Correspondence loops_in_order(std::size_t holes) {
    Correspondence wanted;
    for (int l = 0; l <= static_cast<int>(holes); ++l) wanted.loops.push_back({l, l});
    return wanted;
}

double distance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

// ---- Example 3: against the map of the smooth domain ---------------------------------------------------------------

TEST(FlowExample3, HasTheOrdersOfThePaper) {
    // The coefficient is that of the map: central differences.
    for (const Complex z : {Complex(0.3, 0.2), Complex(-0.1, 0.7)}) {
        const double d = 1e-5;
        const Complex x = (swirl(z + d) - swirl(z - d)) / (2 * d),
                      y = (swirl(z + Complex(0, d)) - swirl(z - Complex(0, d))) / (2 * d);
        EXPECT_LT(std::abs((x + Complex(0, 1) * y) / (x - Complex(0, 1) * y) - swirl_coefficient(z)), 1e-9);
    }
    const std::vector<Hole> holes{{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}};
    const TargetDomain target = image_domain(holes, swirl);
    std::vector<double> coordinates, coefficients, means;
    for (const double h : {0.08, 0.04, 0.02}) {
        const Surface source(disk_with_holes(holes, h));
        const Eigen::VectorXcd z = planar_coordinates(source.mesh);
        const Eigen::VectorXcd exact = z.unaryExpr([](Complex p) { return swirl(p); });
        Eigen::VectorXcd mu(source.operators.sample_count());
        for (int s = 0; s < mu.size(); ++s) {
            Complex middle = 0;
            for (const int v : source.operators.stencil(s)) middle += z[v] / 3.0;
            mu[s] = swirl_coefficient(middle);
        }
        const FlowMap result = beltrami_flow(source, target, mu, {}, loops_in_order(holes.size()));
        EXPECT_EQ(result.termination, Termination::converged);
        EXPECT_TRUE(result.one_to_one());
        EXPECT_TRUE(result.fits);
        for (const Warning& warning : result.warnings) ADD_FAILURE() << warning.sentence;
        coordinates.push_back(distance(result.map, exact));
        coefficients.push_back(result.error.sup);
        means.push_back(result.error.l2);
    }
    const double halvings = static_cast<double>(coordinates.size()) - 1;
    EXPECT_GT(std::log2(coordinates.front() / coordinates.back()) / halvings, 1.79);
    EXPECT_GT(std::log2(coefficients.front() / coefficients.back()) / halvings, 0.8);
    EXPECT_GT(std::log2(means.front() / means.back()) / halvings, 0.92);
    EXPECT_LT(coordinates.back(), 2e-3);
}

// ---- Examples 1 and 2: from the coefficient of a piecewise linear map back to it -----------------------------------

struct Reconstruction {
    std::vector<double> errors;  ///< of the coordinates, after every iteration
    FlowMap flow;
};

/// From the harmonic start to a map with vertices on the target's curves, given by its coefficient alone.
Reconstruction reconstruct(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& given) {
    Reconstruction result;
    const Distortion measured = distortion(source.operators, given);
    EXPECT_TRUE(measured.flipped.empty());
    const SlidingStart start = flow_start(source, target, loops_in_order(source.topology.boundary_loops.size() - 1));
    EXPECT_GT(distance(start.map, given), 0.02) << "there should be something to do";
    FlowOptions options;
    options.progress = [&](int, const FlowIteration&, const Eigen::VectorXcd& map) {
        result.errors.push_back(distance(map, given));
        return true;
    };
    result.flow = beltrami_flow(source, measured.mu, start, options);
    EXPECT_EQ(result.flow.termination, Termination::converged);
    EXPECT_TRUE(result.flow.one_to_one());
    EXPECT_TRUE(result.flow.fits);
    return result;
}

TEST(FlowExample1, ReturnsToAMapBetweenTriplyConnectedDomains) {
    const std::vector<Hole> holes{{0.4, -0.02, 0.26}, {-0.32, 0.09, 0.16}};
    const auto f = [](Complex z) {
        return z + 0.12 * z * z + 0.25 * std::conj(z) + 0.1 * Complex(0, 1) * std::norm(z);
    };
    const TargetDomain target = image_domain(holes, f);
    for (const double h : {0.1, 0.05}) {
        const Surface source(disk_with_holes(holes, h));
        Eigen::VectorXcd given = planar_coordinates(source.mesh).unaryExpr(f);
        for (const auto& loop : source.topology.boundary_loops)  // from the spline by its own error
            for (const int v : loop) {
                double least = 1;
                Complex place;
                for (int c = 0; c < target.curve_count(); ++c) {
                    const Complex near = target.curve(c).point(target.curve(c).nearest(given[v]));
                    if (std::abs(near - given[v]) < least) least = std::abs(near - given[v]), place = near;
                }
                EXPECT_LT(least, 1e-7);
                given[v] = place;
            }
        const Reconstruction result = reconstruct(source, target, given);
        ASSERT_LE(result.errors.size(), 12u);
        EXPECT_LT(result.errors[std::min<std::size_t>(result.errors.size(), 9) - 1], 1e-9);
        EXPECT_LT(result.flow.error.sup, 1e-8);
    }
}

TEST(FlowExample2, ReturnsToAMapBetweenCircleDomains) {
    const std::vector<Hole> from{{-0.11, -0.46, 0.16}, {-0.34, 0.37, 0.14}, {0.36, 0.01, 0.18}},
        to{{-0.2, -0.4, 0.2}, {-0.3, 0.45, 0.1}, {0.4, 0.1, 0.22}};
    const TargetDomain target = circles_target(to);
    for (const double h : {0.1, 0.05}) {
        const Surface source(disk_with_holes(from, h));
        FlowStartOptions turned;
        turned.start_turns = {0.2, 0.3, -0.3, 0.2};
        const Reconstruction result =
            reconstruct(source, target, flow_start(source, target, loops_in_order(from.size()), turned).map);
        ASSERT_LE(result.errors.size(), 12u);
        EXPECT_LT(result.errors[std::min<std::size_t>(result.errors.size(), 9) - 1], 1e-9);
        EXPECT_LT(result.flow.error.sup, 1e-8);
    }
}

}  // namespace
}  // namespace beltrami
