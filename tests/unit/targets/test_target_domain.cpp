#include <gtest/gtest.h>

#include <functional>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/targets/correspondence.h>
#include <beltrami/targets/target_domain.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

void expect_error(Cause cause, const std::string& part, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << "no error with \"" << part << "\"";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), cause) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(TargetDomain, TurnsItsCurves) {
    const TargetCurve square = TargetCurve::polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
    const TargetCurve spline = TargetCurve::spline({{1, 3}, {1.5, 3.2}, {2, 3}, {1.5, 2.5}});
    const TargetDomain domain = target_domain(square.reversed(), {TargetCurve::circle({3, 1}, 0.5), spline});
    EXPECT_EQ(domain.curve_count(), 3);
    EXPECT_TRUE(domain.outer.counter_clockwise());
    EXPECT_FALSE(domain.curve(1).counter_clockwise());
    EXPECT_FALSE(domain.curve(2).counter_clockwise());
    EXPECT_NO_THROW(validate(domain));
    EXPECT_TRUE(domain.contains({1, 1}));
    EXPECT_FALSE(domain.contains({3, 1.2}));
    EXPECT_FALSE(domain.contains({1.5, 2.9}));
    EXPECT_FALSE(domain.contains({5, 1}));
    EXPECT_NEAR(domain.area(), 16 - kPi / 4 - spline.area(), 1e-12);
    // The domain is on the left of every curve.
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 20; ++i) {
            const CurvePlace at = domain.curve(c).at(domain.curve(c).length() * (i + 0.3) / 20);
            EXPECT_TRUE(domain.contains(at.point + Complex(0, 1e-6) * at.tangent));
        }
    expect_error(Cause::bad_option, "hole 0 runs the wrong way", [&] {
        validate({square, {TargetCurve::circle({3, 1}, 0.5)}});
    });
}

TEST(TargetDomain, RefusesCurvesThatBoundNothing) {
    const TargetCurve disk = TargetCurve::circle(0, 2);
    const auto with = [&](std::vector<TargetCurve> holes) { return [=] { target_domain(disk, holes); }; };
    expect_error(Cause::bad_option, "the outer curve and hole 0 meet", with({TargetCurve::circle(1.5, 0.5)}));
    expect_error(Cause::bad_option, "hole 0 and hole 1 meet",
                 with({TargetCurve::circle(0, 0.5), TargetCurve::circle(0.9, 0.5)}));
    expect_error(Cause::bad_option, "hole 0 lies outside the outer curve", with({TargetCurve::circle(5, 0.5)}));
    expect_error(Cause::bad_option, "hole 0 lies outside the outer curve", with({TargetCurve::circle(0, 5)}));
    expect_error(Cause::bad_option, "hole 1 lies in hole 0",
                 with({TargetCurve::circle(0, 0.9), TargetCurve::circle(0.1, 0.3)}));
    expect_error(Cause::bad_option, "hole 0 lies in hole 1",
                 with({TargetCurve::circle(0.1, 0.3), TargetCurve::circle(0, 0.9)}));
}

TEST(TargetDomain, OfAMeshHasItsLoops) {
    DomainOptions options{.edge_length = 0.1};
    Mesh mesh = circle_domain({{1, 2}, 1}, {{{1.4, 2}, 0.2}, {{0.5, 2.2}, 0.3}}, options);
    for (const bool flipped : {false, true}) {
        if (flipped) mesh.positions.col(1) *= -1;  // the faces run clockwise now: seen from below it is the same
        const Surface surface(mesh);
        const TargetDomain domain = boundary_domain(surface);
        ASSERT_EQ(domain.curve_count(), 3);
        EXPECT_NO_THROW(validate(domain));
        double area = 0;
        for (int f = 0; f < mesh.face_count(); ++f) area += std::abs(face_vector_area(mesh, f).z());
        EXPECT_NEAR(domain.area(), area, 1e-12);
        for (int l = 0; l < 3; ++l) {
            const auto& loop = surface.topology.boundary_loops[l];
            const auto& knots = domain.curve(l).knots();
            ASSERT_EQ(knots.size(), loop.size());
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Complex z = domain.curve(l).point(knots[i]);
                EXPECT_NEAR(
                    std::abs(z - Complex(mesh.positions(loop[i], 0), mesh.positions(loop[i], 1) * (flipped ? -1 : 1))),
                    0, 1e-15);
            }
            EXPECT_NEAR(domain.curve(l).length(), surface.topology.loop_lengths[l], 1e-12);
        }
    }
    expect_error(Cause::bad_mesh, "does not lie in the plane", [] {
        Mesh bowl = disk(3);
        bowl.positions.conservativeResize(bowl.vertex_count(), 3);
        bowl.positions.col(2) = bowl.positions.leftCols(2).rowwise().squaredNorm();
        boundary_domain(Surface(bowl));
    });
    expect_error(Cause::bad_boundary, "boundary loop 0", [] {
        // A strip that runs more than once around and overlaps itself.
        Mesh strip;
        strip.positions.resize(82, 2);
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j < 2; ++j) {
                const Complex z = std::polar(1 + j + 0.01 * i, 2.4 * kPi * i / 40);
                strip.positions.row(2 * i + j) << z.real(), z.imag();
                if (i < 40 && j == 0) strip.faces.add({2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
            }
        boundary_domain(Surface(strip));
    });
}

