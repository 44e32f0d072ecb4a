#include <beltrami/registration/register_handles.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <beltrami/base/error.h>
#include <beltrami/forms/delaunay_forms.h>
#include <beltrami/teichmuller/naming.h>

namespace beltrami {

namespace {

constexpr double kSameEnergy = 1e-4;  // relative, of harmonic maps in one class

EquivariantMap twisted_by(const Surface& source, const IntrinsicTriangulation& triangulation, EquivariantMap map,
                          const std::vector<HandleMarking::Twist>& twists) {
    for (const HandleMarking::Twist& twist : twists)
        map = twisted(source, triangulation, std::move(map), twist.path, twist.turns);
    return map;
}

/// The class that is asked for.
Marking choose(const Surface& source, const IntrinsicTriangulation& triangulation, const Mesh& target,
               const FaceList& triangles, const EdgeGroup& group, const HandleMarking& wanted) {
    Marking marking;
    if (!wanted.paths.empty() || !wanted.images.empty()) {
        if (wanted.start)
            throw Error(Cause::bad_option, "a class is told by loops or by a start, not by both", "give one of them");
        marking = marking_by_loops(source, triangulation, group, wanted.paths, wanted.images);
    } else {
        const Positions near = wanted.start ? *wanted.start : aligned(source.mesh, target, wanted.alignment);
        marking = marking_by_vertices(source, triangulation, group,
                                      nearest_vertices(source.topology, group.topology, target, triangles, near));
    }
    marking.map = twisted_by(source, triangulation, std::move(marking.map), wanted.twists);
    return marking;
}

/// Points of the given vertices, and of those added the means of theirs.
Positions with_means(const Positions& points, const SplitProblem& split) {
    Positions result(points.rows() + static_cast<Eigen::Index>(split.parents.size()), points.cols());
    result.topRows(points.rows()) = points;
    for (std::size_t i = 0; i < split.parents.size(); ++i)
        result.row(points.rows() + static_cast<Eigen::Index>(i)) =
            0.5 * (points.row(split.parents[i][0]) + points.row(split.parents[i][1]));
    return result;
}

/// A closed path of the given vertices, over the midpoints of edges that were split.
std::vector<int> over_midpoints(const std::vector<int>& path, const SplitProblem& split) {
    const int given = split.mesh.vertex_count() - static_cast<int>(split.parents.size());
    std::map<std::array<int, 2>, int> midpoints;
    for (std::size_t i = 0; i < split.parents.size(); ++i) {
        const auto [low, high] = std::minmax(split.parents[i][0], split.parents[i][1]);
        midpoints[{low, high}] = given + static_cast<int>(i);
    }
    std::vector<int> result;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto [low, high] = std::minmax(path[i], path[(i + 1) % path.size()]);
        result.push_back(path[i]);
        if (const auto found = midpoints.find({low, high}); found != midpoints.end()) result.push_back(found->second);
    }
    return result;
}

/// How far the class that was sought may be trusted.
void warn_of_search(const ClassSearch& search, HyperbolicMap& map) {
    const double least = search.reached[0].energy;
    const auto alike = std::ranges::count_if(
        search.reached, [&](const ClassSearch::Reached& other) { return other.energy < least * (1 + kSameEnergy); });
    map.warnings.push_back({WarningKind::start, "the class was sought from " +
                                                    std::to_string(search.reached.size() + search.failed) +
                                                    " starts, of which " + std::to_string(alike) +
                                                    " led to the least energy; no optimum over all classes is proved"});
}

IntrinsicTriangulation triangulation_of(const Surface& surface, const FlatTorus& torus) {
    const TriangleMetric& metric = torus.forms->metric;
    return {metric.triangles, surface.mesh.vertex_count(), metric.log_lengths};
}

/// Where the generators of a torus go, from the periods of the target's forms around the images of the source's loops.
TorusMarking marking_of_periods(const FlatTorus& source, const FlatTorus& target, const Eigen::MatrixXi& periods) {
    const Eigen::Matrix2d to = target.generators.cast<double>();
    const Eigen::Matrix2d images = periods.transpose().cast<double>() * source.generators.cast<double>();
    const Eigen::Matrix2d in_generators = to.inverse() * images;
    return in_generators.array().round().matrix().cast<int>();
}

std::vector<int> nearest_vertices(const std::vector<MeshPoint>& places) {
    std::vector<int> result;
    result.reserve(places.size());
    for (const MeshPoint& place : places) {
        const auto largest = std::max_element(place.barycentric.begin(), place.barycentric.end());
        result.push_back(place.vertices[static_cast<std::size_t>(largest - place.barycentric.begin())]);
    }
    return result;
}

/// Maps between every two of some shapes, as the vertices nearest to the images of vertices.
struct PairwiseMaps {
    std::vector<std::unique_ptr<const HyperbolicShape>> shapes;
    std::map<std::array<int, 2>, std::vector<int>> images;

