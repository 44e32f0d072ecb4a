#include <beltrami/plane/curve_pieces.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/plane/polygon.h>

namespace beltrami::detail {

namespace {

constexpr int kArcsOfCircle = 8;

using Box = SegmentTree::Box;

double distance_to(const Box& box, Complex p) {
    const double x = std::max({box.left - p.real(), 0.0, p.real() - box.right});
    const double y = std::max({box.low - p.imag(), 0.0, p.imag() - box.high});
    return std::hypot(x, y);
}

bool inside(const Box& box, Complex p) {
    return box.left <= p.real() && p.real() <= box.right && box.low <= p.imag() && p.imag() <= box.high;
}

}  // namespace

std::string at_place(Complex p) {
    std::ostringstream text;
    text << '(' << p.real() << ", " << p.imag() << ')';
    return text.str();
}

struct CurvePieces::Nearest {
    double distance = std::numeric_limits<double>::infinity();
    double s = 0;
    void offer(double other, double at) {
        if (other < distance) distance = other, s = at;
    }
};

int CurvePieces::piece_at(double s) const {
    const auto after = std::upper_bound(ends.begin(), ends.end(), s);
    return std::clamp(static_cast<int>(after - ends.begin()) - 1, 0, piece_count() - 1);
}

void CurvePieces::follow() {
    ends = {0.0};
    if (kind == Kind::circle) {
        area = std::numbers::pi * radius * radius;
        for (int i = 0; i <= kArcsOfCircle; ++i) {
            if (i > 0) ends.push_back(kTurn * radius * i / kArcsOfCircle);
            const int step = i % kArcsOfCircle;
            joints.push_back(centre + std::polar(radius, (counter_clockwise ? kTurn : -kTurn) * step / kArcsOfCircle));
        }
    } else if (kind == Kind::polygon) {
        area = signed_area(points);
        joints = points;
        joints.push_back(points[0]);
        for (int i = 0; i + 1 < static_cast<int>(joints.size()); ++i) ends.push_back(ends.back() + std::abs(side(i)));
        knots.assign(ends.begin(), ends.end() - 1);
    } else {
        const std::vector<Cubic> spans = closed_spline(points);
        for (std::size_t i = 0; i < spans.size(); ++i) {
            area += spans[i].swept_area(points[0]);
            knots.push_back(ends.back());
            const std::vector<Cubic> pieces = even_pieces(spans[i]);
            if (pieces.empty())
                throw Error(Cause::bad_option, "the spline has a cusp near " + at_place(points[i]),
                            "give points that are spaced more evenly");
            for (const Cubic& piece : pieces) {
                cubics.push_back(piece);
                joints.push_back(piece.control[0]);
                ends.push_back(ends.back() + piece.arc_length(1));
            }
        }
        joints.push_back(points[0]);
    }
    if (kind != Kind::circle) counter_clockwise = area >= 0;
    area = std::abs(area);
    widths.resize(piece_count());
    for (int i = 0; i < piece_count(); ++i) {
        const double along = ends[i + 1] - ends[i], straight = std::abs(side(i));
        widths[i] =
            kind == Kind::polygon ? 0.0 : 0.5 * std::sqrt(std::max(0.0, (along - straight) * (along + straight)));
    }
    runs.reserve(2 * static_cast<std::size_t>(piece_count()));
    build(0, piece_count());
}

int CurvePieces::build(int first, int last) {
    const int self = static_cast<int>(runs.size());
    runs.push_back({{}, first, last});
    Box box;
    if (last - first == 1) {
        box = Box::of({joints[first], joints[last]});
        const double w = widths[first];
        box.left -= w, box.right += w, box.low -= w, box.high += w;
    } else {
        const int middle = first + (last - first) / 2;
        box = runs[build(first, middle)].box;
        const int second = build(middle, last);
        runs[self].second = second;
        box.include(runs[second].box);
    }
    runs[self].box = box;
    return self;
}

/// The parameter u of the cubic at arc length s: Newton's method, kept in the bracket.
double CurvePieces::parameter_on(int piece, double s) const {
    const Cubic& cubic = cubics[piece];
    const double wanted = s - ends[piece], whole = ends[piece + 1] - ends[piece];
    double low = 0, high = 1, u = std::clamp(wanted / whole, 0.0, 1.0);
    for (int step = 0; step < 60; ++step) {
        const double error = cubic.arc_length(u) - wanted;
        (error > 0 ? high : low) = u;
        double next = u - error / std::abs(cubic.velocity(u));
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double moved = std::abs(next - u);
        u = next;
        if (moved <= 4e-16) break;
    }
    return u;
}

CurvePlace CurvePieces::at(double s) const {
    if (kind == Kind::circle) {
        const double way = counter_clockwise ? 1 : -1;
        const Complex out = std::polar(1.0, way * s / radius);
        return {centre + radius * out, Complex(0, way) * out, -out / radius};
    }
    const int piece = piece_at(s);
    if (kind == Kind::polygon) {
        const Complex along = side(piece);
        const double t = (s - ends[piece]) / (ends[piece + 1] - ends[piece]);
        return {joints[piece] + t * along, along / std::abs(along), 0.0};
    }
    const double u = parameter_on(piece, s);
    const Complex velocity = cubics[piece].velocity(u), acceleration = cubics[piece].acceleration(u);
    const double speed = std::abs(velocity);
    const Complex tangent = velocity / speed;
    const double curvature = std::imag(std::conj(velocity) * acceleration) / (speed * speed * speed);
    return {cubics[piece].point(u), tangent, curvature * Complex(0, 1) * tangent};
}

void CurvePieces::nearest_on(int piece, Complex p, Nearest& best) const {
    if (kind == Kind::polygon) {
        const Complex along = side(piece), to = p - joints[piece];
        const double t = std::clamp(std::real(std::conj(along) * to) / std::norm(along), 0.0, 1.0);
        best.offer(std::abs(to - t * along), ends[piece] + t * (ends[piece + 1] - ends[piece]));
        return;
    }
    // Between samples of the slope of the squared distance that change from negative to positive there is a minimum.
    const Cubic& cubic = cubics[piece];
    constexpr int kSamples = 4;
    const auto slope = [&](double u) { return std::real(std::conj(cubic.point(u) - p) * cubic.velocity(u)); };
    best.offer(std::abs(joints[piece] - p), ends[piece]);
    best.offer(std::abs(joints[piece + 1] - p), ends[piece + 1]);
    double before = slope(0);
    for (int i = 1; i <= kSamples; ++i) {
        const double after = slope(static_cast<double>(i) / kSamples);
        if (before < 0 && after > 0) {
            double low = static_cast<double>(i - 1) / kSamples, high = static_cast<double>(i) / kSamples;
            double u = low + (high - low) * before / (before - after);
            for (int step = 0; step < 60; ++step) {
                const Complex from = cubic.point(u) - p, velocity = cubic.velocity(u);
                const double value = std::real(std::conj(from) * velocity);
                (value > 0 ? high : low) = u;
                double next = u - value / (std::norm(velocity) + std::real(std::conj(from) * cubic.acceleration(u)));
                if (!(next >= low && next <= high)) next = 0.5 * (low + high);
                const double moved = std::abs(next - u);
                u = next;
                if (moved <= 4e-16) break;
            }
            const double away = std::abs(cubic.point(u) - p);
            if (away < best.distance) best.offer(away, ends[piece] + cubic.arc_length(u));
        }
        before = after;
    }
}

double CurvePieces::nearest(Complex p, std::optional<double> hint) const {
    if (kind == Kind::circle) {
        const Complex out = p - centre;
        if (out == 0.0) return hint.value_or(0.0);
        const double angle = (counter_clockwise ? 1 : -1) * std::arg(out);
        return radius * (angle < 0 ? angle + kTurn : angle);
    }
    Nearest best;
    if (hint) {
        best.offer(std::abs(at(*hint).point - p), *hint);
        nearest_on(piece_at(*hint), p, best);
    }
    struct Waiting {
        double distance;
        int run;
    };
    Waiting stack[128];
    int depth = 0;
    stack[depth++] = {distance_to(runs[0].box, p), 0};
    while (depth) {
        const Waiting now = stack[--depth];
        if (now.distance >= best.distance) continue;
        const Run& run = runs[now.run];
        if (run.second == 0) {
            const double least = distance(p, Segment{joints[run.first], joints[run.last]}) - widths[run.first];
            if (least < best.distance) nearest_on(run.first, p, best);
            continue;
        }
        Waiting near{distance_to(runs[now.run + 1].box, p), now.run + 1},
            far{distance_to(runs[run.second].box, p), run.second};
        if (far.distance < near.distance) std::swap(near, far);
        stack[depth++] = far;
        stack[depth++] = near;
    }
    return best.s;
}

/// The angle by which the direction from @p p turns along a part of a piece: as along its chord where p is not near.
double CurvePieces::turning_on(double begin, double end, Complex a, Complex b, Complex p, int depth) const {
    const double along = end - begin, straight = std::abs(b - a);
    const double width =
        kind == Kind::polygon ? 0.0 : 0.5 * std::sqrt(std::max(0.0, (along - straight) * (along + straight)));
    if (distance(p, Segment{a, b}) > width || depth == 48 || width == 0) return std::arg((b - p) / (a - p));
    const double middle = 0.5 * (begin + end);
    const Complex m = at(middle).point;
    return turning_on(begin, middle, a, m, p, depth + 1) + turning_on(middle, end, m, b, p, depth + 1);
}

/// The same along a run of pieces; whatever stays in a box turns as its chord does seen from outside the box.
double CurvePieces::turning(int index, Complex p) const {
    const Run& run = runs[index];
    const Complex a = joints[run.first], b = joints[run.last];
    if (!inside(run.box, p)) return std::arg((b - p) / (a - p));
    if (run.second == 0) return turning_on(ends[run.first], ends[run.last], a, b, p, 0);
    return turning(index + 1, p) + turning(run.second, p);
}

}  // namespace beltrami::detail
