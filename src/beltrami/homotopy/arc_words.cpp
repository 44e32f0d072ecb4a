#include <beltrami/homotopy/arc_words.h>

#include <algorithm>
#include <string>
#include <utility>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

std::vector<std::vector<int>> neighbours_of(const Surface& source) {
    std::vector<std::vector<int>> result(static_cast<std::size_t>(source.mesh.vertex_count()));
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const auto v = source.mesh.faces[f];
        for (std::size_t i = 0; i < v.size(); ++i) {
            const int a = v[i], b = v[(i + 1) % v.size()];
            result[a].push_back(b);
            result[b].push_back(a);
        }
    }
    return result;
}

/// From every vertex the next one on a shortest path of edges to a first one; −1: none leads there. Paths end at what
/// stands in their way.
std::vector<int> towards(const Surface& source, int first, const std::vector<char>& in_the_way) {
    const std::vector<std::vector<int>> neighbours = neighbours_of(source);
    std::vector<int> next(neighbours.size(), -1), reached{first};
    reached.reserve(neighbours.size());
    next[first] = first;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (i > 0 && in_the_way[reached[i]]) continue;
        for (const int w : neighbours[reached[i]])
            if (next[w] < 0) {
                next[w] = reached[i];
                reached.push_back(w);
            }
    }
    return next;
}

/// Where a segment crosses the rays that go straight up from points.
void add_crossings(Complex from, Complex to, const std::vector<Complex>& points, std::vector<int>& word) {
    std::vector<std::pair<double, int>> crossings;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = points[i].real();
        if ((from.real() < x) == (to.real() < x)) continue;
        const double part = (x - from.real()) / (to.real() - from.real());
        if (from.imag() + part * (to.imag() - from.imag()) <= points[i].imag()) continue;
        const int letter = static_cast<int>(i) + 1;
        crossings.emplace_back(part, from.real() < x ? letter : -letter);
    }
    std::sort(crossings.begin(), crossings.end());
    for (const auto& crossing : crossings) {
        const int letter = crossing.second;
        if (!word.empty() && word.back() == -letter)
            word.pop_back();
        else
            word.push_back(letter);
    }
}

}  // namespace

ArcWords::ArcWords(const Surface& source, std::vector<int> pins, const std::vector<int>& marked, int outer_loop)
    : pins_(std::move(pins)) {
    if (pins_.empty()) return;
    const auto& loops = source.topology.boundary_loops;
    std::vector<char> in_the_way(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : pins_) in_the_way[v] = 1;
    for (const auto& loop : loops)
        for (const int v : loop) in_the_way[v] = 1;
    const std::vector<int> next = towards(source, pins_[0], in_the_way);
    const auto add = [&](int vertex, int end, bool to_middle) {
        Arc arc{{vertex}, end, to_middle};
        if (next[vertex] < 0)
            throw Error(Cause::bad_mesh,
                        "no edges lead from vertex " + std::to_string(pins_[0]) + " to vertex " +
                            std::to_string(vertex) + " past other landmarks and the boundary",
                        "refine the mesh there", {Things::vertices, {pins_[0], vertex}});
        while (arc.vertices.back() != pins_[0]) arc.vertices.push_back(next[arc.vertices.back()]);
        std::reverse(arc.vertices.begin(), arc.vertices.end());
        arcs_.push_back(std::move(arc));
    };
    for (std::size_t i = 1; i < pins_.size(); ++i) add(pins_[i], static_cast<int>(i), false);
    int point = static_cast<int>(pins_.size());
    for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
        if (l == outer_loop) continue;
        const auto reached = std::find_if(loops[l].begin(), loops[l].end(), [&](int v) { return next[v] >= 0; });
        add(reached == loops[l].end() ? loops[l][0] : *reached, point++, true);
    }
    for (const int v : marked) add(v, -1, false);
}

ArcWords::Polylines ArcWords::images(const Eigen::VectorXcd& map, const std::vector<Complex>& middles) const {
    Polylines result;
    result.reserve(arcs_.size());
    for (const Arc& arc : arcs_) {
        std::vector<Complex>& line = result.emplace_back();
        for (const int v : arc.vertices) line.push_back(map[v]);
        if (arc.to_middle) line.push_back(middles[static_cast<std::size_t>(arc.end) - pins_.size()]);
    }
    return result;
}

std::vector<Complex> ArcWords::places_of_pins(const Eigen::VectorXcd& map) const {
    std::vector<Complex> result;
    result.reserve(pins_.size());
    for (const int v : pins_) result.push_back(map[v]);
    return result;
}

ArcWords::Words ArcWords::of(const Polylines& arcs, const std::vector<Complex>& pins,
                             const std::vector<Complex>& middles) const {
    std::vector<Complex> points = pins;
    points.insert(points.end(), middles.begin(), middles.end());
    Words words;
    words.reserve(arcs_.size());
    for (std::size_t a = 0; a < arcs_.size(); ++a) {
        std::vector<int> word;
        for (std::size_t i = 1; i < arcs[a].size(); ++i) add_crossings(arcs[a][i - 1], arcs[a][i], points, word);
        // Turns around the ends: the first pin has the number 0.
        const auto around_first =
            std::find_if(word.begin(), word.end(), [](int letter) { return std::abs(letter) != 1; });
        word.erase(word.begin(), around_first);
        const int end = arcs_[a].end;
        while (end >= 0 && !word.empty() && std::abs(word.back()) == end + 1) word.pop_back();
        words.push_back(std::move(word));
    }
    return words;
}

}  // namespace beltrami