class MarksTest : public ::testing::Test {
  protected:
    const Surface source{circle_domain({{0, 0}, 1}, {{{0, 0}, 0.3}}, {.edge_length = 0.1})};
    const TargetDomain domain =
        target_domain(TargetCurve::polygon({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}), {TargetCurve::circle(0, 0.5)});
    const std::vector<int> partners{0, 1};
    int at(int loop, int position) const { return source.topology.boundary_loops[loop][position]; }
};

TEST_F(MarksTest, GoToNearestPointsOfTheNearestCurve) {
    const std::vector<Complex> points{{-1, -3}, {0.1, 0}, {5, 0}, {0, 1.9}};
    const std::vector<int> vertices{at(0, 3), at(1, 2), at(0, 9), at(0, 20)};
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < points.size(); ++i) marks.push_back(nearest_mark(domain, vertices[i], points[i]));
    EXPECT_EQ(marks[0].vertex, at(0, 3));
    EXPECT_EQ(on_curve(marks[0]).curve, 0);
    EXPECT_NEAR(on_curve(marks[0]).parameter, 1, 1e-15);
    EXPECT_EQ(on_curve(marks[1]).curve, 1);
    EXPECT_NEAR(std::abs(domain.curve(1).point(on_curve(marks[1]).parameter) - Complex(0.5, 0)), 0, 1e-15);
    EXPECT_NEAR(on_curve(marks[2]).parameter, 6, 1e-15);
    EXPECT_NEAR(on_curve(marks[3]).parameter, 10, 1e-15);
    EXPECT_NO_THROW(validate(marks, source, domain, partners));
    // Started anywhere on the loop, and with any two, the order is right.
    EXPECT_NO_THROW(validate({marks[3], marks[0]}, source, domain, partners));
    EXPECT_NO_THROW(validate({{at(0, 3), 0, 10}, {at(0, 9), 0, 1}, {at(0, 20), 0, 6}}, source, domain, partners));
    expect_error(Cause::bad_boundary, "not finite", [&] { nearest_mark(domain, 0, {std::nan(""), 0}); });
}

TEST_F(MarksTest, RefusesContradictions) {
    const auto mark = [&](std::vector<Mark> marks) { return [=, this] { validate(marks, source, domain, partners); }; };
    int inner = 0;
    while (source.topology.on_boundary[inner]) ++inner;
    expect_error(Cause::bad_boundary, "not on the boundary", mark({{inner, 0, 0.0}}));
    expect_error(Cause::bad_boundary, "counted from 0", mark({{source.mesh.vertex_count(), 0, 0.0}}));
    expect_error(Cause::bad_boundary, "counted from 0", mark({{-1, 0, 0.0}}));
    expect_error(Cause::bad_boundary, "marked twice", mark({{at(0, 1), 0, 0.0}, {at(0, 1), 0, 1.0}}));
    expect_error(Cause::bad_boundary, "partner of its loop", mark({{at(0, 1), 0, std::nan("")}}));
    expect_error(Cause::bad_boundary, "partner of its loop", mark({{at(0, 1), 1, 0.0}}));
    expect_error(Cause::bad_boundary, "one place", mark({{at(0, 1), 0, 8.0}, {at(0, 2), 0, 8.0}}));
    expect_error(Cause::bad_boundary, "another order",
                 mark({{at(0, 1), 0, 2.0}, {at(0, 5), 0, 14.0}, {at(0, 9), 0, 6.0}}));
    expect_error(Cause::bad_option, "does not exist or is taken", [&] { validate({}, source, domain, {0, 0}); });
    expect_error(Cause::bad_option, "2 boundary loops", [&] { validate({}, source, domain, {0}); });
}

}  // namespace
}  // namespace beltrami
