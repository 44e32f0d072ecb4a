#include <gtest/gtest.h>

#include <array>

#include <beltrami/base/error.h>
#include <beltrami/starts/target_model.h>

#include "support/onto.h"

namespace beltrami {
namespace {

struct Target {
    Surface surface{test::disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0.3, 0.12}}, 0.15)};
    CircleDomainChart chart = circle_domain_chart(surface);
    int at(int loop, int position) const { return surface.topology.boundary_loops[loop][position]; }
};

TEST(CorrespondenceOnCircles, PairsOfVerticesBecomeMarksAtTheirPlaces) {
    const Target target;
    const std::array<std::array<int, 2>, 3> pairs{{{7, target.at(0, 5)}, {8, target.at(1, 3)}, {9, target.at(2, 11)}}};
    Correspondence wanted;
    for (const auto& [vertex, to] : pairs) wanted.marks.emplace_back(vertex, TargetVertex{to});
    const Correspondence own = correspondence_on_circles(wanted, target.surface, target.chart);
    ASSERT_EQ(own.marks.size(), 3u);
    const TargetDomain domain = circle_target(target.chart);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(own.marks[i].vertex, pairs[i][0]);
        const Complex place = domain.curve(on_curve(own.marks[i]).curve).point(on_curve(own.marks[i]).parameter);
        EXPECT_NEAR(std::abs(place - target.chart.chart.vertices[pairs[i][1]]), 0, 1e-12);
    }
}

TEST(CorrespondenceOnCircles, LoopsBecomeCurves) {
    const Target target;
    Correspondence wanted;
    wanted.loops = {{0, 0}, {1, 2}, {2, 1}};
    const Correspondence own = correspondence_on_circles(wanted, target.surface, target.chart);
    const TargetDomain domain = circle_target(target.chart);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(own.loops[i][0], wanted.loops[i][0]);
        const RoundHole circle = target.chart.circle(wanted.loops[i][1]);
        EXPECT_EQ(domain.curve(own.loops[i][1]).centre(), circle.centre);
        EXPECT_EQ(domain.curve(own.loops[i][1]).radius(), circle.radius);
    }
    // The curves are numbered by the circle domain: with another loop outside, 0 is that one.
    const CircleDomainChart turned = circle_domain_chart(target.surface, 1);
    EXPECT_EQ(correspondence_on_circles(wanted, target.surface, turned).loops[2][1], 0);
}

TEST(CorrespondenceOnCircles, RefusesWhatTheTargetHasNot) {
    const Target target;
    const auto cause = [&](const Correspondence& wanted) {
        try {
            correspondence_on_circles(wanted, target.surface, target.chart);
        } catch (const Error& error) {
            return error.cause();
        }
        return Cause::cancelled;
    };
    int inside = 0;
    while (target.surface.topology.on_boundary[inside]) ++inside;
    Correspondence loops, marks, inner, none;
    loops.loops = {{0, 3}};
    marks.marks = {{0, 0, 0.0}};
    inner.marks = {{0, TargetVertex{inside}}};
    none.marks = {{0, TargetVertex{-5}}};
    EXPECT_EQ(cause(loops), Cause::bad_option);
    EXPECT_EQ(cause(marks), Cause::bad_option);
    EXPECT_EQ(cause(inner), Cause::bad_boundary);
    EXPECT_EQ(cause(none), Cause::bad_boundary);
}

}  // namespace
}  // namespace beltrami
