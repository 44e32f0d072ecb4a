#include <beltrami/teichmuller/distance.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/charts/shape.h>
#include <beltrami/teichmuller/naming.h>

namespace beltrami {

namespace {

double half_log(double K) {
    return 0.5 * std::log(std::max(1.0, K));
}

Distance distance_of(const ExtremalMap& map) {
    return {half_log(map.K), half_log(map.K_lower), half_log(map.K_upper),
            map.termination == Termination::converged && map.one_to_one()};
}

/// Whether two surfaces are one mesh: the identity is conformal, and what circle domains of coarse holes add to that is
/// their error.
bool same_shape(const Surface& a, const Surface& b) {
    const auto same = [](const Positions& p, const Positions& q) {
        return p.rows() == q.rows() && p.cols() == q.cols() && p == q;
    };
    return a.mesh.faces == b.mesh.faces && same(a.mesh.positions, b.mesh.positions) &&
           a.metric.has_value() == b.metric.has_value() && (!a.metric || same(*a.metric, *b.metric));
}

/// Whether a modulus decides: of disks, which are all alike, and of rings.
bool decided_by_moduli(const Surface& surface, const Correspondence& wanted, int outer) {
    const int loops = static_cast<int>(surface.topology.boundary_loops.size());
    return loops <= 2 && 0 <= outer && outer < loops && wanted.marks.empty() && !wanted.waypoints;
}

/// The modulus of a ring; of a disk any.
ModulusBracket modulus_of(const Surface& surface) {
    return surface.topology.boundary_loops.size() == 2 ? ring_modulus(surface) : ModulusBracket{1, 1};
}

Distance distance_of(const ModulusBracket& a, const ModulusBracket& b) {
    const double ratio = std::sqrt(a.lower * a.upper / (b.lower * b.upper));
    return {half_log(std::max(ratio, 1 / ratio)), half_log(modulus_ratio(a, b)),
            half_log(std::max(a.upper / b.lower, b.upper / a.lower)), true};
}

/// The options with the shapes' charts, for maps of which K alone is wanted.
ExtremalOptions with_charts_of(ExtremalOptions options, const std::vector<const Shape*>& shapes) {
    options.places = false;
    options.shapes.insert(options.shapes.end(), shapes.begin(), shapes.end());
    return options;
}

}  // namespace

Distance teichmueller_distance(const Shape& a, const Shape& b, const Correspondence& wanted,
                               const ExtremalOptions& given, int outer, bool both_ways) {
    if (both_ways && (!wanted.loops.empty() || !wanted.marks.empty() || wanted.waypoints))
        throw Error(Cause::bad_option, "pairs of loops, marks and waypoints are those of one direction",
                    "ask for that direction only");
    if (decided_by_moduli(a.surface(), wanted, wanted.outer_loop) && decided_by_moduli(b.surface(), wanted, outer) &&
        a.surface().topology.boundary_loops.size() == b.surface().topology.boundary_loops.size())
        return distance_of(modulus_of(a.surface()), modulus_of(b.surface()));
    const ExtremalOptions options = with_charts_of(given, {&a, &b});
    const Distance there = distance_of(extremal_map(a.surface(), Constraints(b.surface(), wanted, outer), options));
    if (!both_ways) return there;
    Correspondence reversed = wanted;
    reversed.outer_loop = outer;
    const Distance back =
        distance_of(extremal_map(b.surface(), Constraints(a.surface(), reversed, wanted.outer_loop), options));
    Distance result{0.5 * (there.distance + back.distance), std::max(there.lower, back.lower),
                    std::min(there.upper, back.upper), there.settled && back.settled};
    // Errors of second order can make the bounds of the two directions cross.
    if (result.lower > result.upper) std::swap(result.lower, result.upper);
    result.distance = std::clamp(result.distance, result.lower, result.upper);
    return result;
}

Distance teichmueller_distance(const Surface& a, const Surface& b, const Correspondence& wanted,
                               const ExtremalOptions& options, int outer, bool both_ways) {
    const Shape shape_a(a), shape_b(b);
    return teichmueller_distance(shape_a, shape_b, wanted, options, outer, both_ways);
}

DistanceMatrix distance_matrix(const std::vector<Surface>& surfaces, const Correspondence& wanted,
                               const ExtremalOptions& options, const std::function<bool(int done, int all)>& progress,
                               const std::vector<std::string>& names) {
    const int n = static_cast<int>(surfaces.size());
    if (n < 2) throw Error(Cause::bad_option, "a distance needs two shapes");
    if (!names.empty() && static_cast<int>(names.size()) != n)
        throw Error(Cause::bad_option,
                    "there are " + std::to_string(names.size()) + " names for " + std::to_string(n) + " shapes");
    const auto name = [&](int i) { return names.empty() ? "shape " + std::to_string(i) : names[i]; };
    for (int i = 0; i < n; ++i) naming(name(i), {i}, [&] { require_genus_zero(surfaces[i]); });
    for (int i = 1; i < n; ++i)
        if (surfaces[i].topology.boundary_loops.size() != surfaces[0].topology.boundary_loops.size())
            throw Error(Cause::bad_boundary,
                        name(0) + " has " + std::to_string(surfaces[0].topology.boundary_loops.size()) +
                            " boundary loops, " + name(i) + " has " +
                            std::to_string(surfaces[i].topology.boundary_loops.size()),
                        "compare shapes with the same number of holes", {Things::shapes, {0, i}});
    const bool by_moduli = wanted.loops.empty() && decided_by_moduli(surfaces[0], wanted, wanted.outer_loop);
    std::vector<ModulusBracket> moduli(static_cast<std::size_t>(n), ModulusBracket{1, 1});
    std::vector<std::unique_ptr<const Shape>> shapes(static_cast<std::size_t>(n));
    // Shapes and pairs side by side: a map by itself has less to do for a second thread.
    parallel_for_each(n, [&](int i) {
        naming(name(i), {i}, [&] {
            if (by_moduli) {
                moduli[i] = modulus_of(surfaces[i]);
                return;
            }
            shapes[i] = std::make_unique<const Shape>(surfaces[i]);
            shapes[i]->circles(wanted.outer_loop);
        });
    });
    const bool as_they_are = wanted.loops.empty() && wanted.marks.empty() && !wanted.waypoints;
    std::vector<std::array<int, 2>> pairs;
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j) pairs.push_back({i, j});
    const int all = static_cast<int>(pairs.size());
    std::vector<Distance> found(pairs.size());
    std::atomic<int> done = 0;
    const std::thread::id asking = std::this_thread::get_id();
    const auto tell = [&](int count) {
        if (progress && !progress(count, all)) throw Error(Cause::cancelled, "cancelled");
    };
    parallel_for_each(all, [&](int p) {
        const auto [i, j] = pairs[p];
        if (!as_they_are || !same_shape(surfaces[i], surfaces[j]))
            naming(name(i) + " and " + name(j), {i, j}, [&, i = i, j = j] {
                found[p] = by_moduli
                               ? distance_of(moduli[i], moduli[j])
                               : teichmueller_distance(*shapes[i], *shapes[j], wanted, options, wanted.outer_loop);
            });
        const int count = ++done;
        if (count < all && std::this_thread::get_id() == asking) tell(count);
    });
    tell(all);
    DistanceMatrix result;
    result.distance = result.lower = result.upper = Eigen::MatrixXd::Zero(n, n);
    for (int p = 0; p < all; ++p) {
        const auto [i, j] = pairs[p];
        result.distance(i, j) = result.distance(j, i) = found[p].distance;
        result.lower(i, j) = result.lower(j, i) = found[p].lower;
        result.upper(i, j) = result.upper(j, i) = found[p].upper;
        if (!found[p].settled) result.unsettled.push_back({i, j});
    }
    return result;
}

