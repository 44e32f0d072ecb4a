#include <beltrami/starts/landmark_flow.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/generate/sphere.h>
#include <beltrami/operators/surface.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/sphere_faces.h>

namespace beltrami {
namespace {

Positions some_landmarks() {
    Positions points(4, 3);
    points << 1, 0, 0, 0, 1, 0, -1, -1, 0, 0, .2, 1;
    points.rowwise().normalize();
    return points;
}

TEST(LandmarkField, TakesTheGivenValues) {
    const Positions landmarks = some_landmarks();
    Positions velocities(4, 3);
    for (int i = 0; i < 4; ++i)
        velocities.row(i) = TangentFrame(landmarks.row(i).transpose()).first.transpose() * (i + 1);
    const LandmarkField field(landmarks, velocities, 0.5);
    EXPECT_LT((field.at(landmarks) - velocities).norm(), 1e-12);
    const Mesh mesh = icosahedral_sphere(2);
    const Positions values = field.at(mesh.positions);
    for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_NEAR(values.row(v).dot(mesh.positions.row(v)), 0, 1e-14);
}

TEST(LandmarkFlow, TakesLandmarksToTheirImagesWithoutFolds) {
    const Mesh mesh = icosahedral_sphere(4);
    const Positions from = mesh.positions({0, 3, 5, 8, 11}, Eigen::all);
    Positions to = from;
    to.col(0).array() += .3;
    to.row(2) << .2, .9, .4;
    to.rowwise().normalize();
    Positions all(mesh.vertex_count() + 5, 3);
    all << mesh.positions, from;
    double last = 0;
    for (const int steps : {10, 20}) {
        const Positions moved = landmark_flow(all, {from, to}, steps);
        const double error = (moved.bottomRows(5) - to).rowwise().norm().maxCoeff();
        EXPECT_TRUE(SphereFaces(Surface(mesh)).flipped(moved.topRows(mesh.vertex_count())).empty());
        // Midpoint rule: of second order.
        if (last > 0) {
            EXPECT_GT(last / error, 3.5);
        }
        last = error;
    }
    EXPECT_LT(last, 2e-3);
}

TEST(LandmarkFlow, PassesItsStops) {
    const Positions from = some_landmarks();
    Positions middle = from, to = from;
    middle.row(3) << .5, .5, .7;
    middle.rowwise().normalize();
    const Positions there = landmark_flow(from, {from, middle}, 20), back = landmark_flow(from, {from, middle, to}, 20);
    EXPECT_LT((there - middle).norm(), 1e-2);
    EXPECT_LT((back - to).norm(), 2e-2);
    EXPECT_LT((landmark_flow(from, {from, from}, 5) - from).norm(), 1e-14);
}

TEST(LandmarkFlow, TheWidthIsPartOfTheMedianDistance) {
    const Positions landmarks = some_landmarks();
    EXPECT_NEAR(landmark_width(landmarks, landmarks), 0.6, 1e-12);
    Positions near(3, 3);
    near << 1, 0, 0, 1, .1, 0, 1, 0, .1;
    near.rowwise().normalize();
    EXPECT_LT(landmark_width(near, near), 0.07);
}

}  // namespace
}  // namespace beltrami
