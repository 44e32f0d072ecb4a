#include <beltrami/sphere/moebius_drift.h>

#include <Eigen/Cholesky>

namespace beltrami {

namespace {

/// The motions e − ⟨e, x⟩x, which shift the sphere towards e, and e × x, which turn it, as columns.
Eigen::Matrix<double, 3, 6> moebius_motions(const Eigen::Vector3d& x) {
    Eigen::Matrix<double, 3, 6> motions;
    motions.leftCols<3>() = Eigen::Matrix3d::Identity() - x * x.transpose();
    motions.rightCols<3>() << 0, x.z(), -x.y(), -x.z(), 0, x.x(), x.y(), -x.x(), 0;
    return motions;
}

}  // namespace

Positions without_moebius_drift(const Positions& points, const Positions& motion, const Eigen::VectorXd& weights) {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        const auto motions = moebius_motions(points.row(v).transpose());
        normal += weights[v] * motions.transpose() * motions;
        right += weights[v] * motions.transpose() * motion.row(v).transpose();
    }
    const Eigen::Matrix<double, 6, 1> drift = normal.ldlt().solve(right);
    Positions result = motion;
    for (Eigen::Index v = 0; v < points.rows(); ++v)
        result.row(v) -= (moebius_motions(points.row(v).transpose()) * drift).transpose();
    return result;
}

}  // namespace beltrami
