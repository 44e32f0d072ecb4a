#pragma once

#include <vector>

#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/linear/element_system.h>
#include <beltrami/solve/map_step.h>

namespace beltrami {

/// The f-step of maps onto a surface with a metric of curvature −1: the harmonic map from the surface with the
/// coefficient ν to the hyperbolic metric of the target, in the class of the map. It minimises E = ½ Σ w d², w the
/// cotangent weights of z + ν z̄ and d the hyperbolic distances along edges, which is convex in the displacements ξ of
/// the images, each in its own frame. Boundary vertices move along the boundary, which is a geodesic and the real axis
/// of their frames: a real ξ is that slide, and no more is needed. That is the symmetric map between the doubles.
class EquivariantMapStep final : public MapStep {
  public:
    /// @param source of triangles, kept by reference
    /// @param map    flat
    /// @throw Error bad_mesh for faces that are not triangles
    EquivariantMapStep(const Surface& source, EquivariantMap map);

    /// One step of Newton's method with half of the curvature term, where the map is near: a Hermitian system, exact
    /// for maps that are conformal from z + ν z̄, as the wanted one is. Two where ν is large.
    void solve(const Eigen::VectorXcd& nu, double tolerance) override;
    /// The harmonic map for ν = 0 from anywhere, by Newton's method with the full Hessian.
    /// @param tolerance of the largest displacement in a step
    /// @return steps taken
    /// @throw Error not_solved if it does not settle
    int relax(double tolerance = 1e-9);

    const EquivariantMap& map() const { return map_; }
    void set_map(EquivariantMap map) { map_ = std::move(map); }
    double energy() const { return energy_of(map_.steps); }
    int factorization_count() const { return system_.factorization_count(); }

    /// In the hyperbolic plane, the image of every face around 0.
    MapDerivatives derivatives() const override;
    std::any snapshot() const override { return map_; }
    void restore(const std::any& snapshot) override { map_ = std::any_cast<const EquivariantMap&>(snapshot); }

  private:
    enum class Hessian { full, hermitian };
    void set_weights(const Eigen::VectorXcd& nu);
    double energy_of(const std::vector<DiskIsometry>& steps) const;
    Eigen::VectorXcd gradient() const;
    Eigen::VectorXcd direction(Hessian kind, const Eigen::VectorXcd& gradient, const std::vector<double>& weights);
    std::vector<DiskIsometry> moved(const Eigen::VectorXcd& xi, double length) const;
    double step(Hessian kind);

    const Surface& source_;
    EquivariantMap map_;
    std::vector<double> weights_;  ///< #E
    ElementSystem system_;         ///< two unknowns a vertex, an element an edge
};

}  // namespace beltrami
