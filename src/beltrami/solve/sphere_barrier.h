#pragma once

#include <memory>
#include <vector>

#include <beltrami/solve/coupled_system.h>

namespace beltrami {

/// The energy of a map of a surface to the unit sphere that stays finite only where no face is flipped,
///
///     F = Σ W d²/(1 − d²) / Σ W,    d = |T|,    T = (μ − σ)/(1 − conj(σ) μ),
///
/// μ the coefficient of the map and σ the one wanted: d is the hyperbolic distance to it, as tanh of half of it; for
/// σ = 0 F is half of MIPS less 1. Gauss-Newton steps on it move vertices along the sphere,
///
///     μ → μ + (1 − |μ|²) V_w̄ conj(p)/p,   p = ∂f,   V the motion as a function of the image,
///
/// two unknowns a vertex in units of the size of its smallest face, so that limbs of any size count alike. A step that
/// has to be cut short is damped as Levenberg and Marquardt do: a needle that is about to flip then holds up itself and
/// not the others.
class SphereBarrier {
  public:
    /// @param operators of the source; kept by reference
    /// @param freedoms  #V; fixed vertices stay
    /// @param sigma     #S wanted coefficients, |σ| < 1
    /// @param weights   #S W, positive
    SphereBarrier(const Operators& operators, std::vector<Freedom> freedoms, Eigen::VectorXcd sigma,
                  std::vector<double> weights);

    /// Another σ and other weights from now on.
    void aim(Eigen::VectorXcd sigma, std::vector<double> weights);

    /// F of a map (#V×3 unit vectors); infinite where a sample is flipped.
    double value(const Positions& points) const;

    struct Taken {
        double length = 0;    ///< part of the step that was taken; 0: none lowered F
        double fallen = 0;    ///< by which part F fell
        bool damped = false;  ///< the step was shortened in some directions
    };
    /// Takes one step.
    /// @pre value(points) is finite
    /// @throw Error not_solved
    Taken step(Positions& points);

    int factorization_count() const { return system_.factorization_count(); }

  private:
    struct Sample;
    Sample at(int sample, const Positions& points) const;
    void assemble(const Positions& points, const Eigen::VectorXd& units);

    const Operators& operators_;
    std::vector<Freedom> freedoms_;
    Eigen::VectorXcd sigma_;
    std::vector<double> weights_;
    double total_weight_ = 0;
    double damping_ = 0;
    CoupledSystem system_;
};

/// δμ/(1 − |μ|²) = V_w̄ conj(p)/p at the samples of a map to the sphere whose vertices move by V.
/// @param points #V×3 unit vectors, no sample flipped
/// @param motion #V×3, tangent to the sphere
Eigen::VectorXcd coefficient_change(const Operators& operators, const Positions& points, const Positions& motion);

}  // namespace beltrami
