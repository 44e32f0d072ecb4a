#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/constants.h>
#include <beltrami/solve/image_frame.h>

namespace beltrami {

/// What a step makes small: a sum over samples, near the present map
///
///     Σ along (Re v)² + across (Im v)² + 2 Re(conj(gradient) v),    v = α δ(∂̄f) + β δ(∂f).
struct SampleTerm {
    Complex of_dzbar, of_dz;  ///< α, β
    Complex gradient;
    double along = 0, across = 0;
};

/// An energy of maps to a target with a wanted coefficient σ, sample by sample.
class TargetEnergy {
  public:
    virtual ~TargetEnergy() = default;
    /// A sample's part of the energy; infinite where a map may not go.
    virtual double value(const ImageFrame& frame, int sample) const = 0;
    virtual SampleTerm term(const ImageFrame& frame, int sample) const = 0;
    /// Told before each step where the map stands.
    virtual void prepare(const Operators& /*operators*/, const Positions& /*points*/, const Positions& /*normals*/) {}
    /// Whether a step has to lower it; else it has only to flip no more samples.
    virtual bool descends() const { return true; }
    /// The largest |v| of a sample up to which the sum above is like the energy; infinite where it is not told by |v|.
    virtual double reach() const { return kInfinity; }
};

/// Σ W |∂̄f − σ∂f|², the full Gauss-Newton step: nothing is singular where a sample collapses or is flipped.
class ResidualEnergy final : public TargetEnergy {
  public:
    ResidualEnergy(Eigen::VectorXcd sigma, std::vector<double> weights)
        : sigma_(std::move(sigma)), weights_(std::move(weights)) {}
    double value(const ImageFrame& frame, int sample) const override;
    SampleTerm term(const ImageFrame& frame, int sample) const override;

  private:
    Eigen::VectorXcd sigma_;
    std::vector<double> weights_;
};

/// The step of Wong & Zhao 2014 with ν to first order: Σ A |V_w̄ − ρ|² over the image, ρ = (σ − μ)/(1 − |μ|²) ∂f/conj
/// ∂f, for which μ → μ + t (σ − μ) + O(t²). No energy is made small: the limit is where the step vanishes. Source: eq.
/// (3.5) with conj(μ) and θ inverted, (4.6); "f∘g" there is g∘f.
class PerturbationEnergy final : public TargetEnergy {
  public:
    PerturbationEnergy(Eigen::VectorXcd sigma, std::vector<double> areas)
        : sigma_(std::move(sigma)), areas_(std::move(areas)) {}
    double value(const ImageFrame& frame, int sample) const override;
    SampleTerm term(const ImageFrame& frame, int sample) const override;
    bool descends() const override { return false; }

  private:
    Eigen::VectorXcd sigma_;
    std::vector<double> areas_;
};

/// Σ W ψ^{p/2}, ψ = d²/(1 − d²), d = |μ − σ|/|1 − conj(σ) μ|: finite only where no sample is flipped; for σ = 0 and
/// p = 2 half of MIPS less 1. With p > 2 ψ is in units of what 90 % of the samples stay below, and a little of p = 2 is
/// added, which holds up samples that are hardly distorted.
class BarrierEnergy final : public TargetEnergy {
  public:
    /// @param power p, at least 2
    BarrierEnergy(Eigen::VectorXcd sigma, std::vector<double> weights, double power = 2);
    double value(const ImageFrame& frame, int sample) const override;
    SampleTerm term(const ImageFrame& frame, int sample) const override;
    void prepare(const Operators& operators, const Positions& points, const Positions& normals) override;
    /// |v| is hyperbolic: 1 turns a sample of no distortion into one of |μ| = tanh 1.
    double reach() const override { return 1; }

    /// What ψ is measured in: 1 for p = 2.
    double unit() const { return unit_; }

  private:
    struct Distance;
    Distance distance(const ImageFrame& frame, int sample) const;

    Eigen::VectorXcd sigma_;
    std::vector<double> weights_;
    double power_, unit_ = 1;
};

}  // namespace beltrami
