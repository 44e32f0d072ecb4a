#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/plane/closed_spline.h>
#include <beltrami/plane/curve_meeting.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami {
namespace {

std::vector<Complex> ellipse_points(int n, double a, double b) {
    std::vector<Complex> points;
    for (int i = 0; i < n; ++i) {
        const double t = 2 * kPi * (i + 0.3 * std::sin(2.0 * i * 2 * kPi / n)) / n;
        points.emplace_back(a * std::cos(t), b * std::sin(t));
    }
    return points;
}

/// A wavy, far from round, simple curve.
TargetCurve wavy(int n = 40) {
    std::vector<Complex> points;
    for (int i = 0; i < n; ++i) {
        const double t = 2 * kPi * i / n;
        points.push_back(Complex(3, -1) + std::polar(2 + 0.8 * std::cos(5 * t), t));
    }
    return TargetCurve::spline(points);
}

TargetCurve notched() {
    return TargetCurve::polygon({{0, 0}, {4, 0}, {4, 3}, {2.2, 3}, {2.1, 0.5}, {2, 3}, {0, 3}});
}

/// A part of a cubic as a cubic of its own.
detail::Cubic span_part(const detail::Cubic& span, double from, double to) {
    const double third = (to - from) / 3;
    return {{span.point(from), span.point(from) + third * span.velocity(from),
             span.point(to) - third * span.velocity(to), span.point(to)}};
}

std::vector<TargetCurve> samples() {
    return {TargetCurve::circle({1, 2}, 3),
            TargetCurve::circle({1, 2}, 3).reversed(),
            notched(),
            notched().reversed(),
            wavy(),
            wavy().reversed()};
}

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_option);
        return error.what();
    }
    return "";
}

TEST(TargetCurve, Circle) {
    const TargetCurve circle = TargetCurve::circle({1, 2}, 0.5);
    EXPECT_NEAR(circle.length(), kPi, 1e-15);
    EXPECT_NEAR(circle.area(), kPi / 4, 1e-15);
    EXPECT_TRUE(circle.counter_clockwise());
    EXPECT_NEAR(std::abs(circle.point(kPi / 4) - Complex(1, 2.5)), 0, 1e-15);
    EXPECT_NEAR(std::abs(circle.tangent(0) - Complex(0, 1)), 0, 1e-15);
    EXPECT_NEAR(std::abs(circle.curvature(0) - Complex(-2, 0)), 0, 1e-15);
    EXPECT_NEAR(circle.nearest({1, 5}), kPi / 4, 1e-15);
    EXPECT_EQ(circle.nearest({1, 2}, 0.7), 0.7) << "every point is nearest to the centre: the hint stays";
    EXPECT_TRUE(circle.corners().empty());
    const TargetCurve back = circle.reversed();
    EXPECT_NEAR(std::abs(back.point(kPi / 4) - Complex(1, 1.5)), 0, 1e-15);
    EXPECT_NEAR(std::abs(back.tangent(0) - Complex(0, -1)), 0, 1e-15);
    EXPECT_NEAR(std::abs(back.curvature(0) - Complex(-2, 0)), 0, 1e-15);
    EXPECT_NEAR(back.nearest({1, -7}), kPi / 4, 1e-15);
    EXPECT_EQ(circle.winding({1.2, 2}), 1);
    EXPECT_EQ(back.winding({1.2, 2}), -1);
    EXPECT_EQ(circle.winding({1.6, 2}), 0);
}

