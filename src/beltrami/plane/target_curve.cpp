#include <beltrami/plane/target_curve.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/plane/curve_meeting.h>
#include <beltrami/plane/curve_pieces.h>

namespace beltrami {

namespace {

void require_points(const std::vector<Complex>& points, const std::string& what, const std::string& which) {
    const int n = static_cast<int>(points.size());
    if (n < 3)
        throw Error(Cause::bad_option, "the " + what + " has only " + std::to_string(n) + " " + which + "s",
                    "give at least three");
    for (int i = 0; i < n; ++i)
        if (!(std::abs(points[i].real()) < 1e150 && std::abs(points[i].imag()) < 1e150))
            throw Error(Cause::bad_option, which + " " + std::to_string(i) + " of the " + what + " is not finite",
                        "give coordinates below 1e150", {Things::points, {i}});
    for (int i = 0; i < n; ++i) {
        const int next = (i + 1) % n;
        if (points[i] == points[next])
            throw Error(
                Cause::bad_option,
                which + "s " + std::to_string(i) + " and " + std::to_string(next) + " of the " + what + " coincide",
                "list every point once; the curve closes by itself", {Things::points, {i, next}});
    }
}

/// The same points the other way round, beginning with the same one.
std::vector<Complex> turned_around(std::vector<Complex> points) {
    std::reverse(points.begin() + 1, points.end());
    return points;
}

}  // namespace

/// @throw Error bad_option as polygon and spline
TargetCurve TargetCurve::through(Kind kind, const std::vector<Complex>& points) {
    const bool is_polygon = kind == Kind::polygon;
    const std::string what = is_polygon ? "polygon" : "spline", which = is_polygon ? "corner" : "point";
    require_points(points, what, which);
    const auto follow = [&](const std::vector<Complex>& in_order) {
        auto data = std::make_shared<detail::CurvePieces>();
        data->kind = kind;
        data->points = in_order;
        data->follow();
        return TargetCurve(std::move(data));
    };
    const TargetCurve given = follow(points);
    if (const auto found = self_meeting(given)) {
        const auto span_of = [&](double s) {
            const std::vector<double>& knots = given.data_->knots;
            return static_cast<int>(std::upper_bound(knots.begin(), knots.end(), s) - knots.begin()) - 1;
        };
        const int a = span_of(found->first), b = span_of(found->second), first = std::min(a, b),
                  second = std::max(a, b);
        throw Error(Cause::bad_option,
                    (is_polygon ? "sides " : "the spline meets itself: its spans ") + std::to_string(first) + " and " +
                        std::to_string(second) + (is_polygon ? " of the polygon meet" : " meet") + " near " +
                        detail::at_place(given.point(found->first)),
                    "they are counted by the " + which + " where they begin, from 0; list the " + which +
                        "s in order around a simple curve",
                    {Things::points, {first, second}});
    }
    if (!(given.area() > 1e-14 * given.diameter() * given.diameter()))
        throw Error(Cause::bad_option, "the " + what + " encloses no area",
                    "give " + which + "s that are not on one line");
    return given.counter_clockwise() ? given : follow(turned_around(points));
}

TargetCurve TargetCurve::polygon(const std::vector<Complex>& corners) {
    return through(Kind::polygon, corners);
}

TargetCurve TargetCurve::spline(const std::vector<Complex>& points) {
    return through(Kind::spline, points);
}

TargetCurve TargetCurve::circle(Complex centre, double radius) {
    if (!(std::abs(centre.real()) < 1e150 && std::abs(centre.imag()) < 1e150))
        throw Error(Cause::bad_option, "the centre of the circle is not finite", "give coordinates below 1e150");
    if (!(radius > 0 && radius < 1e150))
        throw Error(Cause::bad_option, "the circle has no positive finite radius",
                    "give a radius above 0 and below 1e150");
    auto data = std::make_shared<detail::CurvePieces>();
    data->centre = centre;
    data->radius = radius;
    data->follow();
    return TargetCurve(std::move(data));
}

TargetCurve TargetCurve::reversed() const {
    auto data = std::make_shared<detail::CurvePieces>();
    data->kind = data_->kind;
    data->centre = data_->centre;
    data->radius = data_->radius;
    data->counter_clockwise = !data_->counter_clockwise;
    if (!data_->points.empty()) data->points = turned_around(data_->points);
    data->follow();
    return TargetCurve(std::move(data));
}

TargetCurve::Kind TargetCurve::kind() const {
    return data_->kind;
}

double TargetCurve::length() const {
    return data_->length();
}

double TargetCurve::area() const {
    return data_->area;
}

bool TargetCurve::counter_clockwise() const {
    return data_->counter_clockwise;
}

double TargetCurve::wrap(double s) const {
    const double whole = length();
    if (s >= 0 && s < whole) return s;
    const double wrapped = s - whole * std::floor(s / whole);
    return wrapped >= 0 && wrapped < whole ? wrapped : 0.0;
}

CurvePlace TargetCurve::at(double s) const {
    return data_->at(wrap(s));
}

Complex TargetCurve::tangent_before(double s) const {
    s = wrap(s);
    if (kind() != Kind::polygon) return tangent(s);
    const int piece = data_->piece_at(s);
    const int before = s > data_->ends[piece] ? piece : (piece + data_->piece_count() - 1) % data_->piece_count();
    const Complex along = data_->side(before);
    return along / std::abs(along);
}

double TargetCurve::nearest(Complex p, std::optional<double> hint) const {
    return wrap(data_->nearest(p, hint ? std::optional(wrap(*hint)) : hint));
}

int TargetCurve::winding(Complex p) const {
    if (kind() == Kind::circle) return std::abs(p - centre()) < radius() ? (counter_clockwise() ? 1 : -1) : 0;
    return static_cast<int>(std::lround(data_->turning(p) / kTurn));
}

std::vector<double> TargetCurve::corners(double min_turn) const {
    std::vector<double> found;
    if (kind() != Kind::polygon) return found;
    for (const double s : data_->knots)
        if (std::abs(std::arg(tangent(s) / tangent_before(s))) > min_turn) found.push_back(s);
    return found;
}

const std::vector<double>& TargetCurve::knots() const {
    return data_->knots;
}

const std::vector<Complex>& TargetCurve::points() const {
    return data_->points;
}

Complex TargetCurve::centre() const {
    return data_->centre;
}

double TargetCurve::radius() const {
    return data_->radius;
}

const std::vector<double>& TargetCurve::piece_ends() const {
    return data_->ends;
}

double TargetCurve::diameter() const {
    const SegmentTree::Box& box = data_->runs[0].box;
    return std::hypot(box.right - box.left, box.high - box.low);
}

}  // namespace beltrami
