#include <beltrami/charts/fold_free_disk.h>

#include <cmath>
#include <numbers>
#include <optional>

#include <beltrami/operators/distortion.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Least angle of a boundary edge, as a part of what arc length would give it.
constexpr double kLeastAngle = 1e-3;

/// Angles of the boundary edges around 0; empty if they do not go round once.
std::vector<double> angles_of(const std::vector<int>& loop, const Eigen::VectorXcd& chart) {
    std::vector<double> angles;
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Complex here = chart[loop[i]], next = chart[loop[(i + 1) % loop.size()]];
        angles.push_back(here == 0.0 || next == 0.0 ? 0.0 : std::arg(next / here));
        sum += angles.back();
    }
    if (!(std::abs(sum - kTurn) < 1)) angles.clear();
    return angles;
}

}  // namespace

FoldFreeDisk fold_free_disk(const Surface& source, const Eigen::VectorXcd& chart) {
    FoldFreeDisk result;
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const std::vector<double>& lengths = source.boundary_edge_lengths[0];
    double length = 0;
    for (const double l : lengths) length += l;
    std::vector<double> angles = angles_of(loop, chart);
    result.kept_boundary = !angles.empty();
    if (!result.kept_boundary) angles.assign(loop.size(), 0);
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const double by_length = kTurn * lengths[i] / length;
        if (!result.kept_boundary) {
            angles[i] = by_length;
        } else if (angles[i] < kLeastAngle * by_length) {
            angles[i] = kLeastAngle * by_length;
            ++result.moved_boundary;
        }
        sum += angles[i];
    }
    const Distortion distortion = beltrami::distortion(source.operators, chart);
    if (result.kept_boundary && result.moved_boundary == 0 && distortion.flipped.empty() && distortion.max < 1) {
        result.map = chart;
        result.fold_free = true;
        return result;
    }
    result.changed = true;
    BoundaryCondition boundary;
    double at = result.kept_boundary ? std::arg(chart[loop[0]]) : 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        boundary.pin(loop[i], std::polar(1.0, at));
        at += kTurn * angles[i] / sum;
    }
    Eigen::VectorXcd start = chart;
    for (std::size_t i = 0; i < loop.size(); ++i) start[loop[i]] = boundary.images[i];
    const Eigen::VectorXcd conformal = Eigen::VectorXcd::Zero(source.operators.sample_count());
    FoldFreeMap found = fold_free_map(source, freedoms(boundary, source), conformal, start);
    result.factorizations += found.factorizations;
    if (!found.fold_free)
        if (const auto embedding = convex_embedding(source, boundary, result.factorizations)) {
            found = fold_free_map(source, freedoms(boundary, source), conformal, *embedding);
            result.factorizations += found.factorizations;
        }
    result.map = std::move(found.map);
    result.fold_free = found.fold_free;
    return result;
}

}  // namespace beltrami