TEST(TargetCurve, Polygon) {
    const TargetCurve square = TargetCurve::polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}});
    EXPECT_EQ(square.length(), 6);
    EXPECT_EQ(square.area(), 2);
    EXPECT_EQ(square.corners(), (std::vector<double>{0, 2, 3, 5}));
    EXPECT_EQ(square.point(2.5), Complex(2, 0.5));
    EXPECT_EQ(square.point(-0.25), Complex(0, 0.25));
    EXPECT_EQ(square.tangent(2), Complex(0, 1)) << "the side that begins";
    EXPECT_EQ(square.tangent_before(2), Complex(1, 0)) << "the side that ends";
    EXPECT_EQ(square.tangent_before(0), Complex(0, -1));
    EXPECT_EQ(square.tangent_before(2.5), square.tangent(2.5));
    EXPECT_EQ(square.curvature(1), 0.0);
    EXPECT_EQ(square.nearest({1.5, -3}), 1.5);
    EXPECT_EQ(square.nearest({5, 5}), 3);
    // The same corners clockwise: the curve is turned, and begins at the first corner all the same.
    const TargetCurve same = TargetCurve::polygon({{0, 0}, {0, 1}, {2, 1}, {2, 0}});
    EXPECT_EQ(same.points(), square.points());
    EXPECT_TRUE(same.counter_clockwise());
    const TargetCurve back = square.reversed();
    EXPECT_FALSE(back.counter_clockwise());
    EXPECT_EQ(back.points(), (std::vector<Complex>{{0, 0}, {0, 1}, {2, 1}, {2, 0}}));
    EXPECT_EQ(back.corners(), (std::vector<double>{0, 1, 3, 4}));
    EXPECT_EQ(back.area(), 2);
    // A point in the middle of a side is a knot, no corner.
    const TargetCurve more = TargetCurve::polygon({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}});
    EXPECT_EQ(more.corners(), square.corners());
    EXPECT_EQ(more.knots(), (std::vector<double>{0, 1, 2, 3, 5}));
}

TEST(TargetCurve, ParameterIsArcLength) {
    for (const TargetCurve& curve : samples()) {
        const double length = curve.length();
        const int n = 20000;
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const double s = length * i / n, step = length / n;
            const double chord = std::abs(curve.point(s + step) - curve.point(s));
            EXPECT_LE(chord, step * (1 + 1e-9));
            sum += chord;
        }
        // Chords fall short by κ² step³ / 24, or by the cut of a corner.
        EXPECT_NEAR(sum, length, curve.kind() == TargetCurve::Kind::polygon ? 2e-3 : 1e-5);
        EXPECT_NEAR(curve.wrap(length), 0, 1e-15);
        EXPECT_EQ(curve.point(curve.wrap(3 * length + 0.1)), curve.point(curve.wrap(3 * length + 0.1 - 1e-30)));
        EXPECT_NEAR(curve.ahead(length - 0.1, 0.2), 0.3, 1e-12);
    }
}

TEST(TargetCurve, TangentAndCurvatureAreDerivatives) {
    for (const TargetCurve& curve : samples()) {
        const double length = curve.length(), h = 1e-5 * length;
        for (int i = 0; i < 97; ++i) {
            const double s = length * (i + 0.37) / 97;
            const CurvePlace at = curve.at(s);
            EXPECT_NEAR(std::abs(at.tangent), 1, 1e-14);
            EXPECT_NEAR(std::real(std::conj(at.tangent) * at.curvature), 0, 1e-12);
            // Fourth-order differences, but not across corners.
            bool near_corner = false;
            for (const double c : curve.corners())
                near_corner |= std::min(curve.ahead(c, s), curve.ahead(s, c)) < 3 * h;
            if (near_corner) continue;
            const auto p = [&](int k) { return curve.point(s + k * h); };
            const Complex first = (8.0 * (p(1) - p(-1)) - (p(2) - p(-2))) / (12 * h);
            const Complex second = (16.0 * (p(1) + p(-1)) - (p(2) + p(-2)) - 30.0 * p(0)) / (12 * h * h);
            EXPECT_NEAR(std::abs(first - at.tangent), 0, 1e-7);
            // The third derivative of a spline jumps at its knots.
            EXPECT_NEAR(std::abs(second - at.curvature), 0, 2e-3);
        }
    }
}

TEST(TargetCurve, SplineArcLengthIsAccurate) {
    // Far smaller steps than the pieces: Romberg's sum of chords converges to the length of the table.
    const TargetCurve curve = wavy(12);
    const std::vector<detail::Cubic> spans = detail::closed_spline(curve.points());
    double brute = 0;
    for (const detail::Cubic& span : spans) {
        const auto simpson = [&](int n) {
            double sum = std::abs(span.velocity(0)) + std::abs(span.velocity(1));
            for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * std::abs(span.velocity(static_cast<double>(i) / n));
            return sum / (3 * n);
        };
        brute += (16 * simpson(4000) - simpson(2000)) / 15;
    }
    EXPECT_NEAR(curve.length(), brute, 1e-12 * brute);
    // The inverse: each knot is where its point is, and lengths measured along add up.
    for (std::size_t i = 0; i < spans.size(); ++i) {
        EXPECT_NEAR(std::abs(curve.point(curve.knots()[i]) - curve.points()[i]), 0, 1e-14);
        for (const double u : {0.123, 0.5, 0.877}) {
            // Length from the knot to u in a hundred steps of the 8-point rule.
            double along = 0;
            for (int k = 0; k < 100; ++k) {
                along += span_part(spans[i], u * k / 100, u * (k + 1) / 100).arc_length(1);
            }
            EXPECT_NEAR(std::abs(curve.point(curve.knots()[i] + along) - spans[i].point(u)), 0, 1e-13);
        }
    }
}

