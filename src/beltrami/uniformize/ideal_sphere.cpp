#include <beltrami/uniformize/ideal_sphere.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/uniformize/flatten_layout.h>

namespace beltrami {

namespace {

constexpr double kTornLayout = 1e-3;  // relative error at which the drawing does not hold together
// What makes a star uneven, in units of the ratio of its longest to its shortest edge.
constexpr double kCurvatureCost = 3, kDistanceCost = 6, kFewEdgesCost = 1e3;

}  // namespace

bool IdealSphere::solved() const {
    const bool ended = factors.status == ScaleFactorStatus::converged || factors.status == ScaleFactorStatus::stagnated;
    return ended && plane.allFinite() && layout_error < kTornLayout;
}

IdealSphere ideal_sphere(const IntrinsicTriangulation& triangulation, int ideal_vertex, const std::vector<char>& used,
                         double tolerance, int max_iterations) {
    ScaleFactorProblem problem;
    problem.tolerance = tolerance;
    problem.max_iterations = max_iterations;
    problem.stop_when_degenerate = false;
    problem.free = used;
    problem.target_angles = Eigen::VectorXd::Constant(triangulation.vertex_count(), kTurn);
    for (int v = 0; v < triangulation.vertex_count(); ++v)
        if (!used[v]) problem.target_angles[v] = std::numeric_limits<double>::quiet_NaN();

    IdealSphere result{IdealTriangulation(triangulation, ideal_vertex), {}, {}, 0};
    result.factors = solve_scale_factors(result.triangulation, problem, result.triangulation.start());
    Layout layout = lay_out(result.triangulation.finite_part(), result.factors.u);
    result.plane = std::move(layout.positions);
    result.layout_error = layout.error;
    return result;
}

std::vector<int> ideal_candidates(const IntrinsicTriangulation& triangulation, const Positions& positions) {
    const int n = triangulation.vertex_count();
    const std::vector<char> simple = simple_stars(triangulation);
    const Eigen::VectorXd unscaled = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd angles = unscaled, degrees = unscaled;
    Eigen::VectorXd shortest = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    Eigen::VectorXd longest = -shortest;
    for (int t = 0; t < triangulation.triangle_count(); ++t) {
        const TriangleAngles triangle = triangulation.angles(t, unscaled);
        for (int k = 0; k < 3; ++k) {
            const int h = 3 * t + k, v = triangulation.tail(h);
            angles[triangulation.tail(IntrinsicTriangulation::previous(h))] += triangle.angles[k];
            degrees[v] += 1;
            shortest[v] = std::min(shortest[v], triangulation.log_length(h));
            longest[v] = std::max(longest[v], triangulation.log_length(h));
        }
    }
    Eigen::RowVectorXd centroid = Eigen::RowVectorXd::Zero(positions.cols());
    for (int v = 0; v < n; ++v) centroid += (degrees[v] > 0 ? 1.0 : 0.0) * positions.row(v);
    centroid /= (degrees.array() > 0).count();
    Eigen::VectorXd distances = (positions.rowwise() - centroid).rowwise().norm();
    distances /= distances.maxCoeff();

    std::vector<int> candidates;
    Eigen::VectorXd cost(n);
    for (int v = 0; v < n; ++v) {
        if (!simple[v]) continue;
        candidates.push_back(v);
        cost[v] = std::exp(longest[v] - shortest[v]) + kCurvatureCost * std::abs(angles[v] - kTurn) +
                  kDistanceCost * distances[v] + (degrees[v] < 5 ? kFewEdgesCost : 0);
    }
    std::sort(candidates.begin(), candidates.end(),
              [&](int a, int b) { return cost[a] != cost[b] ? cost[a] < cost[b] : a < b; });
    return candidates;
}

}  // namespace beltrami
