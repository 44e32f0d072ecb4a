#include <beltrami/sphere/moebius_fit.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <beltrami/sphere/moebius_shift.h>

namespace beltrami {

namespace {

constexpr int kMostFitSteps = 200;
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-12, kMostDamping = 1e12, kFactor = 4;
constexpr double kReached = 1e-30, kSettled = 1e-13;
constexpr double kLongest = 0.5;  // shift in a step, of the ball's radius; also radians

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Positions rows_of(const Positions& points, std::span<const int> indices) {
    Positions rows(static_cast<Eigen::Index>(indices.size()), 3);
    for (std::size_t i = 0; i < indices.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = points.row(indices[i]);
    return rows;
}

/// A shift and then a rotation, as a step of the group.
Positions stepped(const Positions& points, const Vector6& x) {
    const Eigen::Vector3d turn = x.tail<3>();
    const double angle = turn.norm();
    const Eigen::Matrix3d rotation =
        angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
    return moebius_shifted(points, x.head<3>().transpose()) * rotation.transpose();
}

/// Normal equations of the residuals at the identity: a point Q moves by 2(c − (c·Q)Q) + ω × Q.
void normal_equations(const Positions& at, const Positions& wanted, Matrix6& matrix, Vector6& right) {
    matrix.setZero();
    right.setZero();
    for (Eigen::Index i = 0; i < at.rows(); ++i) {
        const Eigen::Vector3d q = at.row(i);
        Eigen::Matrix<double, 3, 6> motion;
        motion.leftCols<3>() = 2 * (Eigen::Matrix3d::Identity() - q * q.transpose());
        motion.rightCols<3>() << 0, q.z(), -q.y(), -q.z(), 0, q.x(), q.y(), -q.x(), 0;
        matrix += motion.transpose() * motion;
        right += motion.transpose() * (wanted.row(i) - at.row(i)).transpose();
    }
}

}  // namespace

Eigen::Matrix3d best_rotation(const Positions& a, const Positions& b) {
    const Eigen::Matrix3d moment = b.transpose() * a;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

Positions moebius_fitted(Positions points, std::span<const int> landmarks, const Positions& wanted) {
    if (landmarks.empty()) return points;
    points *= best_rotation(rows_of(points, landmarks), wanted).transpose();
    Positions at = rows_of(points, landmarks);
    double sum = (at - wanted).squaredNorm(), damping = kFirstDamping;
    for (int step = 0; step < kMostFitSteps && sum > kReached && damping < kMostDamping; ++step) {
        Matrix6 matrix;
        Vector6 right;
        normal_equations(at, wanted, matrix, right);
        const double size = matrix.diagonal().maxCoeff();
        matrix.diagonal().array() += damping * size;
        Vector6 x = matrix.ldlt().solve(right);
        if (x.norm() > kLongest) x *= kLongest / x.norm();
        const Positions trial = stepped(at, x);
        const double there = (trial - wanted).squaredNorm();
        if (!(there < sum)) {
            damping *= kFactor;
            continue;
        }
        const bool settled = there > (1 - kSettled) * sum;
        points = stepped(points, x);
        at = trial;
        sum = there;
        damping = std::max(damping / kFactor, kLeastDamping);
        if (settled) break;
    }
    return points;
}

}  // namespace beltrami
