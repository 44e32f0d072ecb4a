#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A place on a curve of a target domain, by arc length.
struct CurveParameter {
    int curve = 0;
    double parameter = 0;
};
/// A boundary vertex of a target that is a surface.
struct TargetVertex {
    int vertex = 0;
};
using TargetPlace = std::variant<CurveParameter, TargetVertex>;

/// A vertex of the source's boundary and the place of the target's boundary to which it is to go.
struct Mark {
    int vertex = 0;
    TargetPlace to;

    Mark(int v, TargetPlace place) : vertex(v), to(place) {}
    Mark(int v, int curve, double parameter) : vertex(v), to(CurveParameter{curve, parameter}) {}
};

/// Where the centre of a hole's image is at a step of a continuation.
struct Waypoint {
    int step = 1;      ///< from 1; the prescribed boundary values come one step after the last waypoint
    int loop = 0;      ///< of topology.boundary_loops, not the outer one
    Complex position;  ///< in the plane of the images
};

/// How holes are paired that nothing pairs.
enum class MatchBy {
    position,  ///< nearest after the best Möbius map of the disk
    size,      ///< the largest to the largest, and so on
};

/// What goes where, apart from how it is solved: which boundary loop to which curve, which vertex to which place, and
/// in which homotopy class.
struct Correspondence {
    int outer_loop = 0;  ///< the boundary loop of the source whose image encloses the others
    /// Pairs (loop of the source, curve of the target: 0 the outer one, then the holes from 1; boundary loop of a
    /// target that is a surface). Empty: matched.
    std::vector<std::array<int, 2>> loops = {};
    MatchBy match_by = MatchBy::position;
    std::vector<Mark> marks = {};
    /// Turns of every boundary loop against the outer one (homotopy.h), one number per loop, that of the outer loop not
    /// used. Empty: those of the harmonic map, or of the start. Where loops slide, turns mean nothing.
    std::vector<int> turns = {};
    /// The holes are led through these places (continuation.h; none: straight ways), which fixes how they braid and
    /// turn. With prescribed boundary values the way begins at the source itself where it lies in the plane and
    /// outer_loop is its outer loop, else at its chart; places are those of the images. Where loops slide, places are
    /// in the target's plane where its curves are circles, else in the unit disk of its model. Nothing: no way is
    /// prescribed.
    std::optional<std::vector<Waypoint>> waypoints = {};
};

/// The place of a mark on a curve. @pre it is one
const CurveParameter& on_curve(const Mark& mark);

/// The mark that sends a vertex to the nearest point of the nearest curve (of equally near ones the first).
/// @throw Error bad_boundary if the point is not finite
Mark nearest_mark(const TargetDomain& domain, int vertex, Complex point);

/// A mark further from where it was meant than this part of its curve's length is hardly meant so.
constexpr double kFarMark = 0.01;

/// How far a mark on a curve lies from the place that was meant, as a part of its curve's length. @pre it is one
double distance_from(const TargetDomain& domain, const Mark& mark, Complex point);

/// @throw Error bad_option unless partners pairs every loop with a curve of its own; bad_boundary naming vertices that
///        are not on the boundary or marked twice, marks that are not on the partner of their loop, fall on one place
///        or follow each other along the curve in another order than along the loop
void validate(const std::vector<Mark>& marks, const Surface& source, const TargetDomain& domain,
              const std::vector<int>& partners);

}  // namespace beltrami
