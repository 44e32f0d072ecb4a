#include <beltrami/teichmuller/class_search.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/hyperbolic/cut_marking.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/snap.h>
#include <beltrami/meshing/edge_collapse.h>

namespace beltrami {

namespace {

constexpr double kSoundWords = 1e-4;  // defect of a start
constexpr int kMostDraws = 40;        // of roots, for one start
constexpr double kRoughly = 1e-2;     // largest displacement in the last step of a harmonic map on the way
constexpr double kExactly = 1e-6;     // and of the last one
constexpr double kSmallJump = 1e-3;   // of a step that is snapped
constexpr int kRoots = 12;            // from which short curves are sought
constexpr std::size_t kCurves = 16;   // about which twists go
constexpr std::size_t kBeam = 300;    // classes kept
constexpr int kDepth = 25;            // twists
constexpr int kPatience = 4;          // more twists than the best class took, without a better one
constexpr double kSameLength = 0.1;   // of curves

/// A simple closed path of vertices and how long the geodesic in its class is.
struct Curve {
    double length;
    std::vector<int> path;
};

/// A closed path through a root less the way to it, which it goes back along.
std::vector<int> without_tail(std::vector<int> path) {
    std::size_t common = 0;
    while (2 * (common + 1) < path.size() && path[common + 1] == path[path.size() - 1 - common]) ++common;
    return {path.begin() + static_cast<std::ptrdiff_t>(common), path.end() - static_cast<std::ptrdiff_t>(common)};
}

std::vector<Curve> short_curves(const HyperbolicShape& shape, Random& random) {
    const IntrinsicTriangulation& triangulation = shape.metric().original;
    const std::vector<double> lengths = edge_lengths(shape.surface().topology, shape.metric());
    std::map<std::vector<int>, Curve> found;  // by homology class and length
    for (int i = 0; i < kRoots; ++i) {
        const int root = static_cast<int>(random.uniform(0, shape.surface().mesh.vertex_count()));
        const CutTree tree = short_cut_tree(triangulation, lengths, root);
        const std::vector<DiskIsometry> generators = generator_isometries(triangulation, tree, shape.metric().steps);
        const std::vector<std::vector<int>> paths = generator_paths(triangulation, tree);
        for (std::size_t j = 0; j < paths.size(); ++j) {
            Curve curve{generators[j].translation_length(), without_tail(paths[j])};
            if (std::set<int>(curve.path.begin(), curve.path.end()).size() != curve.path.size()) continue;
            const Eigen::VectorXi of = homology_class(shape.surface().topology, shape.forms().homology, curve.path);
            std::vector<int> key(of.begin(), of.end()), opposite;
            for (const int x : key) opposite.push_back(-x);
            key = std::max(key, opposite);
            key.push_back(static_cast<int>(std::lround(curve.length / kSameLength)));
            const auto at = found.find(key);
            if (at == found.end() || curve.length < at->second.length) found[key] = std::move(curve);
        }
    }
    std::vector<Curve> curves;
    for (auto& [key, curve] : found) curves.push_back(std::move(curve));
    std::ranges::stable_sort(curves, {}, &Curve::length);
    if (curves.size() > kCurves) curves.resize(kCurves);
    return curves;
}

/// A twist of a curve: its number, to the left or to the right.
struct Turn {
    std::size_t curve;
    int turns;
};

/// What a twist to the left about every curve does to the loops of the source.
std::vector<Eigen::MatrixXi> actions(const HyperbolicShape& shape, const std::vector<Curve>& curves) {
    const Surface& surface = shape.surface();
    const HomologyBasis& homology = shape.forms().homology;
    EquivariantMap identity;
    identity.steps.resize(static_cast<std::size_t>(surface.topology.edge_count()));
    identity.classes = homology.cochains;
    std::vector<Eigen::MatrixXi> result;
    result.reserve(curves.size());
    for (const Curve& curve : curves)
        result.push_back(periods_of_images(
            surface.topology, twisted(surface, shape.metric().original, identity, curve.path, 1), homology.loops));
    return result;
}

/// The shortest word of twists that leads to the least homology bound that a beam search finds.
std::vector<Turn> best_word(const HyperbolicShape& source, const HyperbolicShape& target,
                            const std::vector<Eigen::MatrixXi>& actions, const Eigen::MatrixXi& start) {
    struct Node {
        double bound;
        Eigen::MatrixXi homology;
        std::vector<Turn> word;
    };
    std::vector<std::array<Eigen::MatrixXi, 2>> both;
    for (const Eigen::MatrixXi& left : actions)
        both.push_back({left, left.cast<double>().inverse().array().round().matrix().cast<int>()});
    std::set<std::vector<int>> seen;
    const auto is_new = [&](const Eigen::MatrixXi& homology) {
        std::vector<int> key(homology.reshaped().begin(), homology.reshaped().end()), opposite;
        for (const int x : key) opposite.push_back(-x);
        return seen.insert(std::max(key, opposite)).second;
    };
    std::vector<Node> beam{{homology_bound(source, target, start), start, {}}};
    Node best = beam[0];
    is_new(start);
    for (int depth = 1; depth <= kDepth; ++depth) {
        std::vector<Node> next;
        for (const Node& node : beam)
            for (std::size_t curve = 0; curve < both.size(); ++curve)
                for (const int turns : {1, -1}) {
                    Eigen::MatrixXi homology = both[curve][turns > 0 ? 0 : 1] * node.homology;
                    if (!is_new(homology)) continue;
                    const double bound = homology_bound(source, target, homology);
                    next.push_back({bound, std::move(homology), node.word});
                    next.back().word.push_back({curve, turns});
                }
        std::ranges::stable_sort(next, {}, &Node::bound);
        if (next.size() > kBeam) next.resize(kBeam);
        beam = std::move(next);
        if (beam.empty()) break;
        if (beam[0].bound < best.bound * (1 - 1e-9))
            best = beam[0];
        else if (depth > static_cast<int>(best.word.size()) + kPatience)
            break;
    }
    return best.word;
}

/// What is needed of a source for starts onto a target.
class Searcher {
  public:
    Searcher(const HyperbolicShape& source, const HyperbolicShape& target, std::uint64_t seed)
        : source_(source),
          target_(target),
          random_(seed),
          curves_(short_curves(source, random_)),
          actions_(actions(source, curves_)),
          source_lengths_(edge_lengths(source.surface().topology, source.metric())),
          target_lengths_(edge_lengths(target.surface().topology, target.metric())),
          step_(source.surface(), blank()) {}

