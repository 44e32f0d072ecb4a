#include <beltrami/starts/given_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/increasing.h>

namespace beltrami {

namespace {

/// The curve to which the vertices of a loop are nearest, root mean square.
int nearest_curve(const std::vector<int>& loop, const TargetDomain& target, const Eigen::VectorXcd& map) {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < target.curve_count(); ++c) {
        const TargetCurve& curve = target.curve(c);
        double sum = 0;
        for (const int v : loop) sum += std::norm(map[v] - curve.point(curve.nearest(map[v])));
        if (sum < least) least = sum, best = c;
    }
    return best;
}

/// The curve of every loop.
std::vector<int> curves_of(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& map,
                           const Correspondence& wanted) {
    const auto& loops = source.topology.boundary_loops;
    if (static_cast<int>(loops.size()) != target.curve_count())
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(loops.size()) + " boundary loops, the target " +
                        std::to_string(target.curve_count()),
                    "source and target must have the same number of holes");
    std::vector<int> curves(loops.size(), -1), loop_of_curve(loops.size(), -1);
    for (const auto& [loop, curve] : wanted.loops)
        if (loop >= 0 && loop < static_cast<int>(loops.size()) && curve >= 0 && curve < target.curve_count())
            curves[loop] = curve;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const int c = curves[l] >= 0 ? curves[l] : nearest_curve(loops[l], target, map);
        if (loop_of_curve[c] >= 0)
            throw Error(Cause::bad_boundary,
                        "boundary loops " + std::to_string(loop_of_curve[c]) + " and " + std::to_string(l) +
                            " of the start are both nearest to " + curve_name(c),
                        "give a start whose loops lie on the curves of the target",
                        {Things::loops, {loop_of_curve[c], static_cast<int>(l)}});
        loop_of_curve[c] = static_cast<int>(l);
        curves[l] = c;
    }
    return curves;
}

/// Arc length up to every vertex of a loop, and the total.
std::vector<double> arc_of(const Surface& source, int loop) {
    std::vector<double> arc{0.0};
    for (const double length : source.boundary_edge_lengths[loop]) arc.push_back(arc.back() + length);
    return arc;
}

/// Moves increasing parameters so that what is held lies at its places, and all stay in order.
void move_to_places(const std::vector<std::pair<std::size_t, double>>& places, SlidingLoop& sliding) {
    struct Fixed {
        std::size_t at;
        double from, to;
    };
    std::vector<Fixed> fixed;
    const double length = sliding.curve.length();
    for (const auto& [i, place] : places) {
        const double from = sliding.parameters[i];
        double to = from + sliding.curve.ahead(from, place);
        if (fixed.empty()) {
            if (to - from > length / 2) to -= length;
        } else {
            to = fixed.back().to + sliding.curve.ahead(fixed.back().to, place);
        }
        fixed.push_back({i, from, to});
        sliding.held[i] = 1;
    }
    if (fixed.empty()) return;
    const std::vector<double> before = sliding.parameters;
    const std::size_t n = before.size(), m = fixed.size();
    for (std::size_t j = 0; j < m; ++j) {
        const Fixed a = fixed[j];
        Fixed b = fixed[(j + 1) % m];
        if (j + 1 == m) b.from += length, b.to = fixed[0].to + length, b.at += n;
        for (std::size_t i = a.at; i < b.at; ++i) {
            const double turn = i >= n ? length : 0.0, part = (before[i % n] + turn - a.from) / (b.from - a.from);
            sliding.parameters[i % n] = a.to + part * (b.to - a.to) - turn;
        }
    }
}

SlidingLoop in_order(const Surface& source, int l, const TargetCurve& curve, const Eigen::VectorXcd& map) {
    SlidingLoop sliding{l, curve, {}, {}};
    const std::vector<int>& loop = source.topology.boundary_loops[l];
    const double length = curve.length();
    const auto step = [&](double from, double to) {
        const double ahead = curve.ahead(from, to);
        return ahead > length / 2 ? ahead - length : ahead;
    };
    for (const int v : loop) {
        const double s = curve.nearest(map[v]);
        sliding.parameters.push_back(
            sliding.parameters.empty() ? s : sliding.parameters.back() + step(sliding.parameters.back(), s));
    }
    const double around =
        sliding.parameters.back() + step(sliding.parameters.back(), sliding.parameters[0]) - sliding.parameters[0];
    if (const long turns = std::lround(around / length); turns != 1)
        throw Error(Cause::bad_boundary,
                    "the start takes boundary loop " + std::to_string(l) + " around its curve " +
                        std::to_string(turns) + " times instead of once",
                    "start from a map that keeps the order of the boundary vertices", {Things::loops, {l}});
    make_increasing(sliding.parameters, length, arc_of(source, l));
    sliding.held.assign(loop.size(), 0);
    return sliding;
}

}  // namespace

void require_values(const Surface& source, const Eigen::VectorXcd& map) {
    if (map.size() != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(map.size()) + " values, the source " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    for (Eigen::Index v = 0; v < map.size(); ++v)
        if (!std::isfinite(map[v].real()) || !std::isfinite(map[v].imag()))
            throw Error(Cause::bad_option, "the start is not finite at vertex " + std::to_string(v), "",
                        {Things::vertices, {static_cast<int>(v)}});
}

SlidingLoop given_loop(const Surface& source, int loop, const TargetCurve& curve, const Eigen::VectorXcd& map,
                       const std::vector<std::pair<std::size_t, double>>& places) {
    SlidingLoop result = in_order(source, loop, curve, map);
    move_to_places(places, result);
    return result;
}

SlidingStart given_start(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& map,
                         const Correspondence& wanted) {
    require_values(source, map);
    SlidingStart start;
    start.map = map;
    start.curves = curves_of(source, target, map, wanted);
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        std::vector<std::pair<std::size_t, double>> places;
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            for (const Mark& mark : wanted.marks)
                if (mark.vertex == loops[l][i] && on_curve(mark).curve == start.curves[l])
                    places.emplace_back(i, on_curve(mark).parameter);
        SlidingLoop sliding = given_loop(source, static_cast<int>(l), target.curve(start.curves[l]), map, places);
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            start.map[loops[l][i]] = sliding.curve.point(sliding.parameters[i]);
        start.loops.push_back(std::move(sliding));
    }
    start.flips = static_cast<int>(distortion(source.operators, start.map).flipped.size());
    return start;
}

}  // namespace beltrami
