#include <beltrami/certificate/proved_bounds.h>

#include <algorithm>
#include <limits>

#include <beltrami/base/error.h>
#include <beltrami/certificate/attained_dilatation.h>
#include <beltrami/certificate/edge_corner_bound.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/certificate/period_pair.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/mesh/boundary_position.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// Loops of fewer vertices are taken for what they are.
constexpr std::size_t kSampled = 24;

void take(ProvedBounds& result, Bound::Kind kind, double K, Bound::Of of = Bound::Of::extremal) {
    if (K > 1) result.bounds.push_back({kind, K, of, true});
}

bool is_sampled(const Surface& source, int vertex) {
    const auto at = boundary_position(source.topology, vertex);
    return at && source.topology.boundary_loops[at->loop].size() >= kSampled;
}

/// Vertices inside that are pinned each alone.
std::vector<int> inner_pins(const Surface& source, const BoundaryCondition& boundary) {
    std::vector<int> pins;
    for (const int v : boundary.vertices)
        if (!source.topology.on_boundary[v]) pins.push_back(v);
    return pins;
}

double moduli_bound(const Surface& source, const Eigen::VectorXcd& map, int& factorizations) {
    const auto& loops = source.topology.boundary_loops;
    if (loops.size() == 1) {
        std::vector<Complex> images;
        for (const int v : loops[0]) images.push_back(map[v]);
        const auto rectangle = rectangle_image(images);
        if (!rectangle) return 1;
        const ModulusBracket own =
            quadrilateral_modulus(source.operators, sides_between(loops[0], rectangle->positions));
        factorizations += own.factorizations;
        return modulus_ratio(own, {rectangle->modulus, rectangle->modulus});
    }
    if (loops.size() == 2) {
        const std::optional<BoundaryImage> image = image_under(source, map);
        if (!image) return 1;
        const ModulusBracket own = ring_modulus(source), other = ring_modulus(source, image->operators);
        factorizations += own.factorizations + other.factorizations;
        return modulus_ratio(own, other);
    }
    return 1;
}

double best_pair(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                 const PairBoundOptions& options, int& factorizations) {
    double best = 1;
    const auto take_bound = [&](const PairBound& bound) {
        factorizations += bound.factorizations;
        best = std::max(best, bound.K);
    };
    const auto try_image = [&](const std::optional<BoundaryImage>& image, const std::vector<int>& branches) {
        if (image) take_bound(pair_bound(source, *image, branches, options));
    };
    const std::optional<BoundaryImage> own = image_under(source, map);
    if (source.topology.boundary_loops.size() > 1) {
        if (own) take_bound(period_pair_bound(source, *own, options));
        return best;
    }
    try_image(own, {});
    try_image(filled_image(source, map), {});
    const std::vector<int> pins = inner_pins(source, boundary);
    if (!pins.empty()) try_image(own, pins);
    return best;
}

}  // namespace

double ProvedBounds::K() const {
    double K = 1;
    for (const Bound& bound : bounds)
        if (bound.of == Bound::Of::extremal && bound.kind != Bound::Kind::attained) K = std::max(K, bound.K);
    return K;
}

ProvedBounds proved_bounds(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                           const ProvedBoundsOptions& options) {
    ProvedBounds result;
    const EdgeCornerBound corner = edge_corner_bound(source, map);
    const bool sampled = !options.exact_polygons && is_sampled(source, corner.vertex);
    take(result, Bound::Kind::edge_corner, corner.K, sampled ? Bound::Of::polygons : Bound::Of::extremal);
    result.corner_vertex = corner.vertex;
    const bool quads = !all_triangles(source.mesh);
    std::optional<Surface> cut;
    // Quads in space have no one surface: those of their triangles are another problem.
    if (quads && source.in_plane()) cut = cut_into_triangles(source);
    if (quads && !cut) return result;
    const Surface& surface = cut ? *cut : source;
    if (source.mesh.face_count() > options.most_faces_for_pairs) return result;
    try {
        take(result, Bound::Kind::moduli, moduli_bound(surface, map, result.factorizations));
        take(result, Bound::Kind::pair, best_pair(surface, boundary, map, options.pair, result.factorizations));
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;  // shapes beyond floating point prove nothing
    }
    return result;
}

ProvedBounds bounds_of_map(const Surface& source, const Eigen::VectorXcd& map) {
    require_disk(source);
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) boundary.pin(v, map[v]);
    require_feasible(source, boundary);
    ProvedBoundsOptions options;
    options.most_faces_for_pairs = std::numeric_limits<int>::max();
    options.exact_polygons = true;
    ProvedBounds result = proved_bounds(source, boundary, map, options);
    const Distortion measured = distortion(source.operators, map);
    if (measured.flipped.empty() && measured.degenerate.empty()) {
        const AttainedDilatation attained = attained_dilatation(source, map, measured);
        result.bounds.push_back({Bound::Kind::attained, attained.K, Bound::Of::extremal, attained.rigorous});
    }
    return result;
}

}  // namespace beltrami