std::vector<Merge> cluster_by_distance(const Eigen::MatrixXd& distances) {
    const int n = static_cast<int>(distances.rows());
    if (distances.cols() != n || !distances.allFinite() || distances != distances.transpose())
        throw Error(Cause::bad_option, "distances to cluster by must be a finite symmetric matrix");
    struct Cluster {
        int name, size;
    };
    std::vector<Cluster> clusters;
    clusters.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) clusters.push_back({i, 1});
    Eigen::MatrixXd mean = distances;  // between clusters, in their places
    std::vector<Merge> merges;
    while (clusters.size() > 1) {
        std::size_t a = 0, b = 1;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < clusters.size(); ++i)
            for (std::size_t j = i + 1; j < clusters.size(); ++j)
                if (mean(i, j) < least) least = mean(i, j), a = i, b = j;
        const Cluster x = clusters[a], y = clusters[b];
        merges.push_back({std::min(x.name, y.name), std::max(x.name, y.name), least, x.size + y.size});
        for (std::size_t i = 0; i < clusters.size(); ++i)
            mean(a, i) = mean(i, a) = (x.size * mean(a, i) + y.size * mean(b, i)) / (x.size + y.size);
        clusters[a] = {n + static_cast<int>(merges.size()) - 1, x.size + y.size};
        // The last one moves into the place of b.
        const std::size_t last = clusters.size() - 1;
        for (std::size_t i = 0; i < clusters.size(); ++i) mean(b, i) = mean(i, b) = mean(last, i);
        clusters[b] = clusters[last];
        clusters.pop_back();
    }
    return merges;
}

}  // namespace beltrami
