#include <beltrami/registration/curve_start.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/curves/cut_along.h>
#include <beltrami/homotopy/twist.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr double kUnfolded = 1e-3;  // tolerance of opened folds
constexpr int kMostUnfoldingSteps = 200;
constexpr double kAnywhere = 2;  // diameters: folds may lead into the holes of a chart

/// A surface cut open, and its parts.
struct Parts {
    MeshCutOpen cut;
    std::vector<Submesh> parts;
    std::vector<int> part_of_face;
    std::vector<int> index;  ///< of a vertex of the cut mesh in its part

    explicit Parts(const MeshWithCurves& whole) : cut(cut_along(whole.mesh, whole.curves)) {
        part_of_face.resize(static_cast<std::size_t>(cut.mesh.face_count()));
        index.resize(cut.vertices.size());
        for (const std::vector<int>& faces : component_faces(cut.mesh)) {
            for (const int f : faces) part_of_face[f] = static_cast<int>(parts.size());
            parts.push_back(keep_faces(cut.mesh, faces));
            for (std::size_t i = 0; i < parts.back().vertices.size(); ++i)
                index[parts.back().vertices[i]] = static_cast<int>(i);
        }
    }
    int part_beside(std::size_t curve, bool left) const {
        return part_of_face[left ? cut.left_face[curve] : cut.right_face[curve]];
    }
    const std::vector<int>& side(std::size_t curve, bool left) const {
        return left ? cut.left[curve] : cut.right[curve];
    }
};

[[noreturn]] void refuse(const std::string& what) {
    throw Error(Cause::bad_boundary, what, "check that every curve and its partner run the same way");
}

/// The part of the target for every part of the source.
std::vector<int> partners(const Parts& source, const Parts& target, std::size_t curves) {
    std::vector<int> partner(source.parts.size(), -1), taken(target.parts.size(), -1);
    for (std::size_t c = 0; c < curves; ++c)
        for (const bool left : {true, false}) {
            const int a = source.part_beside(c, left), b = target.part_beside(c, left);
            if ((partner[a] >= 0 && partner[a] != b) || (taken[b] >= 0 && taken[b] != a))
                refuse("curve " + std::to_string(c + 1) + " divides the two surfaces in different ways");
            partner[a] = b;
            taken[b] = a;
        }
    return partner;
}

/// With its folds opened, as far as that goes.
Eigen::VectorXcd opened(const Surface& source, Eigen::VectorXcd map) {
    if (distortion(source.operators, map).flipped.empty()) return map;
    FoldFreeOptions options;
    options.tolerance = kUnfolded;
    options.max_iterations = kMostUnfoldingSteps;
    return fold_free_map(source, dirichlet_freedoms(source), Eigen::VectorXcd::Zero(source.operators.sample_count()),
                         map, options)
        .map;
}

/// Of a part with holes: what its loops' images leave open is how often it turns around each of them. The map that
/// turns least, of rings the one that is least distorted.
std::optional<Eigen::VectorXcd> map_with_holes(const Surface& source, const BoundaryCondition& boundary,
                                               int outer_loop) {
    const auto loops = source.topology.boundary_loops.size();
    const Eigen::VectorXcd own = circle_domain_chart(source, outer_loop).chart.vertices;
    std::optional<Eigen::VectorXcd> best;
    std::size_t fewest = 0;
    double least = 0;
    for (const int turns : loops == 2 ? std::vector{0, -1, 1} : std::vector{0}) {
        try {
            Eigen::VectorXcd map =
                opened(source, start_in_class(source, own, outer_loop, boundary, std::vector<int>(loops, turns)).map);
            const Distortion d = distortion(source.operators, map);
            if (best && std::pair(d.flipped.size(), d.mean) >= std::pair(fewest, least)) continue;
            fewest = d.flipped.size();
            least = d.mean;
            best = std::move(map);
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved && error.cause() != Cause::bad_boundary) throw;
        }
    }
    return best;
}

/// @param outer_loop whose image is the unit circle
Eigen::VectorXcd map_of_part(const Surface& source, const BoundaryCondition& boundary, int outer_loop) {
    int factorizations = 0;
    if (const auto map = convex_embedding(source, boundary, factorizations)) return *map;
    if (source.topology.boundary_loops.size() > 1)
        if (const auto map = map_with_holes(source, boundary, outer_loop)) return *map;
    return convex_combination_map(source, boundary, ConvexWeights::mean_value);
}