TEST(TargetCurve, SplineConvergesWithOrderFour) {
    double point_error[3], tangent_error[3], curvature_error[3], length_error[3];
    for (int level = 0; level < 3; ++level) {
        const int n = 16 << level;
        std::vector<Complex> points;
        // Unevenly spaced on a circle of radius 2.
        for (int i = 0; i < n; ++i)
            points.push_back(std::polar(2.0, 2 * kPi * i / n + 0.2 * std::sin(2 * kPi * i / n)));
        const TargetCurve curve = TargetCurve::spline(points);
        length_error[level] = std::abs(curve.length() - 4 * kPi);
        point_error[level] = tangent_error[level] = curvature_error[level] = 0;
        for (int i = 0; i < 1000; ++i) {
            const double s = curve.length() * i / 1000;
            const CurvePlace at = curve.at(s);
            const Complex exact = std::polar(2.0, s / 2);
            point_error[level] = std::max(point_error[level], std::abs(at.point - exact));
            tangent_error[level] = std::max(tangent_error[level], std::abs(at.tangent - Complex(0, 0.5) * exact));
            curvature_error[level] = std::max(curvature_error[level], std::abs(at.curvature + exact / 4.0));
        }
    }
    for (int level = 0; level < 2; ++level) {
        EXPECT_GT(std::log2(length_error[level] / length_error[level + 1]), 3.7);
        EXPECT_GT(std::log2(point_error[level] / point_error[level + 1]), 3.7);
        EXPECT_GT(std::log2(tangent_error[level] / tangent_error[level + 1]), 2.7);
        EXPECT_GT(std::log2(curvature_error[level] / curvature_error[level + 1]), 1.7);
    }
    EXPECT_LT(point_error[2], 1e-5);
}

TEST(TargetCurve, SplineIsTwiceDifferentiable) {
    const TargetCurve curve = wavy(15);
    const auto jump = [&](double s, double step, bool second) {
        const CurvePlace before = curve.at(s - step), after = curve.at(s + step);
        return std::abs(second ? before.curvature - after.curvature : before.tangent - after.tangent);
    };
    for (const double s : curve.knots())
        for (const bool second : {false, true}) {
            EXPECT_LT(jump(s, 1e-8, second), 1e-4);
            EXPECT_LT(jump(s, 1e-8, second), 0.02 * jump(s, 1e-6, second) + 1e-12) << "goes to 0 with the step";
        }
}

TEST(TargetCurve, AreaOfASplineIsThatOfItsInside) {
    const TargetCurve curve = TargetCurve::spline(ellipse_points(200, 3, 1));
    EXPECT_NEAR(curve.area(), 3 * kPi, 1e-5);
    EXPECT_NEAR(curve.reversed().area(), curve.area(), 1e-12);
}

