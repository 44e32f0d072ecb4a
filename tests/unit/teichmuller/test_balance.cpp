#include <beltrami/teichmuller/balance.h>

#include <cmath>

#include <gtest/gtest.h>

namespace beltrami {
namespace {

/// Rosenbrock's valley, of which moves beyond |x| = 3 are impossible.
class Valley final : public Balanced {
  public:
    Eigen::VectorXd coordinates() const override { return x_; }
    double value() const override { return std::pow(1 - x_[0], 2) + 10 * std::pow(x_[1] - x_[0] * x_[0], 2); }
    Eigen::VectorXd gradient() const override {
        const double across = x_[1] - x_[0] * x_[0];
        return Eigen::Vector2d(-2 * (1 - x_[0]) - 40 * x_[0] * across, 20 * across);
    }
    bool move(const Eigen::VectorXd& step) override {
        if ((x_ + step).norm() > 3) return false;
        before_ = x_;
        x_ += step;
        longest = std::max(longest, step.norm());
        return true;
    }
    void undo() override { x_ = before_; }

    double longest = 0;

  private:
    Eigen::Vector2d x_{-0.5, 0.5}, before_;
};

TEST(Balance, ComesToTheMinimum) {
    Valley valley;
    const int moves = balance(valley, 10 * Eigen::MatrixXd::Identity(2, 2), 0.7, 2);
    EXPECT_LT(valley.value(), 1e-3);
    EXPECT_GT(moves, 3);
    EXPECT_LE(valley.longest, 0.7 + 1e-12);
}

}  // namespace
}  // namespace beltrami
