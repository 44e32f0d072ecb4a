#include <beltrami/teichmuller/balance.h>

#include <algorithm>

#include <Eigen/Cholesky>

namespace beltrami {

namespace {

constexpr int kMostMoves = 25, kMostHalvings = 6;
constexpr double kDescent = 1e-4, kSettledBalance = 1e-5, kFlat = 1e-12;

}  // namespace

int balance(Balanced& it, Eigen::MatrixXd hessian, double longest, int group) {
    double value = it.value();
    Eigen::VectorXd gradient = it.gradient();
    int moves = 0;
    while (moves < kMostMoves) {
        Eigen::VectorXd step = -hessian.ldlt().solve(gradient);
        double size = 0;
        for (Eigen::Index i = 0; i < step.size(); i += group) size = std::max(size, step.segment(i, group).norm());
        if (size > longest) step *= longest / size;
        const double slope = gradient.dot(step), before = value;
        if (!(-slope > kSettledBalance)) break;
        const Eigen::VectorXd from = it.coordinates();
        bool accepted = false;
        double length = 1;
        for (int halving = 0; halving < kMostHalvings && !accepted; ++halving, length *= 0.5) {
            if (!it.move(length * step)) continue;
            value = it.value();
            accepted = value <= before + kDescent * length * slope;
            if (!accepted) it.undo();
        }
        if (!accepted) break;
        ++moves;
        const Eigen::VectorXd next = it.gradient(), change = next - gradient, moved = it.coordinates() - from;
        const double curvature = moved.dot(change);
        if (curvature > kFlat * moved.norm() * change.norm()) {
            const Eigen::VectorXd image = hessian * moved;
            hessian += change * change.transpose() / curvature - image * image.transpose() / moved.dot(image);
        }
        gradient = next;
        if (before - value < kSettledBalance) break;
    }
    return moves;
}

}  // namespace beltrami