TEST(TargetCurve, NearestAgreesWithBruteForce) {
    unsigned state = 7;
    const auto random = [&] {
        state = 1664525u * state + 1013904223u;
        return (state >> 8) / double(1 << 24);
    };
    for (const TargetCurve& curve : samples()) {
        const int n = 20000;
        std::vector<Complex> dense(n);
        for (int i = 0; i < n; ++i) dense[i] = curve.point(curve.length() * i / n);
        double hint = 0;
        for (int query = 0; query < 300; ++query) {
            const Complex p(-1 + 8 * random(), -5 + 9 * random());
            double least = 1e300;
            for (const Complex q : dense) least = std::min(least, std::abs(q - p));
            const double s = curve.nearest(p), away = std::abs(curve.point(s) - p);
            EXPECT_GE(s, 0);
            EXPECT_LT(s, curve.length());
            EXPECT_LE(away, least + 1e-12);
            EXPECT_GE(away, least - 1e-3);
            // At the foot the direction is perpendicular, or the foot is a corner.
            const auto slope = [&](Complex tangent) { return std::real(std::conj(tangent) * (curve.point(s) - p)); };
            if (std::abs(curve.tangent(s) - curve.tangent_before(s)) < 1e-12) {
                EXPECT_NEAR(slope(curve.tangent(s)), 0, 1e-11);
            } else {
                EXPECT_LE(slope(curve.tangent_before(s)), 1e-12);
                EXPECT_GE(slope(curve.tangent(s)), -1e-12);
            }
            hint = curve.nearest(p, hint);
            EXPECT_NEAR(std::abs(curve.point(hint) - p), away, 1e-12);
        }
        // Points of the curve find themselves.
        for (int i = 0; i < 100; ++i) {
            const double s = curve.length() * i / 100, found = curve.nearest(curve.point(s));
            EXPECT_LT(std::min(curve.ahead(s, found), curve.ahead(found, s)), 1e-7);
            EXPECT_LT(std::abs(curve.point(found) - curve.point(s)), 1e-14);
        }
    }
}

TEST(TargetCurve, WindingAgreesWithCrossings) {
    unsigned state = 99;
    const auto random = [&] {
        state = 1664525u * state + 1013904223u;
        return (state >> 8) / double(1 << 24);
    };
    for (const TargetCurve& curve : samples()) {
        const int n = 20000;
        std::vector<Complex> dense(n);
        for (int i = 0; i < n; ++i) dense[i] = curve.point(curve.length() * i / n);
        for (int query = 0; query < 300; ++query) {
            const Complex p(-1 + 8 * random(), -5 + 9 * random());
            if (std::abs(curve.point(curve.nearest(p)) - p) < 1e-3) continue;
            bool inside = false;
            for (int i = 0; i < n; ++i) {
                const Complex a = dense[i], b = dense[(i + 1) % n];
                if ((a.imag() > p.imag()) != (b.imag() > p.imag()) &&
                    p.real() < a.real() + (b.real() - a.real()) * (p.imag() - a.imag()) / (b.imag() - a.imag()))
                    inside = !inside;
            }
            EXPECT_EQ(curve.contains(p), inside);
            EXPECT_EQ(curve.winding(p), !inside ? 0 : curve.counter_clockwise() ? 1 : -1);
        }
        // A hair beside the curve.
        for (int i = 0; i < 100; ++i) {
            const CurvePlace at = curve.at(curve.length() * (i + 0.41) / 100);
            const Complex left = Complex(0, curve.counter_clockwise() ? 1e-9 : -1e-9) * at.tangent;
            EXPECT_TRUE(curve.contains(at.point + left));
            EXPECT_FALSE(curve.contains(at.point - left));
        }
    }
}

TEST(TargetCurve, ReversedIsTheSameCurve) {
    for (const TargetCurve& curve : samples()) {
        const TargetCurve back = curve.reversed();
        EXPECT_NEAR(back.length(), curve.length(), 1e-13 * curve.length());
        for (int i = 0; i < 50; ++i) {
            const double s = curve.length() * (i + 0.3) / 50;
            EXPECT_NEAR(std::abs(back.point(-s) - curve.point(s)), 0, 1e-13);
            EXPECT_NEAR(std::abs(back.tangent(-s) + curve.tangent(s)), 0, 1e-12);
            EXPECT_NEAR(std::abs(back.curvature(-s) - curve.curvature(s)), 0, 1e-10);
        }
    }
}

TEST(TargetCurve, MovesWithItsPoints) {
    const std::vector<Complex> points = wavy(20).points();
    std::vector<Complex> moved;
    const Complex turn = std::polar(1e3, 1.1), shift(5e3, -7e3);
    for (const Complex p : points) moved.push_back(turn * p + shift);
    const TargetCurve a = TargetCurve::spline(points), b = TargetCurve::spline(moved);
    EXPECT_NEAR(b.length(), 1e3 * a.length(), 1e-9 * b.length());
    for (int i = 0; i < 50; ++i) {
        const double s = a.length() * i / 50;
        EXPECT_NEAR(std::abs(b.point(1e3 * s) - (turn * a.point(s) + shift)), 0, 1e-8);
        EXPECT_NEAR(std::abs(b.curvature(1e3 * s) - turn * a.curvature(s) * 1e-6), 0, 1e-11);
    }
}