    struct Found {
        ClassSearch::Reached reached;
        EquivariantMap map;
    };
    /// One start; nothing where rounding has spoiled it.
    std::optional<Found> run() {
        std::optional<EquivariantMap> map = draw();
        if (!map || !settle(*map, kRoughly)) return {};
        const Surface& surface = source_.surface();
        const auto& loops = source_.forms().homology.loops;
        std::vector<Turn> word;
        try {
            word = best_word(source_, target_, actions_, periods_of_images(surface.topology, *map, loops));
        } catch (const Error& error) {
            if (error.cause() != Cause::bad_option) throw;
            return {};
        }
        for (const Turn& turn : word) {
            map = twisted(surface, source_.metric().original, std::move(*map), curves_[turn.curve].path, turn.turns);
            if (!settle(*map, kRoughly)) return {};
        }
        if (!settle(*map, kExactly)) return {};
        Found found;
        found.reached.homology = periods_of_images(surface.topology, *map, loops);
        found.reached.homology_bound = homology_bound(source_, target_, found.reached.homology);
        found.reached.energy = step_.energy();
        found.reached.twists = static_cast<int>(word.size());
        found.map = std::move(*map);
        return found;
    }

  private:
    EquivariantMap blank() const {
        EquivariantMap map;
        map.steps.resize(static_cast<std::size_t>(source_.surface().topology.edge_count()));
        map.bases.assign(static_cast<std::size_t>(source_.surface().mesh.vertex_count()), 0);
        map.frames.resize(map.bases.size());
        return map;
    }
    std::optional<EquivariantMap> draw() {
        const auto vertex = [&](const Surface& of) {
            const std::vector<int>& corners = of.mesh.faces.vertices();
            return corners[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(corners.size())))];
        };
        for (int i = 0; i < kMostDraws; ++i) {
            const int here = vertex(source_.surface()), there = vertex(target_.surface());
            Marking marking = marking_by_cutting(source_.surface(), source_.metric().original, source_lengths_, here,
                                                 target_.group(), target_lengths_, there);
            if (marking.defect < kSoundWords) return std::move(marking.map);
        }
        return {};
    }
    /// To the harmonic map, its steps exact again.
    bool settle(EquivariantMap& map, double tolerance) {
        try {
            step_.set_map(std::move(map));
            step_.relax(tolerance);
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved) throw;
            return false;
        }
        map = step_.map();
        if (!(snap_to_target(source_.surface(), target_.metric(), map) < kSmallJump)) return false;
        step_.set_map(map);
        return flatness(source_.surface(), map).maxCoeff() < kSmallJump;
    }

    const HyperbolicShape &source_, &target_;
    Random random_;
    std::vector<Curve> curves_;
    std::vector<Eigen::MatrixXi> actions_;
    std::vector<double> source_lengths_, target_lengths_;
    EquivariantMapStep step_;
};

