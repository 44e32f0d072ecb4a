#pragma once

#include <Eigen/Core>
#include <deque>

namespace beltrami {

/// Anderson acceleration of a fixed-point iteration x ← G(x) (Walker & Ni 2011, type II): the next iterate is the
/// combination of the last values of G whose residuals G(x) − x cancel best.
class AndersonAcceleration {
  public:
    explicit AndersonAcceleration(int window) : window_(window) {}

    /// @param x the current iterate
    /// @param g G(x)
    /// @return the next iterate
    Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

    /// Forgets the past, for instance when the unknowns change meaning.
    void reset();
    /// Another G of nearly the same derivative follows: what is known of that stays, the point is forgotten.
    void leave_point();

  private:
    int window_;
    std::deque<Eigen::VectorXd> g_differences_, residual_differences_;
    Eigen::VectorXd last_g_, last_residual_;
};

}  // namespace beltrami
