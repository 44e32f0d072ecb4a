#include <beltrami/uniformize/fold_free_flattening.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <beltrami/operators/distortion.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Area of the image, what is flipped taken off.
double image_area(const Surface& surface, const Eigen::VectorXcd& map) {
    double area = 0;
    for (int s = 0; s < surface.operators.sample_count(); ++s) {
        const auto [dz, dzbar] = surface.operators.derivatives(s, map);
        area += surface.operators.weights[s] * (std::norm(dz) - std::norm(dzbar));
    }
    return area;
}

/// A map onto a disk without folds, its rim by length.
std::optional<Eigen::VectorXcd> embedding(const Surface& surface, int& factorizations) {
    BoundaryCondition rim;
    const std::vector<int>& loop = surface.topology.boundary_loops[0];
    const std::vector<double>& lengths = surface.boundary_edge_lengths[0];
    double length = 0, at = 0;
    for (const double l : lengths) length += l;
    for (std::size_t i = 0; i < loop.size(); at += lengths[i], ++i)
        rim.pin(loop[i], std::polar(1.0, 2 * std::numbers::pi * at / length));
    return convex_embedding(surface, rim, factorizations);
}

/// The fold-free map nearest to a conformal one with the boundary free; whether there is one.
bool open_freely(const Surface& surface, const Eigen::VectorXcd& start, FoldFreeFlattening& result) {
    const std::vector<Freedom> free(static_cast<std::size_t>(surface.mesh.vertex_count()), Freedom::free);
    FoldFreeMap found = fold_free_map(surface, free, Eigen::VectorXcd::Zero(surface.operators.sample_count()), start);
    result.factorizations += found.factorizations;
    if (!found.fold_free) return false;
    const double area = image_area(surface, result.flattening.positions), now = image_area(surface, found.map);
    result.flattening.positions = area > 0 && now > 0 ? Eigen::VectorXcd(found.map * std::sqrt(area / now)) : found.map;
    result.kept_boundary = false;
    return true;
}

}  // namespace

FoldFreeFlattening fold_free_flattening(const Surface& surface, const FlattenOptions& options) {
    FoldFreeFlattening result;
    result.flattening = flatten(surface.mesh, options);
    result.factorizations = result.flattening.factorizations;
    Eigen::VectorXcd& map = result.flattening.positions;
    result.unfolded = distortion(surface.operators, map).flipped;
    if (result.unfolded.empty()) {
        result.fold_free = true;
        return result;
    }
    std::vector<Freedom> inside(static_cast<std::size_t>(surface.mesh.vertex_count()), Freedom::free);
    for (const int v : surface.topology.boundary_loops[0]) inside[v] = Freedom::fixed;
    LocalUnfolding opened = unfold_locally(surface, inside, map);
    result.factorizations += opened.factorizations;
    result.fold_free = opened.fold_free;
    if (opened.fold_free) {
        map = std::move(opened.map);
    } else {
        result.fold_free = open_freely(surface, map, result);
        if (!result.fold_free)
            if (const auto start = embedding(surface, result.factorizations))
                result.fold_free = open_freely(surface, *start, result);
    }
    result.flattening.flipped = distortion(surface.operators, map).flipped;
    return result;
}

}  // namespace beltrami
