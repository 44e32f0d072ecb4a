#include <beltrami/charts/boundary_correspondence.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// A boundary loop with the arc length of each vertex from the first, and the total.
struct ArcLengths {
    std::vector<double> arc{0.0};  ///< one more than vertices

    ArcLengths(const Surface& surface, int loop) {
        for (const double length : surface.boundary_edge_lengths[loop]) arc.push_back(arc.back() + length);
    }
    double total() const { return arc.back(); }
    int size() const { return static_cast<int>(arc.size()) - 1; }
    /// From one position forward to another; the whole loop if they are equal.
    double ahead(int from, int to) const { return arc[to] - arc[from] + (to <= from ? total() : 0); }
    /// The place so far ahead of a position, at most once around.
    BoundaryPlace place(int loop, int from, double distance) const {
        double at = arc[from] + distance;
        if (at >= total()) at -= total();
        const auto next = std::upper_bound(arc.begin(), arc.end(), at);
        const int edge = std::clamp(static_cast<int>(next - arc.begin()) - 1, 0, size() - 1);
        const double fraction = std::max(0.0, (at - arc[edge]) / (arc[edge + 1] - arc[edge]));
        return fraction < 1 ? BoundaryPlace{loop, edge, fraction} : BoundaryPlace{loop, (edge + 1) % size(), 0};
    }
};

/// The loop and the position of every vertex of the boundary.
struct Positioned {
    std::vector<int> loop, position;

    explicit Positioned(const Surface& surface)
        : loop(surface.mesh.vertex_count(), -1), position(surface.mesh.vertex_count(), -1) {
        const auto& loops = surface.topology.boundary_loops;
        for (std::size_t l = 0; l < loops.size(); ++l)
            for (std::size_t i = 0; i < loops[l].size(); ++i) {
                loop[loops[l][i]] = static_cast<int>(l);
                position[loops[l][i]] = static_cast<int>(i);
            }
    }
    void require(int vertex, const char* of) const {
        if (vertex < 0 || vertex >= static_cast<int>(loop.size()) || loop[vertex] < 0)
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(vertex) + " of a pair is not on the boundary of the " + of,
                        "pair boundary vertices, counted from 0", {Things::vertices, {vertex}});
    }
};

/// A pair, by positions on the loops.
struct Pair {
    int from, to;
    std::array<int, 2> vertices;
};

void require_one_partner(std::span<const std::array<int, 2>> pairs, int side, const char* of) {
    std::vector<int> vertices;
    for (const auto& pair : pairs) vertices.push_back(pair[side]);
    std::sort(vertices.begin(), vertices.end());
    const auto twice = std::adjacent_find(vertices.begin(), vertices.end());
    if (twice != vertices.end())
        throw Error(Cause::bad_boundary,
                    "vertex " + std::to_string(*twice) + " of the " + of + " is in two of the pairs",
                    "give every vertex one partner", {Things::vertices, {*twice}});
}

/// Pairs by the loops of the source, in its order, and the loops' partners.
std::vector<std::vector<Pair>> by_loops(const Surface& source, const Surface& target,
                                        std::span<const std::array<int, 2>> pairs, std::vector<int>& partner) {
    const Positioned from(source), to(target);
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    std::vector<std::vector<Pair>> result(loops);
    partner.assign(loops, -1);
    for (const auto& pair : pairs) {
        from.require(pair[0], "source");
        to.require(pair[1], "target");
        const int loop = from.loop[pair[0]], other = to.loop[pair[1]];
        if (partner[loop] >= 0 && partner[loop] != other)
            throw Error(Cause::bad_boundary,
                        "pairs send boundary loop " + std::to_string(loop) + " of the source to the loops " +
                            std::to_string(partner[loop]) + " and " + std::to_string(other) + " of the target",
                        "send a loop to one loop", {Things::vertices, {pair[0], pair[1]}});
        partner[loop] = other;
        result[loop].push_back({from.position[pair[0]], to.position[pair[1]], pair});
    }
    for (int l = 0; l < loops; ++l) {
        if (result[l].empty())
            throw Error(Cause::bad_boundary, "no pair says where boundary loop " + std::to_string(l) + " goes",
                        "give at least one pair for every loop", {Things::loops, {l}});
        if (std::count(partner.begin(), partner.end(), partner[l]) > 1)
            throw Error(
                Cause::bad_boundary,
                "pairs send two boundary loops of the source to loop " + std::to_string(partner[l]) + " of the target",
                "send every loop to one of its own", {Things::loops, {l}});
        std::sort(result[l].begin(), result[l].end(), [](const Pair& a, const Pair& b) { return a.from < b.from; });
    }
    return result;
}

/// Places of a loop's vertices.
std::vector<BoundaryPlace> places_of(const Surface& source, const Surface& target, int loop, int other,
                                     const std::vector<Pair>& pairs) {
    const ArcLengths from(source, loop), to(target, other);
    std::vector<BoundaryPlace> result(from.size());
    double around = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const Pair &begin = pairs[p], &end = pairs[(p + 1) % pairs.size()];
        const double length = from.ahead(begin.from, end.from), run = to.ahead(begin.to, end.to);
        around += run;
        if (around > 1.5 * to.total())
            throw Error(Cause::bad_boundary,
                        "the pairs of boundary loop " + std::to_string(loop) +
                            " follow each other in another order on the target, up to the pair " +
                            std::to_string(end.vertices[0]) + " " + std::to_string(end.vertices[1]),
                        "a one-to-one map keeps the order, the surface on the left on both sides",
                        {Things::vertices, {end.vertices[0], end.vertices[1]}});
        int i = begin.from;
        do {
            const double part = i == begin.from ? 0 : from.ahead(begin.from, i) / length;
            result[i] = part > 0 ? to.place(other, begin.to, part * run) : BoundaryPlace{other, begin.to, 0};
            i = (i + 1) % from.size();
        } while (i != end.from);
    }
    return result;
}

}  // namespace

BoundaryCorrespondence boundary_correspondence(const Surface& source, const Surface& target,
                                               std::span<const std::array<int, 2>> pairs) {
    const std::size_t loops = source.topology.boundary_loops.size(), others = target.topology.boundary_loops.size();
    if (loops != others)
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(loops) + " boundary loops, the target " + std::to_string(others),
                    "source and target must have the same number of holes");
    require_one_partner(pairs, 0, "source");
    require_one_partner(pairs, 1, "target");
    BoundaryCorrespondence result;
    const std::vector<std::vector<Pair>> sorted = by_loops(source, target, pairs, result.partner);
    for (std::size_t l = 0; l < loops; ++l)
        result.places.push_back(places_of(source, target, static_cast<int>(l), result.partner[l], sorted[l]));
    return result;
}

BoundaryCondition boundary_on_circles(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                                      const BoundaryCorrespondence& correspondence) {
    BoundaryCondition boundary;
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const std::vector<int>& other = target.topology.boundary_loops[correspondence.partner[l]];
        const RoundHole circle = circles.circle(correspondence.partner[l]);
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const BoundaryPlace& place = correspondence.places[l][i];
            const Complex a = circles.chart.vertices[other[place.edge]] - circle.centre,
                          b = circles.chart.vertices[other[(place.edge + 1) % other.size()]] - circle.centre;
            boundary.pin(loops[l][i],
                         circle.centre + std::polar(circle.radius, std::arg(a) + place.fraction * std::arg(b / a)));
        }
    }
    return boundary;
}

}  // namespace beltrami
