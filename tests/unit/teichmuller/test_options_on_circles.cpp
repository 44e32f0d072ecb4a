#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/teichmuller/target_model.h>

#include "support/onto.h"

namespace beltrami {
namespace {

struct Target {
    Surface surface{test::disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0.3, 0.12}}, 0.15)};
    CircleDomainChart chart = circle_domain_chart(surface);
    int at(int loop, int position) const { return surface.topology.boundary_loops[loop][position]; }
};

TEST(OptionsOnCircles, PairsOfVerticesBecomeMarksAtTheirPlaces) {
    const Target target;
    OntoOptions options;
    options.tolerance = 1e-3;
    options.mark_vertices = {{7, target.at(0, 5)}, {8, target.at(1, 3)}, {9, target.at(2, 11)}};
    const OntoOptions own = options_on_circles(options, target.surface, target.chart);
    EXPECT_EQ(own.tolerance, 1e-3);
    ASSERT_EQ(own.marks.size(), 3u);
    const TargetDomain domain = circle_target(target.chart);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(own.marks[i].vertex, options.mark_vertices[i][0]);
        const Complex place = domain.curve(own.marks[i].curve).point(own.marks[i].parameter);
        EXPECT_NEAR(std::abs(place - target.chart.chart.vertices[options.mark_vertices[i][1]]), 0, 1e-12);
    }
}

TEST(OptionsOnCircles, LoopsBecomeCurves) {
    const Target target;
    OntoOptions options;
    options.loops = {{0, 0}, {1, 2}, {2, 1}};
    const OntoOptions own = options_on_circles(options, target.surface, target.chart);
    const TargetDomain domain = circle_target(target.chart);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(own.loops[i][0], options.loops[i][0]);
        const RoundHole circle = target.chart.circle(options.loops[i][1]);
        EXPECT_EQ(domain.curve(own.loops[i][1]).centre(), circle.centre);
        EXPECT_EQ(domain.curve(own.loops[i][1]).radius(), circle.radius);
    }
    // The curves are numbered by the circle domain: with another loop outside, 0 is that one.
    const CircleDomainChart turned = circle_domain_chart(target.surface, 1);
    EXPECT_EQ(options_on_circles(options, target.surface, turned).loops[2][1], 0);
}

TEST(OptionsOnCircles, RefusesWhatTheTargetHasNot) {
    const Target target;
    const auto cause = [&](const OntoOptions& options) {
        try {
            options_on_circles(options, target.surface, target.chart);
        } catch (const Error& error) {
            return error.cause();
        }
        return Cause::cancelled;
    };
    int inside = 0;
    while (target.surface.topology.on_boundary[inside]) ++inside;
    OntoOptions loops, marks, inner, none;
    loops.loops = {{0, 3}};
    marks.marks = {{0, 0, 0.0}};
    inner.mark_vertices = {{0, inside}};
    none.mark_vertices = {{0, -5}};
    EXPECT_EQ(cause(loops), Cause::bad_option);
    EXPECT_EQ(cause(marks), Cause::bad_option);
    EXPECT_EQ(cause(inner), Cause::bad_boundary);
    EXPECT_EQ(cause(none), Cause::bad_boundary);
}

}  // namespace
}  // namespace beltrami
