#include <beltrami/baselines/start.h>

#include <cmath>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/convex_combination_map.h>

namespace beltrami {

void BaselineOptions::validate() const {
    if (max_iterations < 1) throw Error(Cause::bad_option, "max_iterations must be at least 1");
    if (!(tolerance > 0 && tolerance < 1)) throw Error(Cause::bad_option, "tolerance must lie between 0 and 1");
    if (!(smoothing >= 0 && smoothing <= 1)) throw Error(Cause::bad_option, "smoothing must lie between 0 and 1");
    if (smoothing_passes < 0) throw Error(Cause::bad_option, "smoothing_passes must not be negative");
}

namespace detail {

void check_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    options.validate();
    require_open_component(source);
    validate(boundary, source);
    if (!boundary.lines.empty())
        throw Error(Cause::bad_boundary,
                    "vertex " + std::to_string(boundary.lines[0].vertex) +
                        " may slide on a line, which this method does not do",
                    "only the extremal map does; prescribe both coordinates",
                    {Things::vertices, {boundary.lines[0].vertex}});
}

double enclosed_area(const Surface& source, const BoundaryCondition& boundary) {
    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    double area = 0;
    for (const auto& loop : source.topology.boundary_loops) {
        std::vector<Complex> polygon;
        polygon.reserve(loop.size());
        for (const int v : loop) polygon.push_back(images[v]);
        area += signed_area(polygon);
    }
    return area;
}

bool must_fold(const Surface& source, const BoundaryCondition& boundary, BaselineMap& result) {
    if (!unprescribed_boundary(boundary, source).empty() || enclosed_area(source, boundary) > 0) return false;
    result.converged = false;
    result.warnings.push_back(
        {WarningKind::fold_forced,
         "the prescribed boundary encloses no positive area, so every map with it folds; a boundary listed clockwise "
         "must be reversed"});
    return true;
}

Eigen::VectorXcd linear_map(const Surface& source, const BoundaryCondition& boundary, int& factorizations) {
    ++factorizations;
    if (unprescribed_boundary(boundary, source).empty()) return harmonic_map(source, boundary);
    if (boundary.vertices.size() != 1) return least_squares_conformal_map(source, boundary);
    const Eigen::VectorXcd map = least_squares_conformal_map(source, {});
    const Complex shift = boundary.images[0] - map[boundary.vertices[0]];
    return map.array() + shift;
}

void give_true_size(const Surface& source, const BoundaryCondition& boundary, Eigen::VectorXcd& map) {
    if (boundary.vertices.size() > 1 || !boundary.lines.empty()) return;
    double area = 0, image = 0;
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [d_z, d_zbar] = source.operators.derivatives(s, map);
        area += source.operators.weights[s];
        image += source.operators.weights[s] * (std::norm(d_z) - std::norm(d_zbar));
    }
    if (!(image > 0)) return;
    const Complex centre = boundary.vertices.empty() ? Complex(0) : map[boundary.vertices[0]];
    const double scale = std::sqrt(area / image);
    map = (centre + scale * (map.array() - centre)).matrix().eval();
}

bool has_no_folds(const Surface& source, const Eigen::VectorXcd& map) {
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [d_z, d_zbar] = source.operators.derivatives(s, map);
        if (!(std::norm(d_z) > std::norm(d_zbar))) return false;
    }
    return true;
}

void warn_of_flips(const Surface& source, BaselineMap& result) {
    std::vector<int> flipped = distortion(source.operators, result.map).flipped;
    if (!flipped.empty())
        result.warnings.push_back({WarningKind::flipped_faces,
                                   counted(flipped.size(), "face is", "faces are") + " flipped",
                                   {Things::faces, std::move(flipped)}});
}

void warn_of_limit(const char* unsettled, BaselineMap& result) {
    if (!result.converged)
        result.warnings.push_back(
            {WarningKind::iteration_limit, "stopped after " + std::to_string(result.iterations) + " " + unsettled});
}

}  // namespace detail

BaselineMap harmonic_baseline(const Surface& source, const BoundaryCondition& boundary,
                              const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    BaselineMap result;
    result.map = harmonic_map(source, boundary);
    result.factorizations = 1;
    result.converged = true;
    detail::must_fold(source, boundary, result);
    detail::warn_of_flips(source, result);
    return result;
}

namespace {

BaselineMap convex_combination_baseline(const Surface& source, const BoundaryCondition& boundary,
                                        const BaselineOptions& options, ConvexWeights weights) {
    detail::check_baseline(source, boundary, options);
    require_whole_boundary(boundary, source);
    BaselineMap result;
    result.map = convex_combination_map(source, boundary, weights);
    result.factorizations = 1;
    result.converged = true;
    if (!detail::must_fold(source, boundary, result) && !has_convex_target(source, boundary))
        result.warnings.push_back(
            {WarningKind::fold_forced,
             "the target is not a convex polygon with nothing else prescribed, so that folds are not excluded"});
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace

BaselineMap tutte_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    return convex_combination_baseline(source, boundary, options, ConvexWeights::uniform);
}

BaselineMap mean_value_baseline(const Surface& source, const BoundaryCondition& boundary,
                                const BaselineOptions& options) {
    return convex_combination_baseline(source, boundary, options, ConvexWeights::mean_value);
}

BaselineMap lscm_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    BaselineMap result;
    result.map = least_squares_conformal_map(source, boundary);
    detail::give_true_size(source, boundary, result.map);
    result.factorizations = 1;
    result.converged = true;
    detail::must_fold(source, boundary, result);
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
