#include <beltrami/registration/register_curves.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/registration/curve_start.h>

#include "support/cause_of.h"
#include "support/registration.h"

namespace beltrami {
namespace {

using test::bumpy_ball;
using test::raised_sheet;

/// Through the vertices of a mesh of the sphere that are nearest to some directions, turned around the z-axis.
CurveThrough curve_through(const Mesh& mesh, const std::vector<Eigen::Vector3d>& directions, double turn, bool closed) {
    CurveThrough curve{{}, closed};
    for (const Eigen::Vector3d& direction : directions) {
        const Eigen::Vector3d to = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * direction.normalized();
        int best = 0;
        for (int v = 1; v < mesh.vertex_count(); ++v)
            if (mesh.point(v).normalized().dot(to) > mesh.point(best).normalized().dot(to)) best = v;
        curve.points.push_back(place_of_vertex(mesh, best));
    }
    return curve;
}

const std::vector<Eigen::Vector3d> kArc{{1, 0, .1}, {.5, .8, .3}, {-.4, .9, .2}},
    kRing{{1, 0, -.5}, {0, 1, -.5}, {-1, 0, -.5}, {0, -1, -.5}};

TEST(RegisterLeastLp, CurvesSlideOrStay) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(3, 1));
    double energies[2];
    for (const bool slides : {true, false}) {
        const std::array pairs{
            CurvePair{curve_through(source.mesh, kArc, 0, false), curve_through(target.mesh, kArc, 0.2, false), slides},
            CurvePair{curve_through(source.mesh, kRing, 0, true), curve_through(target.mesh, kRing, -0.1, true),
                      slides}};
        const LpRegistration found = register_least_lp(source, target, {}, pairs);
        EXPECT_TRUE(found.map.distortion.flipped.empty());
        EXPECT_LT(found.curve_distance, 2e-3);  // edges of 0.15
        energies[slides ? 0 : 1] = found.map.history.back().energy;
        // Ends of the arc go to ends, and every given point of a curve that stays to its partner.
        for (std::size_t i = 0; i < kArc.size(); ++i) {
            if (slides && i == 1) continue;
            const int from = pairs[0].source.points[i].vertices[0], to = pairs[0].target.points[i].vertices[0];
            EXPECT_LT((found.positions.row(from).transpose() - target.mesh.point(to)).norm(), 1e-9);
        }
    }
    EXPECT_LT(energies[0], energies[1]);
}

TEST(RegisterLeastLp, WithoutCurvesMeetsLandmarks) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(3, 1));
    std::vector<SurfaceLandmark> landmarks;
    for (const int v : {0, 1, 2, 3, 7}) landmarks.push_back({v, place_of_vertex(target.mesh, v)});
    double last = 0;
    for (const double p : {2.0, 6.0}) {
        CurveRegistrationOptions options;
        options.p = p;
        const LpRegistration found = register_least_lp(source, target, landmarks, {}, options);
        EXPECT_TRUE(found.carried.one_to_one());
        for (const int v : {0, 1, 2, 3, 7})
            EXPECT_LT((found.positions.row(v).transpose() - target.mesh.point(v)).norm(), 1e-12);
        if (last > 0) {
            EXPECT_LT(found.carried.distortion.max, last);
        }
        last = found.carried.distortion.max;
    }
}

TEST(MapCutAlongCurves, PartsOfASphereWithOneCurveAreNotFolded) {
    const Mesh here = bumpy_ball(3, 0), there = bumpy_ball(4, 1);
    for (const bool closed : {false, true}) {
        const auto& points = closed ? kRing : kArc;
        const MeshWithCurves source = mesh_with_curves(here, std::array{curve_through(here, points, 0, closed)}),
                             target = mesh_with_curves(there, std::array{curve_through(there, points, 1.5, closed)});
        const std::vector<MeshPoint> places = map_cut_along_curves(source, target);
        EXPECT_EQ(static_cast<int>(places.size()), source.mesh.vertex_count());
        const auto& chain = source.curves[0];
        for (std::size_t i = 0; i < chain.given.size(); ++i) {
            const MeshPoint& place = places[chain.vertices[chain.given[i]]];
            Eigen::Vector3d point = Eigen::Vector3d::Zero();
            for (int j = 0; j < 3; ++j) point += place.barycentric[j] * target.mesh.point(place.vertices[j]);
            const int partner = target.curves[0].vertices[target.curves[0].given[i]];
            EXPECT_LT((point - target.mesh.point(partner)).norm(), 1e-9);
        }
    }
}

TEST(RegisterLeastLp, SeveralOpenCurvesWhicheverWayTheyRun) {
    // Two and three arcs, given in either direction: how the start turns around them is found, not given.
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(3, 1));
    const std::vector<std::vector<Eigen::Vector3d>> arcs{
        {{1, .1, .4}, {.6, .8, .5}}, {{-.8, .5, .1}, {-.7, -.6, .3}}, {{.3, -.9, -.3}, {.9, -.2, -.5}}};
    for (const std::size_t count : {2U, 3U}) {
        double least = 0, most = 0;
        for (const unsigned reversed : {0U, 1U, 2U}) {
            std::vector<CurvePair> pairs;
            for (std::size_t c = 0; c < count; ++c) {
                std::vector<Eigen::Vector3d> through = arcs[c];
                if ((reversed >> c & 1U) != 0) std::reverse(through.begin(), through.end());
                pairs.push_back({curve_through(source.mesh, through, 0, false),
                                 curve_through(target.mesh, through, 0.3, false), true});
            }
            const LpRegistration found = register_least_lp(source, target, {}, pairs);
            EXPECT_TRUE(found.map.distortion.flipped.empty());
            EXPECT_LT(found.curve_distance, 2e-3);
            const double mean = found.map.distortion.mean;
            least = reversed == 0 ? mean : std::min(least, mean);
            most = std::max(most, mean);
        }
        EXPECT_LT(most, 1.1 * least) << count;  // the same class
        EXPECT_LT(most, 0.3);
    }
}

