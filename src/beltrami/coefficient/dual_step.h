#pragma once

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// The c-step: the quadratic differential φ_c = Σ c_j φ_j that sees most of a Beltrami coefficient μ,
///
///     S/2 = max_c  Re Σ A b φ_c / Σ A a |φ_c|,    a = (1+|μ|²)/(1−|μ|²),   b = μ/(1−|μ|²).
///
/// If μ = k conj(φ)/|φ| with φ in the space, the maximum is there and S = 2k/(1+k²). As a convex problem: minimise
/// N(c) = Σ A a |φ_c| on the hyperplane Re Σ A b φ_c = 1, by Newton with backtracking. The Hessian is summed over
/// quadrature points; N and its gradient too, or over more points (DualNorm).
struct DualProblem {
    Eigen::MatrixXcd basis;     ///< #Q×m values of the basis at quadrature points
    Eigen::VectorXd weights;    ///< #Q weights of |φ|
    Eigen::VectorXcd pairing;   ///< m values p_j = Σ A b φ_j
    bool complex_coefficients;  ///< c complex, or real
    /// |φ| is taken as √(|φ|² + δ²), δ = rounding · mean |φ| at the start: smooth where a zero of φ meets a quadrature
    /// point, at which |φ| itself has a kink that stops Newton.
    double rounding = 0;
};

struct DualSolution {
    Eigen::VectorXcd coefficients;  ///< on the hyperplane; zero if the pairing vanishes
    double pairing = 0;             ///< Re Σ p_j c_j: 1, or 0 if the pairing vanishes
    double norm = 0;                ///< N(c)
    Eigen::VectorXcd phi;           ///< φ_c at the points of the norm
    /// |φ_c − φ at the start| at the points of the problem, per mean |φ_c| there: how far φ has moved.
    Eigen::VectorXd moved;
    bool bent = false;  ///< the Hessian of the problem's points failed, and that of the norm was taken
    int newton_steps = 0;
    bool converged =
        false;  ///< false: the steps allowed did not suffice, or no step descends although the slope is not 0
};

/// N on points of its own.
class DualNorm {
  public:
    virtual ~DualNorm() = default;
    /// φ_c at the points.
    virtual Eigen::VectorXcd values(const Eigen::VectorXcd& coefficients) const = 0;
    /// Σ w √(|φ|² + δ²).
    virtual double norm(const Eigen::VectorXcd& phi, double delta) const = 0;
    /// m values Σ w conj(φ)/√(|φ|²+δ²) φ_j.
    virtual Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const = 0;
    /// The Hessian, in the lower triangle, in the real view of the coefficients (Re c, Im c), or Re c where they are
    /// real; without rows where it is not to be had. It is asked for where that of the problem's points fails.
    /// @param reach how far φ is expected to move at the points of the problem
    virtual Eigen::MatrixXd hessian(const Eigen::VectorXcd& /*phi*/, double /*delta*/,
                                    const Eigen::VectorXd& /*reach*/) const {
        return {};
    }
};

struct DualOptions {
    int max_steps = 50;  ///< of Newton's method
    double step = 0;     ///< stop where another step is expected to be shorter than this part of c
    /// How far φ is expected to move at the points of the problem, per mean |φ|, as DualSolution::moved; may be empty.
    Eigen::VectorXd reach{};
    /// Where N is minimised; null: on the points of the problem. The steps are Newton's as far as the problem's points
    /// give the Hessian.
    const DualNorm* norm = nullptr;
    bool bent = false;  ///< begin with the norm's own Hessian, if it is to be had
};

/// @param start coefficients to start from (may be shorter than m: padded by zeros; may be empty); ignored when its
///              pairing is not positive
DualSolution solve_dual(const DualProblem& problem, const Eigen::VectorXcd& start, const DualOptions& options = {});

/// m values Σ w conj(φ)/√(|φ|²+δ²) φ_j: the gradient of Σ w √(|φ_c|²+δ²) as a complex covector. The root is floored at
/// 1e-12 of its maximum.
Eigen::VectorXcd dual_gradient(const Eigen::MatrixXcd& basis, const Eigen::VectorXd& weights,
                               const Eigen::VectorXcd& phi, double delta = 0);

/// The Hessian of Σ w √(|φ_c|²+δ²) in the lower triangle, in the real view of the coefficients.
/// @param delta #Q
/// @param reach #Q by how much φ is expected to move
Eigen::MatrixXd dual_hessian(const Eigen::Ref<const Eigen::MatrixXcd>& basis, bool complex_coefficients,
                             const Eigen::VectorXd& weights, const Eigen::VectorXcd& phi, const Eigen::VectorXd& delta,
                             const Eigen::VectorXd& reach);

/// k of S = 2k/(1+k²), without cancellation.
double dilatation_of_pairing(double S);

/// A coarser quadrature of ∫ a|φ|: samples near each other in the canonical domain share one point, for φ varies slowly
/// there while μ is noisy. Pairings stay exact; the norm is summed over the clusters and corrected to first order.
struct SampleClusters {
    std::vector<int> cluster;     ///< #S cluster of the sample, −1 for an excluded one
    ChartPoints points;           ///< #Q centroids (weighted by area in the domain), derivatives 1
    std::vector<double> squared;  ///< #S A |derivative|²: area in the domain; 0 for an excluded one
};

/// @param phase rotation of the grid, to be tied to the data so that turning the source changes nothing
/// @param target_count about how many clusters away from singularities, to which more are added; at most as many as
///                     samples. A chart without positions gives each sample its own.
SampleClusters cluster_samples(const Operators& operators, const Chart& chart, const Singularities& singularities,
                               double phase, int target_count);

/// Values at the clusters, in the canonical domain, of functions known at the samples: means of φ / derivative²,
/// weighted by area in the domain. #Q × #columns.
/// @param values #S × #columns, in the samples' frames
Eigen::MatrixXcd means_over_clusters(const Eigen::MatrixXcd& values, const SampleClusters& clusters,
                                     const Chart& chart);

}  // namespace beltrami
