#include <beltrami/plane/curve_meeting.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

namespace detail {

CurveArc curve_arc(const TargetCurve& curve, double begin, double end) {
    const Segment chord{curve.point(begin), curve.point(end)};
    const double length = end - begin, straight = std::abs(chord.b - chord.a);
    const bool is_side = curve.kind() == TargetCurve::Kind::polygon;
    return {begin, end, chord,
            is_side ? 0.0 : 0.5 * std::sqrt(std::max(0.0, (length - straight) * (length + straight)))};
}

double distance(const Segment& s, const Segment& t) {
    if (segments_meet(s, t)) return 0;
    return std::min(std::min(beltrami::distance(s.a, t), beltrami::distance(s.b, t)),
                    std::min(beltrami::distance(t.a, s), beltrami::distance(t.b, s)));
}

}  // namespace detail

namespace {

using detail::CurveArc;

constexpr double kTolerance = 1e-12;

std::vector<CurveArc> arcs_of(const TargetCurve& curve) {
    const std::vector<double> ends = curve.piece_ends();
    std::vector<CurveArc> arcs(ends.size() - 1);
    for (std::size_t i = 0; i < arcs.size(); ++i) arcs[i] = detail::curve_arc(curve, ends[i], ends[i + 1]);
    return arcs;
}

/// Cuts the wider of two arcs in halves until they are apart or thinner than the tolerance.
std::optional<CurveMeeting> meet(const TargetCurve& a, const TargetCurve& b, const CurveArc& s, const CurveArc& t,
                                 double tolerance) {
    if (detail::distance(s.chord, t.chord) > s.width + t.width + tolerance) return std::nullopt;
    if (s.width + t.width <= tolerance) return CurveMeeting{s.begin, t.begin};
    const bool first = s.width >= t.width;
    const CurveArc& wide = first ? s : t;
    const double middle = 0.5 * (wide.begin + wide.end);
    for (const auto& [begin, end] : {std::pair(wide.begin, middle), std::pair(middle, wide.end)}) {
        const CurveArc half = detail::curve_arc(first ? a : b, begin, end);
        if (const auto found = first ? meet(a, b, half, t, tolerance) : meet(a, b, s, half, tolerance)) return found;
    }
    return std::nullopt;
}

SegmentTree::Box around(const CurveArc& arc, double margin) {
    SegmentTree::Box box = SegmentTree::Box::of(arc.chord);
    box.left -= margin, box.right += margin, box.low -= margin, box.high += margin;
    return box;
}

/// The arcs' chords in a tree, with the largest width among them.
struct ArcTree {
    explicit ArcTree(const std::vector<CurveArc>& arcs) : tree(chords(arcs)) {
        for (const CurveArc& arc : arcs) width = std::max(width, arc.width);
    }
    static std::vector<Segment> chords(const std::vector<CurveArc>& arcs) {
        std::vector<Segment> segments;
        for (const CurveArc& arc : arcs) segments.push_back(arc.chord);
        return segments;
    }
    SegmentTree tree;
    double width = 0;
};

/// Whether the second of two sides goes straight back along the first.
bool turns_back(const CurveArc& before, const CurveArc& after) {
    const Complex turn = std::conj(before.chord.b - before.chord.a) * (after.chord.b - after.chord.a);
    return turn.real() < 0 && std::abs(turn.imag()) <= 1e-9 * std::abs(turn.real());
}

}  // namespace

std::optional<CurveMeeting> self_meeting(const TargetCurve& curve) {
    if (curve.kind() == TargetCurve::Kind::circle) return std::nullopt;
    const std::vector<CurveArc> arcs = arcs_of(curve);
    const int n = static_cast<int>(arcs.size());
    // Neighbouring arcs of a spline do not meet but at their common end: both turn by less than 60° from their common
    // tangent.
    if (curve.kind() == TargetCurve::Kind::polygon)
        for (int i = 0; i < n; ++i)
            if (turns_back(arcs[i], arcs[(i + 1) % n])) return CurveMeeting{arcs[i].begin, arcs[(i + 1) % n].begin};
    const ArcTree all(arcs);
    const double tolerance = kTolerance * curve.diameter();
    std::vector<int> near;
    for (int i = 0; i < n; ++i) {
        near.clear();
        all.tree.for_each(around(arcs[i], arcs[i].width + all.width + tolerance), [&](int j) {
            if (j > i + 1 && (j + 1) % n != i) near.push_back(j);
        });
        std::sort(near.begin(), near.end());
        for (const int j : near)
            if (const auto found = meet(curve, curve, arcs[i], arcs[j], tolerance)) return found;
    }
    return std::nullopt;
}

std::optional<CurveMeeting> meeting(const TargetCurve& a, const TargetCurve& b) {
    const std::vector<CurveArc> of_a = arcs_of(a), of_b = arcs_of(b);
    const ArcTree all(of_b);
    const double tolerance = kTolerance * std::max(a.diameter(), b.diameter());
    std::vector<int> near;
    for (const CurveArc& arc : of_a) {
        near.clear();
        all.tree.for_each(around(arc, arc.width + all.width + tolerance), [&](int j) { near.push_back(j); });
        std::sort(near.begin(), near.end());
        for (const int j : near)
            if (const auto found = meet(a, b, arc, of_b[j], tolerance)) return found;
    }
    return std::nullopt;
}

}  // namespace beltrami