TEST(RegisterLeastLp, ASharpBendGoesToAStraightCurve) {
    const Surface source(bumpy_ball(4, 0)), target(bumpy_ball(4, 1));
    const CurveThrough bent = curve_through(source.mesh, {{1, -.5, .1}, {.95, .4, .1}, {.9, -.2, .35}}, 0, false),
                       straight = curve_through(target.mesh, {{1, -.6, .1}, {1, 0, .1}, {1, .6, .1}}, 0, false);
    const MeshWithCurves divided = mesh_with_curves(source.mesh, std::array{bent});
    EXPECT_GT(divided.places.size(), divided.curves[0].vertices.size() - bent.points.size());  // bridges are divided
    const LpRegistration found = register_least_lp(source, target, {}, std::array{CurvePair{bent, straight, true}});
    EXPECT_TRUE(found.map.distortion.flipped.empty());
    EXPECT_LT(found.curve_distance, 2e-3);
}

TEST(RegisterLeastLp, SurfacesWithBoundaryAndTheirCurves) {
    // A sheet, with a curve inside and a landmark.
    const auto at = [](const Mesh& mesh, int i, int j) { return place_of_vertex(mesh, 17 * j + i); };
    const Surface source(raised_sheet(16, 0)), target(raised_sheet(16, 0.15));
    const CurvePair pair{{{at(source.mesh, 4, 8), at(source.mesh, 8, 9), at(source.mesh, 12, 8)}, false},
                         {{at(target.mesh, 4, 8), at(target.mesh, 8, 9), at(target.mesh, 12, 8)}, false},
                         true};
    const std::vector<SurfaceLandmark> landmarks{{17 * 3 + 8, at(target.mesh, 8, 3)}};
    const LpRegistration found = register_least_lp(source, target, landmarks, std::array{pair});
    EXPECT_TRUE(found.map.distortion.flipped.empty());
    EXPECT_LT(found.curve_distance, 1e-3);
    for (const int v : {17 * 8 + 4, 17 * 8 + 12, 17 * 3 + 8})
        EXPECT_LT((found.positions.row(v).transpose() - target.mesh.point(v)).norm(), 1e-9);
    for (const int v : source.topology.boundary_loops[0]) {
        const Eigen::RowVector3d p = found.positions.row(v);
        EXPECT_LT(std::min({p.x(), 2 - p.x(), p.y(), 2 - p.y()}), 1e-9);
    }
    // A tube, with a curve around it.
    const Surface tube(cylinder(1, 3, 18, 12)), other(cylinder(1.2, 3, 18, 12));
    const auto ring = [](const Surface& surface, int level) {
        CurveThrough curve{{}, true};
        for (const int i : {0, 6, 12}) curve.points.push_back(place_of_vertex(surface.mesh, 13 * i + level));
        return curve;
    };
    const LpRegistration around =
        register_least_lp(tube, other, {}, std::array{CurvePair{ring(tube, 5), ring(other, 7), true}});
    EXPECT_TRUE(around.map.distortion.flipped.empty());
    EXPECT_LT(around.curve_distance, 2e-2);
}

TEST(RegisterLeastLp, RefusesWhatCannotBe) {
    const Surface source(bumpy_ball(2, 0)), target(bumpy_ball(2, 1));
    const CurveThrough arc = curve_through(source.mesh, kArc, 0, false),
                       ring = curve_through(target.mesh, kRing, 0, true);
    const auto cause = [&](const std::vector<SurfaceLandmark>& landmarks, const std::vector<CurvePair>& curves) {
        return test::cause_of([&] { register_least_lp(source, target, landmarks, curves); });
    };
    EXPECT_EQ(cause({}, {{arc, ring, true}}), Cause::bad_boundary);
    EXPECT_EQ(
        cause({{arc.points[0].vertices[0], arc.points[0]}}, {{arc, curve_through(target.mesh, kArc, 0, false), true}}),
        Cause::bad_boundary);
    EXPECT_EQ(cause({{0, place_of_vertex(target.mesh, 0), 3.0}}, {}), Cause::bad_option);
    CurveThrough backwards = ring;
    std::reverse(backwards.points.begin(), backwards.points.end());
    const CurveThrough second = curve_through(source.mesh, kArc, 0, false),
                       moved = curve_through(target.mesh, {{1, 0, -.9}, {0, 1, -.9}, {-1, 0, -.9}}, 0, false);
    // The arc is on one side of the ring here, and on the other side there.
    EXPECT_EQ(cause({}, {{curve_through(source.mesh, kRing, 0, true), ring, true}, {second, moved, true}}),
              Cause::bad_boundary);
}

}  // namespace
}  // namespace beltrami