/// A coarse mesh of a surface.
struct Coarse {
    CollapsedMesh collapsed;
    Surface surface;
    HyperbolicShape shape;

    Coarse(const Mesh& mesh, int vertices)
        : collapsed(collapse_edges(mesh, vertices)), surface(collapsed.mesh), shape(surface) {}
    Coarse(const Coarse&) = delete;
};

/// A map of the coarse mesh as one of the surface itself, whose vertices lie together with those they were moved onto.
EquivariantMap on_all_vertices(const Surface& surface, const Coarse& coarse, const EquivariantMap& map) {
    const std::vector<int>& images = coarse.collapsed.images;
    EquivariantMap result;
    result.classes = Eigen::MatrixXi::Zero(surface.topology.edge_count(), map.classes.cols());
    for (int e = 0; e < surface.topology.edge_count(); ++e) {
        const auto [v, w] = surface.topology.edges[static_cast<std::size_t>(e)];
        const int a = images[v], b = images[w];
        if (a == b) {
            result.steps.emplace_back();
            continue;
        }
        const int edge = edge_between(coarse.surface.topology, a, b);
        const DiskIsometry& step = map.steps[static_cast<std::size_t>(edge)];
        result.steps.push_back(a < b ? step : step.inverse());
        result.classes.row(e) = (a < b ? 1 : -1) * map.classes.row(edge);
    }
    for (const int v : images) {
        result.bases.push_back(v < 0 ? map.bases[0] : map.bases[v]);
        result.frames.push_back(v < 0 ? DiskIsometry{} : map.frames[v]);
    }
    return result;
}

}  // namespace

ClassSearch search_class(const HyperbolicShape& source, const HyperbolicShape& target,
                         const ClassSearchOptions& options) {
    if (options.starts < 1) throw Error(Cause::bad_option, "a search needs a start");
    require_triangles(source.surface());
    if (source.metric().has_boundary() || target.metric().has_boundary())
        throw Error(Cause::bad_mesh, "classes are sought between closed surfaces, and these have a boundary",
                    "tell the class by a start");
    if (source.metric().genus != target.metric().genus)
        throw Error(Cause::bad_mesh, "the surfaces have different genera", "take surfaces of one genus");
    // A surface with a metric of its own is taken as it is: its vertices do not tell its shape.
    std::optional<Coarse> coarse;
    if (!source.surface().metric && source.surface().mesh.vertex_count() > options.vertices)
        coarse.emplace(source.surface().mesh, options.vertices);
    Searcher searcher(coarse ? coarse->shape : source, target, options.seed);
    ClassSearch result;
    std::optional<EquivariantMap> best;
    for (int i = 0; i < options.starts; ++i) {
        if (std::optional<Searcher::Found> found = searcher.run()) {
            if (result.reached.empty() || found->reached.energy < result.reached[0].energy)
                best = std::move(found->map);
            result.reached.push_back(std::move(found->reached));
            std::ranges::stable_sort(result.reached, {}, &ClassSearch::Reached::energy);
        } else {
            ++result.failed;
        }
        if (options.progress && !options.progress(i + 1, options.starts)) throw Error(Cause::cancelled, "cancelled");
    }
    if (!best)
        throw Error(Cause::not_solved,
                    "no class was found: from " + std::to_string(options.starts) +
                        " starts the words of loops were too long for double precision",
                    "tell the class by loops or by a start, or allow more starts");
    result.map = coarse ? on_all_vertices(source.surface(), *coarse, *best) : std::move(*best);
    return result;
}

}  // namespace beltrami
