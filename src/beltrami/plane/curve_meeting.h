#pragma once

#include <optional>
#include <vector>

#include <beltrami/plane/segment_tree.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami {

/// Two parameters near which curves meet: right to about 1e-6 of the length. That they meet, or come within 1e-12 of
/// their diameter of each other, is certain.
struct CurveMeeting {
    double first, second;
};

/// Where a curve meets itself; nothing if it is simple.
std::optional<CurveMeeting> self_meeting(const TargetCurve& curve);

/// Where two curves meet, parameters in their order; nothing if they are apart.
std::optional<CurveMeeting> meeting(const TargetCurve& a, const TargetCurve& b);

namespace detail {

/// A piece of a curve without corners: it lies within `width` of its chord, because no point of it can be further from
/// both ends than its length allows.
struct CurveArc {
    double begin, end;  ///< parameters, begin < end
    Segment chord;
    double width;
};

CurveArc curve_arc(const TargetCurve& curve, double begin, double end);

/// Smallest distance between two segments.
double distance(const Segment& s, const Segment& t);

}  // namespace detail

}  // namespace beltrami
