#pragma once

#include <beltrami/differentials/sampled_space.h>
#include <beltrami/teichmuller/dual_step.h>

namespace beltrami {

/// The c-step on a mesh: from μ of a map to φ and k. Pairings run over every sample, the norm over clusters and is
/// corrected to first order, k is summed over every sample again.
class CoefficientStep {
  public:
    struct Result {
        Eigen::VectorXcd direction;  ///< coefficients of φ, of length 1; 0 if nothing pairs with μ
        Eigen::VectorXcd phi;        ///< #S values of φ for these coefficients
        double k = 0;
        bool converged = false;  ///< of the convex problem
    };

    /// @param source, chart kept by reference
    /// @param phase see SampledSpace
    CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities, double phase,
                    int cluster_count);

    /// Points of the canonical domain that resolve what the c-step sees, with their areas.
    const SampleClusters& clusters() const { return clusters_; }

    /// Makes another space the current one; kept by reference until the next call.
    void set_space(const DifferentialSpace& space);

    /// φ of coefficients (#S).
    Eigen::VectorXcd values(const Eigen::VectorXcd& coefficients) const { return sampled_.combination(coefficients); }

    /// @param mu    #S coefficients of the map; those of flipped or nearly flipped samples are held at |μ| = 0.95
    /// @param start direction to start from, padded by zeros; empty at the very beginning
    /// @param phi   values(start), if they are known
    Result solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start, const Eigen::VectorXcd& phi = {});

  private:
    const Surface& source_;
    const Chart& chart_;
    SampledSpace sampled_;
    SampleClusters clusters_;
    DualProblem problem_;
    double fine_rounding_ = 0;  ///< as DualProblem::rounding, for single samples in the canonical domain
};

}  // namespace beltrami
