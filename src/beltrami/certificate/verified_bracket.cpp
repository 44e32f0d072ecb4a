#include <beltrami/certificate/verified_bracket.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/certificate/edge_corner_bound.h>
#include <beltrami/certificate/edge_split.h>
#include <beltrami/certificate/one_sided.h>
#include <beltrami/certificate/period_pair.h>
#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// Cone points count where they stretch a smooth map by more than this part of K* − 1.
constexpr double kConesMatter = 0.25;
/// Boundary vertices whose corner bound is larger are kinks.
constexpr double kKink = 1.02;
/// Triangles in this upper part of what exceeds the goal are refined.
constexpr double kRefined = 0.3;
/// Rounding of the bounds.
constexpr double kRounding = 1e-12;

struct MapLevel {
    Surface surface;
    BoundaryCondition boundary;
};

class Bracketing {
  public:
    Bracketing(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
               const VerifiedBracketOptions& options)
        : options_(options), level_{source, boundary}, map_(straight(source, map)) {
        result_K_lower_ = options.K_lower;
    }

    VerifiedBracket run() {
        choose_cones();
        double last_gaps[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        std::string reason;
        bool reached = false;
        for (int round = 0;; ++round) {
            const QuadraticSpace space(level_.surface, cones_);
            improve(space);
            if (K_upper_ > (1 + options_.gap) * result_K_lower_) raise_lower(space);
            const double gap = K_upper_ / result_K_lower_ - 1;
            reached = gap <= options_.gap;
            if (reached) break;
            const int faces = level_.surface.mesh.face_count();
            if (round >= options_.most_rounds) {
                reason = "after " + std::to_string(round) + " refinements, which is the limit";
                break;
            }
            if (faces >= options_.most_triangles) {
                reason = "the refined mesh has " + std::to_string(faces) + " triangles, more than the limit of " +
                         std::to_string(options_.most_triangles);
                break;
            }
            if (round >= 2 && gap > (1 - options_.least_progress) * last_gaps[0]) {
                reason = "two refinements did not lower it noticeably";
                break;
            }
            last_gaps[0] = last_gaps[1];
            last_gaps[1] = gap;
            refine(space);
            ++refinements_;
        }
        VerifiedBracket result{result_K_lower_,
                               K_upper_,
                               reached,
                               std::move(reason),
                               std::move(level_.surface),
                               std::move(level_.boundary),
                               cones_,
                               map_,
                               refinements_,
                               factorizations_,
                               pair_};
        return result;
    }

  private:
    void choose_cones() {
        const double least = 1 + kConesMatter * (std::max(options_.K_lower, 1 + options_.gap) - 1);
        std::vector<char> is_cone(static_cast<std::size_t>(level_.surface.mesh.vertex_count()), 0);
        for (const ConePoint& cone : cone_points(level_.surface)) {
            if (cone.stretch <= least) continue;
            cones_.push_back(cone.vertex);
            is_cone[cone.vertex] = 1;
        }
        // Pins have the power of their own; and no two cone points may share a triangle.
        for (const int v : level_.boundary.vertices)
            if (is_cone[v]) std::erase(cones_, v);
        bool neighbours = false;
        for (const auto& [a, b] : level_.surface.topology.edges) neighbours = neighbours || (is_cone[a] && is_cone[b]);
        if (!neighbours) return;
        const QuadraticSpace space(level_.surface, {});
        split(space, std::vector<char>(static_cast<std::size_t>(level_.surface.topology.edge_count()), 1));
    }

    std::vector<char> held() const {
        const Topology& topology = level_.surface.topology;
        const int vertices = level_.surface.mesh.vertex_count();
        std::vector<char> result(static_cast<std::size_t>(vertices + topology.edge_count()), 0);
        for (int v = 0; v < vertices; ++v) result[v] = topology.on_boundary[v];
        for (const int v : level_.boundary.vertices) result[v] = 1;
        const std::vector<EdgeConstraint> inner = edge_constraints(level_.boundary, level_.surface);
        for (int e = 0; e < topology.edge_count(); ++e)
            if (topology.edge_faces[e][0] < 0 || topology.edge_faces[e][1] < 0 || inner[e] == EdgeConstraint::pinned)
                result[vertices + e] = 1;
        return result;
    }

    void improve(const QuadraticSpace& space) {
        OneSidedDescent descent(level_.surface, space, held());
        OneSidedDescent::Options options;
        options.least = k_of(result_K_lower_);
        options.wanted = k_of((1 + options_.gap) * result_K_lower_);
        const double k = descent.run(map_, options);
        factorizations_ += descent.factorizations();
        K_upper_ = k < 1 ? dilatation(k) * (1 + kRounding) : std::numeric_limits<double>::infinity();
    }

    /// Pairs on the midpoint subdivision, which the nodes of the map move.
    void raise_lower(const QuadraticSpace& space) {
        const SplitEdges fine =
            split_edges(level_.surface, level_.boundary,
                        std::vector<char>(static_cast<std::size_t>(level_.surface.topology.edge_count()), 1));
        const QuadraticMap nodes = prolonged(space, fine).head(fine.surface.mesh.vertex_count());
        const bool has_holes = level_.surface.topology.boundary_loops.size() > 1;
        const auto take = [&](const std::optional<BoundaryImage>& image, const std::vector<int>& branches) {
            if (!image) return;
            const PairBound bound = has_holes ? period_pair_bound(fine.surface, *image, options_.pair)
                                              : pair_bound(fine.surface, *image, branches, options_.pair);
            factorizations_ += bound.factorizations;
            pair_ = std::max(pair_, bound.K);
        };
        const std::optional<BoundaryImage> own = image_under(fine.surface, nodes);
        take(own ? own : filled_image(fine.surface, nodes), {});
        std::vector<int> pins;
        for (const int v : level_.boundary.vertices)
            if (!level_.surface.topology.on_boundary[v]) pins.push_back(v);
        if (!pins.empty() && !has_holes) take(own, pins);
        result_K_lower_ = std::max(result_K_lower_, pair_);
    }

    /// The same map on a refined mesh.
    QuadraticMap prolonged(const QuadraticSpace& space, const SplitEdges& fine) const {
        const Surface& surface = fine.surface;
        const int vertices = surface.mesh.vertex_count();
        QuadraticMap result = QuadraticMap::Zero(vertices + surface.topology.edge_count());
        for (int f = 0; f < surface.mesh.face_count(); ++f)
            for (int c = 0; c < 3; ++c) {
                const auto &here = fine.places[3 * f + c], &next = fine.places[3 * f + (c + 1) % 3];
                std::array<double, 3> middle{};
                for (int i = 0; i < 3; ++i) middle[i] = 0.5 * (here[i] + next[i]);
                result[surface.mesh.faces[f][c]] = space.value(map_, fine.parents[f], here);
                result[vertices + surface.topology.corner_edges[3 * f + c]] =
                    space.value(map_, fine.parents[f], middle);
            }
        return result;
    }

    void split(const QuadraticSpace& space, const std::vector<char>& marked) {
        SplitEdges fine = split_edges(level_.surface, level_.boundary, marked);
        map_ = prolonged(space, fine);
        level_ = {std::move(fine.surface), std::move(fine.boundary)};
    }

    /// Marks an edge unless it ends at a cone point: power elements are halved only across their sectors.
    void mark(std::vector<char>& marked, int edge, const std::vector<char>& is_cone) const {
        const auto& [a, b] = level_.surface.topology.edges[edge];
        if (!is_cone[a] && !is_cone[b]) marked[edge] = 1;
    }
    std::vector<char> cone_flags() const {
        std::vector<char> flags(static_cast<std::size_t>(level_.surface.mesh.vertex_count()), 0);
        for (const int v : cones_) flags[v] = 1;
        return flags;
    }

    void refine(const QuadraticSpace& space) {
        const std::vector<double> bounds = space.bounds(map_);
        const double wanted = k_of((1 + options_.gap) * result_K_lower_);
        const double largest = std::min(1.0, *std::max_element(bounds.begin(), bounds.end()));
        const double limit = std::max(wanted, largest - (1 - kRefined) * (largest - wanted));
        const FaceList& faces = level_.surface.mesh.faces;
        const std::vector<double> kinks =
            edge_corner_bounds(level_.surface, map_.head(level_.surface.mesh.vertex_count()));
        std::vector<char> singular(kinks.size(), 0), star(kinks.size(), 0);
        for (std::size_t v = 0; v < kinks.size(); ++v) singular[v] = kinks[v] > kKink;
        for (const int v : level_.boundary.vertices)
            if (!level_.surface.topology.on_boundary[v]) singular[v] = 1;
        std::vector<char> marked(static_cast<std::size_t>(level_.surface.topology.edge_count()), 0);
        const std::vector<char> is_cone = cone_flags();
        for (int f = 0; f < faces.size(); ++f) {
            if (!(bounds[f] > limit)) continue;
            bool at_singular = false;
            for (const int v : faces[f])
                if (singular[v]) {
                    star[v] = 1;
                    at_singular = true;
                }
            if (at_singular) continue;
            for (int c = 0; c < 3; ++c) mark(marked, level_.surface.topology.corner_edges[3 * f + c], is_cone);
        }
        const bool stars = std::find(star.begin(), star.end(), 1) != star.end();
        if (std::find(marked.begin(), marked.end(), 1) != marked.end() || !stars) split(space, marked);
        for (int pass = 0; stars && pass < 2; ++pass) split_stars(star, pass == 1);
    }

    /// Halves the edges opposite some vertices, or those that end there.
    void split_stars(const std::vector<char>& star, bool spokes) {
        const QuadraticSpace space(level_.surface, cones_);
        const FaceList& faces = level_.surface.mesh.faces;
        const std::vector<char> is_cone = cone_flags();
        std::vector<char> marked(static_cast<std::size_t>(level_.surface.topology.edge_count()), 0);
        for (int f = 0; f < faces.size(); ++f)
            for (int c = 0; c < 3; ++c) {
                const auto v = static_cast<std::size_t>(faces[f][c]);
                if (v >= star.size() || !star[v]) continue;
                const auto edge = [&](int i) { return level_.surface.topology.corner_edges[3 * f + i % 3]; };
                if (spokes) {
                    mark(marked, edge(c), is_cone);
                    mark(marked, edge(c + 2), is_cone);
                } else {
                    mark(marked, edge(c + 1), is_cone);
                }
            }
        split(space, marked);
    }

    VerifiedBracketOptions options_;
    MapLevel level_;
    QuadraticMap map_;
    std::vector<int> cones_;
    double result_K_lower_ = 1, K_upper_ = std::numeric_limits<double>::infinity(), pair_ = 1;
    int refinements_ = 0, factorizations_ = 0;
};

}  // namespace

VerifiedBracket verified_bracket(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                                 const VerifiedBracketOptions& options) {
    return Bracketing(source, boundary, map, options).run();
}

}  // namespace beltrami
