#pragma once

// Problems whose boundary slides, and what is expected of every answer.

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami::test {

/// x, y, radius.
using Hole = std::array<double, 3>;

/// A disk with round holes, meshed as the design's prototype: finer at the holes.
inline Mesh disk_with_holes(const std::vector<Hole>& holes, double h, double outer = 1) {
    std::vector<Circle> circles;
    for (const auto& [x, y, r] : holes) circles.push_back({{x, y}, r});
    DomainOptions options;
    options.edge_length = h;
    options.hole_edge_length = 0.4 * h;
    options.least_hole_edges = 30;
    return circle_domain({Eigen::Vector2d::Zero(), outer}, circles, options);
}

inline TargetDomain circles_target(const std::vector<Hole>& holes, double outer = 1) {
    std::vector<TargetCurve> curves;
    for (const auto& [x, y, r] : holes) curves.push_back(TargetCurve::circle({x, y}, r));
    return target_domain(TargetCurve::circle(0, outer), std::move(curves));
}

/// No folds, a settled iteration, the dimension of theory, loops that run around once, bounds in order.
inline void expect_sliding_sound(const ExtremalMap& result) {
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_EQ(result.dimension, result.expected_dimension);
    for (const LoopOnto& loop : result.loops) {
        EXPECT_GT(loop.area_ratio, 0.9);
        EXPECT_LT(loop.area_ratio, 1.0 + 1e-9);
        for (std::size_t i = 0; i + 1 < loop.parameters.size(); ++i)
            EXPECT_LT(loop.parameters[i], loop.parameters[i + 1]);
    }
    EXPECT_LE(result.K_lower, result.K * (1 + 1e-12));
    EXPECT_LE(result.K, result.K_max);
    for (const Warning& warning : result.warnings) ADD_FAILURE() << warning.sentence;
}

}  // namespace beltrami::test
