#include <beltrami/targets/correspondence.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// Loop and position in it of every vertex; −1 where it is on none.
struct LoopPlaces {
    explicit LoopPlaces(const Surface& surface)
        : loop(surface.mesh.vertex_count(), -1), position(surface.mesh.vertex_count(), -1) {
        const auto& loops = surface.topology.boundary_loops;
        for (std::size_t l = 0; l < loops.size(); ++l)
            for (std::size_t i = 0; i < loops[l].size(); ++i) {
                loop[loops[l][i]] = static_cast<int>(l);
                position[loops[l][i]] = static_cast<int>(i);
            }
    }
    std::vector<int> loop, position;
};

void require_partners(const Surface& source, const TargetDomain& domain, const std::vector<int>& partners) {
    const std::size_t loops = source.topology.boundary_loops.size();
    if (partners.size() != loops || loops != static_cast<std::size_t>(domain.curve_count()))
        throw Error(Cause::bad_option,
                    "the source has " + std::to_string(loops) + " boundary loops, the target " +
                        std::to_string(domain.curve_count()) + " curves, and " + std::to_string(partners.size()) +
                        " partners are given",
                    "give as many curves as loops, and one partner per loop");
    std::vector<char> taken(loops, 0);
    for (std::size_t l = 0; l < loops; ++l) {
        if (partners[l] < 0 || partners[l] >= domain.curve_count() || taken[partners[l]])
            throw Error(Cause::bad_option,
                        "boundary loop " + std::to_string(l) + " has the partner " + std::to_string(partners[l]) +
                            ", which does not exist or is taken",
                        "give every loop a curve of its own", {Things::loops, {static_cast<int>(l)}});
        taken[partners[l]] = 1;
    }
}

void require_on_boundary(const std::vector<int>& vertices, const Surface& source, const LoopPlaces& places) {
    std::vector<int> sorted = vertices;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
        throw Error(Cause::bad_boundary, "vertex " + std::to_string(*twice) + " is marked twice", "mark it once",
                    {Things::vertices, {*twice}});
    for (const int v : vertices) {
        if (v < 0 || v >= source.mesh.vertex_count())
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(v) + " is marked, but the source has the vertices 0 to " +
                            std::to_string(source.mesh.vertex_count() - 1),
                        "vertices are counted from 0", {Things::vertices, {v}});
        if (places.loop[v] < 0)
            throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " is marked but not on the boundary",
                        "mark boundary vertices", {Things::vertices, {v}});
    }
}

}  // namespace

const CurveParameter& on_curve(const Mark& mark) {
    return std::get<CurveParameter>(mark.to);
}

void validate(const std::vector<Mark>& marks, const Surface& source, const TargetDomain& domain,
              const std::vector<int>& partners) {
    require_partners(source, domain, partners);
    const LoopPlaces places(source);
    std::vector<int> vertices;
    for (const Mark& mark : marks) vertices.push_back(mark.vertex);
    require_on_boundary(vertices, source, places);
    for (const Mark& mark : marks) {
        const int partner = partners[places.loop[mark.vertex]];
        const CurveParameter* place = std::get_if<CurveParameter>(&mark.to);
        if (!place || place->curve != partner || !std::isfinite(place->parameter))
            throw Error(Cause::bad_boundary,
                        "the mark of vertex " + std::to_string(mark.vertex) + " is not a place of " +
                            curve_name(partner) + ", the partner of its loop",
                        "mark a place of that curve, or give the loops other partners",
                        {Things::vertices, {mark.vertex}});
    }
    std::vector<Mark> sorted = marks;
    std::sort(sorted.begin(), sorted.end(), [&](const Mark& a, const Mark& b) {
        return std::pair(on_curve(a).curve, places.position[a.vertex]) <
               std::pair(on_curve(b).curve, places.position[b.vertex]);
    });
    for (std::size_t first = 0; first < sorted.size();) {
        std::size_t last = first;
        const int on = on_curve(sorted[first]).curve;
        while (last < sorted.size() && on_curve(sorted[last]).curve == on) ++last;
        const TargetCurve& curve = domain.curve(on);
        double around = 0;
        for (std::size_t i = first; i < last && last - first > 1; ++i) {
            const Mark &here = sorted[i], &next = sorted[i + 1 < last ? i + 1 : first];
            const double ahead = curve.ahead(on_curve(here).parameter, on_curve(next).parameter);
            if (std::min(ahead, curve.length() - ahead) <= 1e-12 * curve.length())
                throw Error(Cause::bad_boundary,
                            "vertices " + std::to_string(here.vertex) + " and " + std::to_string(next.vertex) +
                                " are marked with one place of " + curve_name(on),
                            "give different places", {Things::vertices, {here.vertex, next.vertex}});
            around += ahead;
            if (around > 1.5 * curve.length())
                throw Error(Cause::bad_boundary,
                            "the marks on " + curve_name(on) +
                                " follow each other in another order than their vertices along the boundary loop, up "
                                "to vertex " +
                                std::to_string(next.vertex),
                            "a one-to-one map keeps the order, the surface on the left on both sides",
                            {Things::vertices, {here.vertex, next.vertex}});
        }
        first = last;
    }
}

Mark nearest_mark(const TargetDomain& domain, int vertex, Complex point) {
    if (!std::isfinite(point.real()) || !std::isfinite(point.imag()))
        throw Error(Cause::bad_boundary, "the place of the marked vertex " + std::to_string(vertex) + " is not finite",
                    "give numbers", {Things::vertices, {vertex}});
    Mark best{vertex, 0, 0};
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < domain.curve_count(); ++c) {
        const double s = domain.curve(c).nearest(point);
        const double distance = std::abs(domain.curve(c).point(s) - point);
        if (distance < least) {
            least = distance;
            best = {vertex, c, s};
        }
    }
    return best;
}

double distance_from(const TargetDomain& domain, const Mark& mark, Complex point) {
    const TargetCurve& curve = domain.curve(on_curve(mark).curve);
    return std::abs(curve.point(on_curve(mark).parameter) - point) / curve.length();
}

}  // namespace beltrami
