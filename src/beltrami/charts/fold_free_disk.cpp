#include <beltrami/charts/fold_free_disk.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <beltrami/base/constants.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/increasing.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Least angle of a boundary edge, as a part of the mean of those around it, or, where that leaves folds, of what arc
/// length would give it: faces with three vertices on a rim of 1e-9 are smaller than rounding.
constexpr double kOfNeighbours = 1e-3, kOfLength[] = {1e-5, 1e-3};
/// See with_folds_opened(): the part of the chart that may stay turned over.
constexpr double kMostUnseen = 1e-5;

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

/// Angles made positive, at least a part of what arc length gives; the number of those that were not is counted.
std::vector<double> raised_angles(const Surface& source, std::vector<double> angles, double of_length,
                                  FoldFreeDisk& result) {
    const std::vector<double>& lengths = source.boundary_edge_lengths[0];
    const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    if (!result.kept_boundary) {
        for (const double l : lengths) angles.push_back(l / length);
        return angles;
    }
    const std::vector<double> given = angles;
    for (double& angle : angles) angle = std::max(angle, 0.0);
    raise_to_neighbours(angles, kOfNeighbours);
    for (std::size_t i = 0; i < angles.size(); ++i)
        angles[i] = std::max(angles[i], of_length * kTurn * lengths[i] / length);
    result.moved_boundary = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) result.moved_boundary += angles[i] != given[i];
    return angles;
}

/// A map with the boundary on the circle by its angles.
struct OnCircle {
    BoundaryCondition boundary;
    Eigen::VectorXcd start;
};
OnCircle on_circle(const Surface& source, const Eigen::VectorXcd& chart, const std::vector<double>& angles,
                   bool kept_boundary) {
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const double sum = std::accumulate(angles.begin(), angles.end(), 0.0);
    OnCircle result{{}, chart};
    double at = kept_boundary ? std::arg(chart[loop[0]]) : 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        result.boundary.pin(loop[i], std::polar(1.0, at));
        result.start[loop[i]] = result.boundary.images[i];
        at += kTurn * angles[i] / sum;
    }
    return result;
}

/// Opens the folds where they are.
void open_locally(const Surface& source, const OnCircle& from, FoldFreeDisk& result) {
    LocalUnfolding opened = unfold_locally(source, freedoms(from.boundary, source), from.start);
    result.factorizations += opened.factorizations;
    result.map = std::move(opened.map);
    result.fold_free = opened.fold_free;
}

/// Puts the boundary on the circle by its angles and opens the folds inside.
void open_folds(const Surface& source, const Eigen::VectorXcd& chart, const std::vector<double>& angles,
                FoldFreeDisk& result) {
    const OnCircle from = on_circle(source, chart, angles, result.kept_boundary);
    const auto& [boundary, start] = from;
    if (result.kept_boundary) {
        open_locally(source, from, result);
        if (result.fold_free) return;
    }
    const std::vector<Freedom> freedom = freedoms(boundary, source);
    const Eigen::VectorXcd conformal = Eigen::VectorXcd::Zero(source.operators.sample_count());
    FoldFreeMap found = fold_free_map(source, freedom, conformal, start);
    result.factorizations += found.factorizations;
    if (!found.fold_free)
        if (const auto embedding = convex_embedding(source, boundary, result.factorizations)) {
            found = fold_free_map(source, freedom, conformal, *embedding);
            result.factorizations += found.factorizations;
        }
    result.map = std::move(found.map);
    result.fold_free = found.fold_free;
}

}  // namespace

Chart with_folds_opened(const Surface& source, Chart chart) {
    const std::vector<double> angles = angles_of(source.topology.boundary_loops[0], chart.vertices);
    const bool forward = !angles.empty() && *std::min_element(angles.begin(), angles.end()) > 0;
    const double unseen = chart.excluded_faces > 0 ? unseen_part(source, chart) : 0;
    if (forward && unseen <= kMostUnseen) return chart;
    FoldFreeDisk opened;
    if (angles.empty()) {
        opened = fold_free_disk(source, chart.vertices);
        if (!opened.fold_free) return chart;
    } else {
        opened.kept_boundary = true;
        const std::vector<double> raised = raised_angles(source, angles, 0, opened);
        open_locally(source, on_circle(source, chart.vertices, raised, true), opened);
    }
    centre_in_disk(opened.map, vertex_areas(source.operators));
    Chart result = make_chart(source, std::move(opened.map), false);
    result.factorizations = chart.factorizations + opened.factorizations;
    // What folds are left are smaller than rounding; the rim's order is what matters.
    return forward && unseen_part(source, result) >= unseen ? chart : result;
}

FoldFreeDisk fold_free_disk(const Surface& source, const Eigen::VectorXcd& chart) {
    FoldFreeDisk result;
    const std::vector<double> angles = angles_of(source.topology.boundary_loops[0], chart);
    result.kept_boundary = !angles.empty();
    const std::vector<double> raised = raised_angles(source, angles, 0, result);
    const Distortion distortion = beltrami::distortion(source.operators, chart);
    if (result.kept_boundary && result.moved_boundary == 0 && distortion.flipped.empty() && distortion.max < 1) {
        result.map = chart;
        result.fold_free = true;
        return result;
    }
    result.changed = true;
    open_folds(source, chart, raised, result);
    for (const double of_length : kOfLength)
        if (!result.fold_free && result.kept_boundary)
            open_folds(source, chart, raised_angles(source, angles, of_length, result), result);
    return result;
}

}  // namespace beltrami
