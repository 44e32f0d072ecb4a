#include <beltrami/sphere/moebius_fit.h>

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <beltrami/base/random.h>
#include <beltrami/sphere/moebius_shift.h>

namespace beltrami {
namespace {

Positions points_on_sphere(int count, std::uint64_t seed) {
    Random random(seed);
    Positions points(count, 3);
    for (double& x : points.reshaped()) x = random.uniform(-1, 1);
    points.rowwise().normalize();
    return points;
}

std::vector<int> first(int count) {
    std::vector<int> indices(static_cast<std::size_t>(count));
    std::iota(indices.begin(), indices.end(), 0);
    return indices;
}

TEST(MoebiusFit, ThreePointsReachTheirPlaces) {
    const Positions points = points_on_sphere(20, 3);
    for (int count = 0; count <= 3; ++count) {
        const Positions wanted = points_on_sphere(count, 4);
        const Positions fitted = moebius_fitted(points, first(count), wanted);
        EXPECT_LT((fitted.topRows(count) - wanted).norm(), 1e-12) << count;
        EXPECT_LT((fitted.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
    }
}

TEST(MoebiusFit, FindsTheMoebiusMapOfWhichImagesCome) {
    const Positions points = points_on_sphere(30, 5);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Positions images = moebius_shifted(points, {.4, -.3, .2}) * turn.transpose();
    const Positions fitted = moebius_fitted(points, first(6), images.topRows(6));
    EXPECT_LT((fitted - images).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(MoebiusFit, IsStationaryForPointsThatDoNotFit) {
    const Positions points = points_on_sphere(6, 7), wanted = points_on_sphere(6, 8);
    const Positions fitted = moebius_fitted(points, first(6), wanted);
    const double best = (fitted - wanted).squaredNorm();
    for (const double step : {1e-3, -1e-3})
        for (int d = 0; d < 3; ++d) {
            Eigen::RowVector3d shift = Eigen::RowVector3d::Zero();
            shift[d] = step;
            EXPECT_GE((moebius_shifted(fitted, shift) - wanted).squaredNorm(), best - 1e-9);
            const Eigen::Matrix3d turn = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(d)).toRotationMatrix();
            EXPECT_GE((fitted * turn.transpose() - wanted).squaredNorm(), best - 1e-9);
        }
}

TEST(MoebiusFit, TheBestRotationIsFound) {
    const Positions points = points_on_sphere(9, 11);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
    EXPECT_LT((best_rotation(points, points * turn.transpose()) - turn).norm(), 1e-14);
    const Positions mirrored = points * Eigen::Vector3d(-1, 1, 1).asDiagonal();
    EXPECT_NEAR(best_rotation(points, mirrored).determinant(), 1, 1e-14);
}

}  // namespace
}  // namespace beltrami
