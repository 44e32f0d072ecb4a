#include <beltrami/sphere/centring.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include <beltrami/sphere/moebius_shift.h>

namespace beltrami {

namespace {

constexpr double kCentred = 1e-13;
constexpr int kMostSteps = 60, kMostHalvings = 30;
constexpr double kArmijo = 1e-4, kRounding = 1e-7;
constexpr double kLongestShift = 0.7;  // of the ball's radius: a point of it that goes to the centre

/// The value below which half of the weight lies.
double weighted_median(const Eigen::VectorXd& values, const Eigen::VectorXd& weights) {
    std::vector<int> order;
    for (Eigen::Index v = 0; v < values.size(); ++v)
        if (weights[v] > 0) order.push_back(static_cast<int>(v));
    if (order.empty()) return 0;
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return values[a] != values[b] ? values[a] < values[b] : a < b; });
    const double half = 0.5 * weights.sum();
    double below = 0;
    for (const int v : order) {
        below += weights[v];
        if (below >= half) return values[v];
    }
    return values[order.back()];
}

/// Σ w log(|Q + c|²/(1 − |c|²)): convex in hyperbolic space, its gradient at c = 0 is twice the centre of mass.
double busemann_sum(const Positions& points, const Eigen::VectorXd& weights, const Eigen::RowVector3d& c) {
    const double factor = 1 - c.squaredNorm();
    double sum = 0;
    for (Eigen::Index v = 0; v < points.rows(); ++v)
        if (weights[v] > 0) sum += weights[v] * std::log1p((2 * points.row(v).dot(c) + 2 * c.squaredNorm()) / factor);
    return sum;
}

}  // namespace

CentredSphere centred(Positions points, const Eigen::VectorXd& weights) {
    const Eigen::VectorXd w = weights / weights.sum();
    const auto centre = [&](const Positions& p) { return Eigen::RowVector3d(w.transpose() * p); };
    Eigen::RowVector3d mean = centre(points);
    int step = 0;
    for (; step < kMostSteps && mean.norm() > kCentred; ++step) {
        // Q moves by 2(c − (c·Q)Q) + O(|c|²), the centre of mass by 2(I − Σ w QQᵀ)c.
        const Eigen::Matrix3d moment = points.transpose() * w.asDiagonal() * points;
        Eigen::Matrix3d hessian = Eigen::Matrix3d::Identity() - moment;
        hessian.diagonal().array() += 1e-12;
        Eigen::RowVector3d c = -0.5 * hessian.ldlt().solve(mean.transpose()).transpose();
        if (c.norm() > kLongestShift) c *= kLongestShift / c.norm();
        const double slope = 2 * mean.dot(c);
        bool accepted = false;
        double length = 1;
        for (int halving = 0; halving < kMostHalvings && !accepted; ++halving, length *= 0.5) {
            // Near the end rounding hides the fall of the sum, while the centre of mass still shows progress.
            const bool near = mean.norm() < kRounding;
            if (!near && !(busemann_sum(points, w, length * c) <= kArmijo * length * slope)) continue;
            Positions trial = moebius_shifted(points, length * c);
            const Eigen::RowVector3d trial_mean = centre(trial);
            accepted = !near || trial_mean.norm() < mean.norm();
            if (!accepted) continue;
            points = std::move(trial);
            mean = trial_mean;
        }
        if (!accepted) break;
    }
    return {std::move(points), mean.norm(), step};
}

Eigen::VectorXcd around_median(Eigen::VectorXcd z, const Eigen::VectorXd& weights) {
    const Complex middle(weighted_median(z.real(), weights), weighted_median(z.imag(), weights));
    z.array() -= middle;
    const double radius = weighted_median(z.cwiseAbs(), weights);
    if (radius > 0) z /= radius;
    return z;
}

}  // namespace beltrami