/// The loop on which a vertex lies.
int loop_with(const Topology& topology, int vertex) {
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l) {
        const std::vector<int>& loop = topology.boundary_loops[l];
        if (std::find(loop.begin(), loop.end(), vertex) != loop.end()) return static_cast<int>(l);
    }
    return 0;
}

}  // namespace

PlaceOnCurve partner_place(const MeshWithCurves::Chain& curve, std::size_t vertex,
                           const MeshWithCurves::Chain& partner) {
    const std::size_t given = curve.given.size(), pieces = given - (curve.closed ? 0 : 1);
    std::size_t piece = 0;
    while (piece + 1 < pieces && curve.given[piece + 1] <= static_cast<int>(vertex)) ++piece;
    const auto bounds = [&](const MeshWithCurves::Chain& chain) {
        const double first = chain.lengths[chain.given[piece]];
        return std::array{first, piece + 1 < given ? chain.lengths[chain.given[piece + 1]] : chain.length};
    };
    const auto [a, b] = bounds(curve);
    const auto [from, to] = bounds(partner);
    const double at = from + (to - from) * (b > a ? (curve.lengths[vertex] - a) / (b - a) : 0.0);
    const std::size_t segments = partner.vertices.size() - (partner.closed ? 0 : 1);
    std::size_t segment = partner.given[piece];
    const auto end = [&](std::size_t i) {
        return i + 1 < partner.lengths.size() ? partner.lengths[i + 1] : partner.length;
    };
    while (segment + 1 < segments && end(segment) <= at) ++segment;
    const double length = end(segment) - partner.lengths[segment];
    return {segment, std::clamp(length > 0 ? (at - partner.lengths[segment]) / length : 0.0, 0.0, 1.0)};
}

std::vector<MeshPoint> map_cut_along_curves(const MeshWithCurves& source, const MeshWithCurves& target) {
    const std::size_t curves = source.curves.size();
    for (const MeshWithCurves* whole : {&source, &target})
        for (std::size_t c = 0; c < curves; ++c)
            if (whole->curves[c].vertices.size() < 3)
                throw Error(Cause::bad_boundary, "curve " + std::to_string(c + 1) + " is a single edge",
                            "refine the mesh there, or take points that are farther apart",
                            {Things::vertices, whole->curves[c].vertices});
    const Parts from(source), to(target);
    const std::vector<int> partner = partners(from, to, curves);
    if (from.parts.size() != to.parts.size())
        refuse("the curves divide the two surfaces into different numbers of parts");
    std::vector<MeshPoint> places(static_cast<std::size_t>(source.mesh.vertex_count()));
    for (std::size_t p = 0; p < from.parts.size(); ++p) {
        const Surface here(from.parts[p].mesh), there(to.parts[partner[p]].mesh);
        if (here.topology.boundary_loops.size() != there.topology.boundary_loops.size())
            refuse("the curves divide the two surfaces in different ways");
        const CircleDomainChart chart = circle_domain_chart(there);
        BoundaryCondition boundary;
        std::map<int, Complex> images;
        for (std::size_t c = 0; c < curves; ++c)
            for (const bool left : {true, false}) {
                if (from.part_beside(c, left) != static_cast<int>(p)) continue;
                const std::vector<int>&mine = from.side(c, left), &its = to.side(c, left);
                for (std::size_t i = 0; i < mine.size(); ++i) {
                    const auto [segment, part] = partner_place(source.curves[c], i, target.curves[c]);
                    const Complex a = chart.chart.vertices[to.index[its[segment]]],
                                  b = chart.chart.vertices[to.index[its[(segment + 1) % its.size()]]];
                    images[from.index[mine[i]]] = (1 - part) * a + part * b;
                }
            }
        int outer = -1;  // a vertex that goes to the unit circle, the outermost of all
        double farthest = 0;
        for (const auto& [vertex, image] : images) {
            boundary.pin(vertex, image);
            if (std::abs(image) > farthest) farthest = std::abs(image), outer = vertex;
        }
        const Eigen::VectorXcd map = map_of_part(here, boundary, loop_with(here.topology, outer));
        const std::vector<MeshPoint> found =
            locate_in_chart(there, chart.chart.vertices, std::vector<Complex>(map.begin(), map.end()), kAnywhere);
        for (std::size_t i = 0; i < found.size(); ++i) {
            MeshPoint place = found[i];
            place.face = to.parts[partner[p]].faces[place.face];
            for (int& v : place.vertices) v = to.cut.vertices[to.parts[partner[p]].vertices[v]];
            places[from.cut.vertices[from.parts[p].vertices[i]]] = place;
        }
    }
    return places;
}

}  // namespace beltrami