    std::vector<int> nearest(int i, int j, Alignment alignment) const {
        const Surface &source = shapes[i]->surface(), &target = shapes[j]->surface();
        return nearest_vertices(source.topology, target.topology, target.mesh, shapes[j]->metric().metric.triangles,
                                aligned(source.mesh, target.mesh, alignment));
    }
    /// Over a third shape to which and from which maps are known; empty: there is none.
    std::vector<int> over_another(int i, int j) const {
        for (std::size_t s = 0; s < shapes.size(); ++s) {
            const auto k = static_cast<int>(s);
            const auto to = images.find({i, k}), from = images.find({k, j});
            if (to == images.end() || from == images.end()) continue;
            std::vector<int> result;
            result.reserve(to->second.size());
            for (const int v : to->second) result.push_back(from->second[static_cast<std::size_t>(v)]);
            return result;
        }
        return {};
    }
    EquivariantMap by_vertices(int i, int j, const std::vector<int>& to) const {
        const HyperbolicShape &a = *shapes[i], &b = *shapes[j];
        return marking_by_vertices(a.surface(), a.metric().original, b.group(), to).map;
    }
    Distance distance(int i, int j, EquivariantMap start) {
        const HyperbolicShape &a = *shapes[i], &b = *shapes[j];
        const HyperbolicMap there = hyperbolic_map(a, b, std::move(start));
        const HyperbolicMap back = hyperbolic_map(b, a, inverse_marking(a, b, there).map);
        images[{i, j}] = nearest_vertices(there.places);
        images[{j, i}] = nearest_vertices(back.places);
        return hyperbolic_distance_of(there, back);
    }
};

}  // namespace

HandleRegistration register_handles(const HyperbolicShape& source, const HyperbolicShape& target,
                                    const HandleMarking& marking, const HyperbolicMapOptions& options) {
    const IntrinsicTriangulation& triangulation = source.metric().original;
    std::optional<ClassSearch> search;
    Marking chosen;
    if (marking.search) {
        if (!marking.paths.empty() || !marking.images.empty() || marking.start)
            throw Error(Cause::bad_option, "a class is sought, or told by loops or a start", "leave out one of them");
        search = search_class(source, target, *marking.search);
        chosen.map = twisted_by(source.surface(), triangulation, search->map, marking.twists);
    } else {
        HandleMarking of_all = marking;
        if (const std::optional<SplitProblem>& split = source.split()) {
            if (of_all.start) of_all.start = with_means(*of_all.start, *split);
            for (HandleMarking::Twist& twist : of_all.twists) twist.path = over_midpoints(twist.path, *split);
        }
        chosen = choose(source.surface(), triangulation, target.surface().mesh, target.metric().metric.triangles,
                        target.group(), of_all);
    }
    HandleRegistration result{
        hyperbolic_map(source, target, std::move(chosen.map), options), std::move(search), chosen.mended, {}};
    if (result.search) warn_of_search(*result.search, result.map);
    try {
        const Marking back = inverse_marking(source, target, result.map);
        result.inverse_k = hyperbolic_map(target, source, back.map, options).k;
    } catch (const Error& error) {
        if (error.cause() == Cause::cancelled) throw;
    }
    return result;
}

