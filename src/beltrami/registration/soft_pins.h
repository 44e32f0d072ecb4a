#pragma once

#include <vector>

#include <beltrami/teichmuller/balance.h>
#include <beltrami/teichmuller/extremal_solver.h>

namespace beltrami {

/// Pins inside a plane domain that need not be met: places x at which ½ log K(x) + Σ w_i |x_i − t_i|² is least, by the
/// derivative of Teichmüller's metric (soft_landmarks.h) along fields that vanish, nearly, at the boundary and at the
/// other pins.
class SoftPins final : private Balanced {
  public:
    /// @param source      kept by reference
    /// @param constraints with all pins in its prescribed part, at their wanted places
    /// @param weights     beside these, infinite for those that are met
    SoftPins(const Surface& source, Constraints constraints, std::vector<double> weights,
             const ExtremalOptions& options);

    /// Moves the pins until the sum settles.
    ExtremalMap settle();

  private:
    Eigen::VectorXd coordinates() const override;
    double value() const override;
    Eigen::VectorXd gradient() const override;
    bool move(const Eigen::VectorXd& step) override;
    void undo() override;
    double width() const;

    const Surface& source_;
    Constraints constraints_;
    std::vector<double> weights_;
    ExtremalSolver solver_;
    std::vector<Complex> wanted_, places_, places_before_;
    ExtremalMap map_, map_before_;
};

}  // namespace beltrami
