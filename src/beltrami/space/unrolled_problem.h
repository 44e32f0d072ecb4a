#pragma once

#include <optional>
#include <vector>

#include <beltrami/linear/element_system.h>
#include <beltrami/operators/map_derivatives.h>
#include <beltrami/solve/target_energy.h>
#include <beltrami/space/unrolled_map.h>

namespace beltrami {

/// Least-squares maps to the unrolled surface. With |dz + ν dz̄|² as the metric of the source their energy is
/// Dirichlet's of both coordinates, less the area of the image, which does not change: two systems with one matrix.
class UnrolledProblem {
  public:
    /// @param source, elements kept by reference
    /// @param fixed   #V, at least one
    UnrolledProblem(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                    const std::vector<char>& fixed);

    const Eigen::VectorXcd& map() const { return map_; }
    void set_map(Eigen::VectorXcd map) { map_ = std::move(map); }

    /// Makes the map that with a coefficient (#S, |ν| < 1).
    void solve(const Eigen::VectorXcd& nu);
    /// ∂f and ∂̄f at the samples, of the map as it stands.
    MapDerivatives derivatives() const { return beltrami::derivatives(of_corners_, corners()); }
    /// Where Σ A |∂̄f − ν ∂f|² is least on the way.
    double best_step(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) const;
    /// The Gauss-Newton step of an energy of the samples' derivatives: how the vertices would move (#V).
    /// @pre the energy is finite, but where all corners of a sample are fixed
    /// @throw Error not_solved
    Eigen::VectorXcd step(const TargetEnergy& energy);
    int factorization_count() const {
        return system_.factorization_count() + (steps_ ? steps_->factorization_count() : 0);
    }

  private:
    Eigen::VectorXcd corners() const;  // #corners where the faces lie

    const FaceList& faces_;
    const Operators& operators_;
    Operators of_corners_;  // the same, of values at the corners
    Eigen::VectorXcd turns_;
    std::vector<int> place_;  // #V among those that move
    Eigen::VectorXcd map_;
    ElementSystem system_;                // of one coordinate
    std::optional<ElementSystem> steps_;  // of both, from the first step on
};

}  // namespace beltrami