TorusMap register_tori(const Surface& source, const Surface& target, const std::optional<HandleMarking>& marking) {
    const FlatTorus from = flat_torus(source), to = flat_torus(target);
    TorusMapOptions options;
    if (marking) {
        const IntrinsicTriangulation here = triangulation_of(source, from), there = triangulation_of(target, to);
        const std::vector<DiskIsometry> steps(static_cast<std::size_t>(there.halfedge_count()));
        const EdgeGroup group{there, steps, target.topology, to.homology};
        // Classes are told along triangles.
        std::optional<Surface> cut;
        if (from.forms->metric.triangles.size() != source.mesh.face_count())
            cut.emplace(Mesh{source.mesh.positions, from.forms->metric.triangles, {}});
        const Surface& triangles = cut ? *cut : source;
        const Marking chosen = choose(triangles, here, target.mesh, to.forms->metric.triangles, group, *marking);
        options.marking =
            marking_of_periods(from, to, periods_of_images(triangles.topology, chosen.map, from.homology.loops));
        if (options.marking->determinant() != 1)
            throw Error(Cause::bad_option,
                        "the class that was told is that of no homeomorphism that keeps the orientation: what it does "
                        "to loops has determinant " +
                            std::to_string(options.marking->determinant()) + ", not 1",
                        "bring the source nearer to the target (by an alignment, say), tell the class by loops or by a "
                        "start, or take the class of least dilatation");
        const int first = source.mesh.faces.vertices()[0];
        options.vertices = {first, chosen.map.bases[static_cast<std::size_t>(first)]};
    }
    return torus_map(source, from, target, to, options);
}

DistanceMatrix handle_distances(const std::vector<Surface>& surfaces, Alignment alignment,
                                const std::function<bool(int done, int all)>& progress,
                                const std::vector<std::string>& names,
                                const std::optional<ClassSearchOptions>& search) {
    const auto n = static_cast<int>(surfaces.size());
    if (n < 2) throw Error(Cause::bad_option, "a distance needs two shapes");
    const auto name = [&](int i) { return names.empty() ? "shape " + std::to_string(i) : names[i]; };
    PairwiseMaps maps;
    for (int i = 0; i < n; ++i)
        naming(name(i), {i}, [&] { maps.shapes.push_back(std::make_unique<const HyperbolicShape>(surfaces[i])); });
    DistanceMatrix result;
    result.distance = result.lower = result.upper = Eigen::MatrixXd::Zero(n, n);
    std::vector<std::array<int, 2>> open;
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j) open.push_back({i, j});
    const auto all = static_cast<int>(open.size());
    int done = 0;
    const auto settle = [&](int i, int j, const std::function<EquivariantMap()>& start) {
        naming(name(i) + " and " + name(j), {i, j}, [&] {
            const Distance d = maps.distance(i, j, start());
            result.distance(i, j) = result.distance(j, i) = d.distance;
            result.lower(i, j) = result.lower(j, i) = d.lower;
            result.upper(i, j) = result.upper(j, i) = d.upper;
            if (!d.settled) result.unsettled.push_back({i, j});
        });
        if (progress && !progress(++done, all)) throw Error(Cause::cancelled, "cancelled");
    };
    // Where nearest points contradict each other the way leads over a third shape, if it can.
    std::vector<std::array<int, 2>> contradictory;
    std::optional<Error> first;
    for (const auto& [i, j] : open) try {
            settle(i, j, [&, i = i, j = j] {
                return search ? search_class(*maps.shapes[i], *maps.shapes[j], *search).map
                              : maps.by_vertices(i, j, maps.nearest(i, j, alignment));
            });
        } catch (const Error& error) {
            if (error.cause() != Cause::bad_option || search) throw;
            if (!first) first = error;
            contradictory.push_back({i, j});
        }
    while (!contradictory.empty()) {
        const std::size_t before = contradictory.size();
        std::erase_if(contradictory, [&](const std::array<int, 2>& pair) {
            const std::vector<int> images = maps.over_another(pair[0], pair[1]);
            if (images.empty()) return false;
            settle(pair[0], pair[1], [&] { return maps.by_vertices(pair[0], pair[1], images); });
            return true;
        });
        if (contradictory.size() == before) throw *first;
    }
    std::sort(result.unsettled.begin(), result.unsettled.end());
    return result;
}

}  // namespace beltrami
