#include <beltrami/sphere/moebius_drift.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <beltrami/base/random.h>

namespace beltrami {
namespace {

TEST(MoebiusDrift, IsAllThatIsTakenAway) {
    Random random(3);
    Positions points(40, 3), drift(40, 3), other(40, 3);
    Eigen::VectorXd weights(40);
    const Eigen::Vector3d shift(0.3, -0.2, 0.5), turn(-0.1, 0.4, 0.2);
    for (Eigen::Index v = 0; v < 40; ++v) {
        Eigen::Vector3d x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        x.normalize();
        const Eigen::Vector3d any(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        points.row(v) = x;
        drift.row(v) = shift - shift.dot(x) * x + turn.cross(x);
        other.row(v) = any - any.dot(x) * x;
        weights[v] = random.uniform(0.1, 1);
    }
    EXPECT_LT(without_moebius_drift(points, drift, weights).cwiseAbs().maxCoeff(), 1e-12);
    const Positions rest = without_moebius_drift(points, other, weights);
    EXPECT_GT(rest.norm(), 0.5 * other.norm());
    EXPECT_LT((without_moebius_drift(points, rest + drift, weights) - rest).cwiseAbs().maxCoeff(), 1e-12);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero(), moment = centre;
    for (Eigen::Index v = 0; v < 40; ++v) {
        const Eigen::Vector3d x = points.row(v), motion = rest.row(v);
        centre += weights[v] * motion;
        moment += weights[v] * x.cross(motion);
    }
    EXPECT_LT(centre.norm(), 1e-12);
    EXPECT_LT(moment.norm(), 1e-12);
}

}  // namespace
}  // namespace beltrami
