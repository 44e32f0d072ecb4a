#pragma once

#include <beltrami/solve/map_step.h>
#include <beltrami/solve/sliding_boundary.h>

namespace beltrami {

/// The f-step of boundaries that slide: Newton's method for Σ A|∂̄f − ν∂f|²/(1−|ν|²) over all f whose boundary vertices
/// lie on their curves, one step at a time; as ν settles, so does f. Interior vertices are free, sliding ones have one
/// unknown along their tangent or line, prescribed ones none; the curves' curvature enters the diagonal, and vertices
/// move along the true curves.
class SlidingMapStep final : public PlaneMapStep {
  public:
    /// @param source, boundary kept by reference; boundary holds where the vertices are
    /// @param map #V to start from
    /// @param expected_factorizations see ElementSystem
    SlidingMapStep(const Surface& source, SlidingBoundary& boundary, Eigen::VectorXcd map, int expected_factorizations);

    void solve(const Eigen::VectorXcd& nu, double tolerance) override;

    /// The solver, for other systems of the same freedoms; the next solve() factorises again.
    BeltramiSolver& lend_solver() {
        movement_ = 1;
        return solver_;
    }
    /// Largest movement of a boundary vertex in the last step, as part of its curve's length.
    double movement() const { return movement_; }
    int factorization_count() const { return solver_.factorization_count(); }

  private:
    SlidingBoundary& boundary_;
    BeltramiSolver solver_;
    double movement_ = 1;
};

}  // namespace beltrami
