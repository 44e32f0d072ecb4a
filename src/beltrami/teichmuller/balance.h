#pragma once

#include <Eigen/Core>

namespace beltrami {

/// Something that costs, in Euclidean coordinates that may be bound to a surface, and can be moved.
class Balanced {
  public:
    virtual ~Balanced() = default;
    virtual Eigen::VectorXd coordinates() const = 0;
    virtual double value() const = 0;
    virtual Eigen::VectorXd gradient() const = 0;
    /// Along the surface as far as a step says; false if that is impossible, and nothing has changed.
    virtual bool move(const Eigen::VectorXd& step) = 0;
    /// Takes the last move back.
    virtual void undo() = 0;
};

/// Moves it to where it costs least nearby: BFGS with backtracking, until a move is expected or found to save less than
/// 1e-5.
/// @param hessian to begin with, positive definite
/// @param longest step of any three (@p group) successive coordinates
/// @return moves
int balance(Balanced& it, Eigen::MatrixXd hessian, double longest, int group);

}  // namespace beltrami
