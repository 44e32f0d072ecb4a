#pragma once

#include <optional>

#include <beltrami/coefficient/chart_cells.h>
#include <beltrami/coefficient/dual_step.h>
#include <beltrami/differentials/sampled_space.h>

namespace beltrami {

/// Points of a canonical domain with their areas.
struct QuadraturePoints {
    Eigen::VectorXcd points;
    Eigen::VectorXd weights;
};

/// The c-step on a mesh: from μ of a map to φ and k. Over every sample, pairings, the norm and its gradient see all of
/// μ, and the Hessian of Newton's method is summed over clusters: φ is exact where μ is that of the mesh. On cells
/// (chart_cells.h) Newton's method sees the nodes alone, each step at the same cost on any mesh: φ has an error of
/// 1e-4 or so, to which k, taken over every sample, is exact to second order.
class CoefficientStep {
  public:
    enum class Sums { over_samples, over_cells };
    struct Result {
        Eigen::VectorXcd direction;  ///< coefficients of φ, of length 1; 0 if nothing pairs with μ
        Eigen::VectorXcd phi;        ///< #S values of φ for these coefficients
        double k = 0;
        /// 1/I⁻ of the Reich-Strebel inequality for φ and μ (held at clip), one point per sample: how good both are.
        double merit = 0;
        int newton_steps = 0;
        bool converged = false;  ///< of the convex problem
    };

    /// @param source, chart kept by reference
    /// @param phase see SampledSpace
    /// @param sums  over cells only where φ has no singularities, and where there are more samples than clusters
    CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities, double phase,
                    int cluster_count, Sums sums = Sums::over_samples);
    /// The same with samples that have several points given, on meshes of any size: those of points_near() else. Of
    /// spaces of few functions.
    CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities, double phase,
                    int cluster_count, SamplePoints means);

    /// Points of the canonical domain that resolve what the c-step sees, with their areas.
    const QuadraturePoints& quadrature() const { return quadrature_; }

    /// Makes another space the current one; kept by reference until the next call.
    void set_space(const DifferentialSpace& space);

    /// |φ| is rounded off below this part of its mean, and in any case where the samples do not resolve it. More makes
    /// Newton's method quick, less makes φ exact.
    void set_least_rounding(double part) { least_rounding_ = part; }

    /// |μ| is held at this where it is larger (0.95): 0.95 ≤ clip < 1. Of maps that have more everywhere.
    void set_clip(double clip) { clip_ = clip; }

    /// φ of coefficients (#S).
    const Eigen::VectorXcd& values(const Eigen::VectorXcd& coefficients);

    /// ν of the f-step: k conj(φ)/|φ|. Where curves are, k conj(φ)/√(|φ|² + δ²) with the rounding δ of the c-step:
    /// there φ may all but vanish on one side, where less than k will do, and what is left of it says how much less.
    Eigen::VectorXcd coefficient(double k, const Eigen::VectorXcd& phi) const;

    /// @param mu    #S coefficients of the map; those of flipped or nearly flipped samples are held at |μ| = clip
    /// @param start direction to start from, padded by zeros; empty at the very beginning
    /// @param step  length of a Newton step, as part of the whole, at which c is good enough
    /// @param newton_steps allowed
    Result solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start, double step = 0, int newton_steps = 50);

  private:
    /// What μ weighs the samples with, in the samples' frames: A b and A a, 0 where the chart excludes the sample.
    struct Weights {
        Eigen::VectorXcd pairing;
        Eigen::VectorXd norm;
    };
    Weights weights_of(const Eigen::VectorXcd& mu) const;
    /// φ and k, of which the pairing, ∫ a|φ| and ∫|φ| are known.
    static void set_dilatation(double pairing, double norm, double plain, Result& result);
    Result solve_on_cells(const Weights& weights, const Eigen::VectorXcd& start, const DualOptions& options);
    Result solve_on_samples(const Weights& weights, const Eigen::VectorXcd& start, DualOptions options);
    /// A start without one, and δ for the rest.
    Eigen::VectorXcd begin(const Eigen::VectorXcd& start);
    CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities, double phase,
                    int cluster_count, Eigen::VectorXd areas);
    void make_clusters(const SamplePoints& means);
    void make_clusters_near();  // the singularities
    /// A part of a cluster.
    struct Part {
        int cluster;
        double part;
    };
    void set_quadrature(const SamplePoints& means);
    Eigen::VectorXd at_points(const Eigen::VectorXd& of_samples) const;

    const Surface& source_;
    const Chart& chart_;
    Singularities singularities_;
    double phase_;
    int cluster_count_;
    SampledSpace sampled_;
    Eigen::VectorXd areas_;  ///< #S in the canonical domain, 0 for an excluded sample
    std::optional<ChartCells> cells_;
    bool on_cells_ = false;                             ///< the current space
    SplitMatrix at_places_;                             ///< of the cells: generators of the current space
    Eigen::VectorXcd last_coefficients_, last_values_;  ///< of values()
    SampleClusters clusters_;                           ///< empty as long as there are cells only
    QuadraturePoints quadrature_;
    std::vector<Part> parts_;  ///< of the clusters, for which those points stand
    DualProblem problem_;
    Eigen::VectorXd moved_;  ///< of φ at the clusters in the last step
    bool bent_ = false;      ///< the last step took the Hessian of all samples
    double least_rounding_ = 0;
    double clip_ = 0.95;
    bool soft_ = false;  ///< see coefficient()
    double edge_ = 0;    ///< of the mean sample in the canonical domain
};

}  // namespace beltrami
