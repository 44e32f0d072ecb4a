#include <beltrami/teichmuller/sliding_feasibility.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/plane/inside_polygon.h>

namespace beltrami {

namespace {

/// Places nearer to a curve, as part of its diameter, are on it.
constexpr double kOnCurve = 1e-12;
/// Chords by which a curve is replaced between two neighbours of a loop, where arcs of the loop are prescribed.
constexpr int kChords = 8;

/// The image of a boundary loop: its curve, or where arcs are prescribed these and the curve between them.
class LoopImage {
  public:
    LoopImage(const std::vector<int>& vertices, const SlidingLoop& loop, const Eigen::VectorXcd& images)
        : curve_(loop.curve) {
        const int n = static_cast<int>(vertices.size());
        if (!has_arc(loop.held)) return;
        const auto prescribed = [&](int i) { return loop.held[i] && loop.held[(i + 1) % n]; };
        for (int i = 0; i < n; ++i) {
            const double s = loop.parameters[i];
            polygon_.push_back(loop.held[i] ? images[vertices[i]] : curve_.point(s));
            for (int part = 1; part < kChords && !prescribed(i); ++part)
                polygon_.push_back(curve_.point(s + loop.increment(i) * part / kChords));
        }
    }
    /// Inside, outside, or (nothing) on it.
    std::optional<bool> contains(Complex p) const {
        if (!polygon_.empty()) return winding_number(polygon_, p) != 0;
        if (std::abs(curve_.point(curve_.nearest(p)) - p) < kOnCurve * curve_.diameter()) return {};
        return curve_.contains(p);
    }

  private:
    const TargetCurve& curve_;
    std::vector<Complex> polygon_;
};

/// A place through which the map goes for certain.
struct Place {
    int vertex;
    int loop;  ///< -1: inside
    Complex image;
    bool slides;
};

/// Prescribed vertices, and one of each loop that slides.
std::vector<Place> places_of(const Surface& source, const MixedBoundary& boundary,
                             const std::vector<SlidingLoop>& loops) {
    const auto& boundary_loops = source.topology.boundary_loops;
    std::vector<int> loop_of(source.mesh.vertex_count(), -1);
    for (std::size_t l = 0; l < boundary_loops.size(); ++l)
        for (const int v : boundary_loops[l]) loop_of[v] = static_cast<int>(l);
    std::vector<Place> result;
    for (std::size_t i = 0; i < boundary.prescribed.vertices.size(); ++i) {
        const int v = boundary.prescribed.vertices[i];
        result.push_back({v, loop_of[v], boundary.prescribed.images[i], false});
    }
    for (const SlidingLoop& l : loops) {
        const auto free = std::find(l.held.begin(), l.held.end(), 0) - l.held.begin();
        result.push_back({boundary_loops[l.loop][free], l.loop, l.curve.point(l.parameters[free]), true});
    }
    return result;
}

[[noreturn]] void refuse(const Place& place, int loop, bool outer, bool on) {
    const std::string who = place.slides
                                ? "boundary loop " + std::to_string(place.loop) + " slides along a curve that lies "
                                : "the image of vertex " + std::to_string(place.vertex) + " lies ";
    throw Error(Cause::bad_boundary,
                who +
                    (on      ? "on"
                     : outer ? "outside"
                             : "inside") +
                    " the image of boundary loop " + std::to_string(loop) +
                    (outer ? ", which encloses all others" : ""),
                "a one-to-one map keeps images inside the outer loop's and outside those of the holes",
                {Things::vertices, {place.vertex}});
}

}  // namespace

void require_feasible(const Surface& source, const MixedBoundary& boundary, const std::vector<SlidingLoop>& loops,
                      int outer_loop) {
    require_feasible(source, boundary.prescribed, outer_loop);
    const std::vector<Place> places = places_of(source, boundary, loops);
    const Eigen::VectorXcd images = prescribed_values(boundary.prescribed, source);
    for (const SlidingLoop& l : loops) {
        const LoopImage image(source.topology.boundary_loops[l.loop], l, images);
        const bool outer = l.loop == outer_loop;
        for (const Place& place : places) {
            if (place.loop == l.loop) continue;
            const std::optional<bool> inside = image.contains(place.image);
            if (inside != outer) refuse(place, l.loop, outer, !inside);
        }
    }
    // Loops that are prescribed as a whole, and sliding ones: what is prescribed has been compared with these above.
    for (std::size_t l = 0; l < boundary.held.size(); ++l) {
        if (boundary.slides(static_cast<int>(l))) continue;
        std::vector<Complex> polygon;
        for (const int v : source.topology.boundary_loops[l]) polygon.push_back(images[v]);
        const bool outer = static_cast<int>(l) == outer_loop;
        for (const Place& place : places)
            if (place.slides && (winding_number(polygon, place.image) != 0) != outer)
                refuse(place, static_cast<int>(l), outer, false);
    }
}

}  // namespace beltrami