TEST(TargetCurve, RefusesWhatIsNoSimpleCurve) {
    const double nan = std::nan("");
    EXPECT_NE(message_of([&] { TargetCurve::circle({nan, 0}, 1); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::circle({0, 0}, 0); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::circle({0, 0}, -1); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::circle({0, 0}, nan); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::polygon({{0, 0}, {1, 0}}); }).find("only 2 corners"), std::string::npos);
    EXPECT_NE(message_of([&] {
                  TargetCurve::polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}});
              }).find("1 and 2"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  TargetCurve::polygon({{0, 0}, {1, 0}, {nan, 0}});
              }).find("corner 2"),
              std::string::npos);
    EXPECT_NE(message_of([&] { TargetCurve::polygon({{0, 0}, {1, 0}, {2, 0}}); }), "");
    // Bow tie, a corner that touches a side, a side that goes straight back, two coinciding corners.
    EXPECT_NE(message_of([&] {
                  TargetCurve::polygon({{0, 0}, {2, 2}, {2, 0}, {0, 2}});
              }).find("sides 0 and 2"),
              std::string::npos);
    EXPECT_NE(message_of([&] { TargetCurve::polygon({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::polygon({{0, 0}, {4, 0}, {4, 2}, {6, 2}, {4, 2}, {0, 3}}); }), "");
    EXPECT_NE(message_of([&] { TargetCurve::polygon({{0, 0}, {1, 0}, {2, 1}, {1, 0}, {0, 1}}); }), "");
    // The same clockwise, named by the corners as they were given.
    EXPECT_NE(message_of([&] {
                  TargetCurve::polygon({{0, 0}, {0, 3}, {3, 3}, {3, 1}, {-1, 2}});
              }).find("sides 0 and 3"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  TargetCurve::spline({{0, 0}, {2, 2}, {2, 0}, {0, 2}});
              }).find("meets itself"),
              std::string::npos);
    EXPECT_NE(message_of([&] { TargetCurve::spline({{0, 0}, {1, 0}}); }).find("only 2 points"), std::string::npos);
    EXPECT_NE(message_of([&] { TargetCurve::spline({{0, 0}, {1, 0}, {2, 0}}); }), "");
}

TEST(TargetCurve, MeetingsAreFoundAtAnyScale) {
    const TargetCurve unit = TargetCurve::circle(0, 1);
    EXPECT_TRUE(meeting(unit, TargetCurve::circle(2, 1)).has_value()) << "touching";
    EXPECT_FALSE(meeting(unit, TargetCurve::circle(2 + 1e-9, 1)).has_value());
    EXPECT_TRUE(meeting(unit, TargetCurve::circle(2 - 1e-9, 1)).has_value());
    EXPECT_FALSE(meeting(unit, TargetCurve::circle(1e-7, 0.5)).has_value()) << "one inside the other";
    EXPECT_TRUE(meeting(unit, TargetCurve::circle(0.5, 0.5)).has_value()) << "touching from inside";
    EXPECT_FALSE(meeting(unit, TargetCurve::circle(0.5 - 1e-9, 0.5)).has_value());
    const auto found = meeting(unit, TargetCurve::circle(1, 1));
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(std::abs(unit.point(found->first) - TargetCurve::circle(1, 1).point(found->second)), 0, 1e-5);
    EXPECT_NEAR(std::abs(unit.point(found->first).imag()), std::sqrt(0.75), 1e-5);
    const TargetCurve square = TargetCurve::polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
    EXPECT_TRUE(meeting(unit, square).has_value());
    EXPECT_FALSE(meeting(TargetCurve::circle(0, 1 - 1e-9), square).has_value());
    // A spline whose arms come near each other, cross, and do not.
    const auto arms = [](double gap) {
        return TargetCurve::spline({{0, 0}, {10, 0}, {10, 1}, {5, gap}, {5, 5 + gap}, {10, 4}, {10, 5}, {0, 5}});
    };
    EXPECT_NO_THROW(arms(1));
    EXPECT_THROW(arms(-3), Error);
}

}  // namespace
}  // namespace beltrami
