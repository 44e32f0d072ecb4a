#include <beltrami/certificate/sharpened_bound.h>

#include <algorithm>
#include <cmath>

#include <beltrami/certificate/refined_problem.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// k of the f-step stays below this.
constexpr double kLargest = 0.9999;
/// A second f-step where the estimate of K differs by more than this part from that of the first k.
constexpr double kOtherK = 2e-3;
constexpr int kMostSteps = 3;

/// The problem on another mesh, with the chart of its vertices.
struct Level {
    Surface surface;
    BoundaryCondition boundary;
    Eigen::VectorXcd chart;
    Eigen::VectorXcd map;
};

Level subdivided(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& chart,
                 const Eigen::VectorXcd& map) {
    RefinedProblem fine = refined_problem(surface, boundary);
    Eigen::VectorXcd places = fine.interpolated(chart), images = map;
    if (map.size()) images = fine.interpolated(map);
    return {std::move(fine.surface), std::move(fine.boundary), std::move(places), std::move(images)};
}

}  // namespace

SharpenedBound sharpened_bound(const Surface& source, const BoundaryCondition& boundary, const Chart& chart,
                               const DifferentialSpace& space, const Eigen::VectorXcd& coefficients, double k,
                               const SharpenedBoundOptions& options) {
    SharpenedBound result;
    std::optional<Level> level;
    if (!all_triangles(source.mesh)) level = Level{cut_into_triangles(source), boundary, chart.vertices, options.map};
    for (int i = 0; i < options.subdivisions; ++i) {
        const int faces = (level ? level->surface : source).mesh.face_count();
        if (faces > options.most_triangles / 4) break;
        level = level ? subdivided(level->surface, level->boundary, level->chart, level->map)
                      : subdivided(source, boundary, chart.vertices, options.map);
    }
    std::optional<Chart> finer;
    if (level) {
        finer = make_chart(level->surface, level->chart, chart.exact);
        finer->analytic = chart.analytic;
        if (chart.exact && chart.analytic) std::fill(finer->excluded.begin(), finer->excluded.end(), 0);
    }
    const Surface& surface = level ? level->surface : source;
    const Chart& own = finer ? *finer : chart;
    const Eigen::VectorXcd& mended = level ? level->map : options.map;
    result.triangles = surface.mesh.face_count();
    QuadraticStep step(surface, level ? level->boundary : boundary, own, space, coefficients);
    for (int i = 0; i < kMostSteps; ++i) {
        QuadraticMap map = step.solve(k);
        if (!(mended.size() ? mend(surface, map, mended) : straighten(surface, map)).empty()) break;
        const ReichStrebel integrals = reich_strebel_quadratic(surface, own, space, coefficients, map);
        if (!integrals.valid) break;
        result.integrals = integrals;
        result.map = std::move(map);
        const bool rigorous = integrals.resolved && proves(surface, own);
        if (integrals.lower > result.lower) result.lower = integrals.lower, result.rigorous = rigorous;
        const double last = dilatation(k);
        k = std::min(k_of(integrals.estimate), kLargest);
        if (std::abs(integrals.estimate - last) < kOtherK * last) break;
    }
    result.factorizations = step.factorizations();
    if (level) result.refined = std::move(level->surface);
    return result;
}

}  // namespace beltrami
