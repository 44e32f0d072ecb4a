#pragma once

#include <vector>

#include <beltrami/differentials/curve_densities.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/pole_sums.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// Rational quadratic differentials on a domain inside the unit disk: polynomials, powers of r/(z − c) for every hole,
/// poles r/(z − p) clustered towards every corner from outside (r the distance from p to the corner, falling like
/// exp(−4(√N − √(N−j))); Gopal & Trefethen 2019 show root-exponential convergence for such poles), a simple pole at
/// every pinned point or point held to a line, and Cauchy integrals over curves of such points (curve_densities.h).
/// Orthonormal in L² of a quadrature; functions that depend on earlier ones are left out. Where some functions admit
/// real coefficients only, all have them, and iφ stands beside every φ that may have any.
///
/// Where there are corners or curves, the first space is preliminary and has no functions for them: such as live on a
/// few faces would be fitted to the folds of the start.
class RationalSpace final : public DifferentialSpace {
  public:
    /// Poles of one cluster, at most.
    static constexpr int corner_poles = 8;

    /// Points of the canonical domain that resolve the singularities, with their weights (areas).
    struct Quadrature {
        Eigen::VectorXcd points;
        Eigen::VectorXd weights;
    };

    /// A space to start from, which can grow up to a degree of the polynomials, and each hole's largest power.
    static std::unique_ptr<DifferentialSpace> starting_space(const Singularities& singularities, Quadrature quadrature,
                                                             int largest_degree);
    /// The one to which that can grow.
    static std::unique_ptr<DifferentialSpace> largest_space(const Singularities& singularities, Quadrature quadrature,
                                                            int largest_degree);

    int size() const override { return static_cast<int>(transform_.cols()); }
    bool complex_coefficients() const override { return !family_->singularities.real(); }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    const Eigen::MatrixXcd* transform() const override { return &transform_; }
    Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const override;
    Eigen::MatrixXcd pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const override;
    bool quick() const override { return family_->curves.empty() && family_->singularities.held.empty(); }
    std::unique_ptr<DifferentialSpace> refined() const override;
    bool preliminary() const override {
        return !with_corners_ && !(family_->singularities.corners.empty() && family_->curves.empty());
    }

  private:
    /// A pole or a Cauchy integral.
    struct Generator {
        Generator(const Pole& p) : pole(p) {}
        Generator(const Pole& p, Complex only) : pole(p), real(true), factor(only) {}
        Generator(int of_curve, int j, bool is_real) : real(is_real), curve(of_curve), density(j) {}
        Pole pole{0.0, 1.0, 0};
        bool real = false;  ///< factor times this admits real coefficients only
        Complex factor = 1.0;
        int curve = -1, density = 0;  ///< of Family::curves, if it is a Cauchy integral
    };
    struct Family {
        Singularities singularities;
        Quadrature quadrature;
        int largest_degree, largest_power;
        std::vector<CurveDensities> curves;
        int levels = 0;  ///< of the curves' densities, at most
    };

    explicit RationalSpace(std::shared_ptr<const Family> family) : family_(std::move(family)) {}
    /// Without functions.
    static std::unique_ptr<RationalSpace> empty_space(const Singularities& singularities, Quadrature quadrature,
                                                      int largest_degree);
    /// Those of the first space, which count as taken.
    std::vector<Generator> take_first();
    /// Appends functions and orthonormalises them against those that are there.
    void add(const std::vector<Generator>& more);
    /// The poles at the corners, which count as taken.
    std::vector<Generator> take_corner_poles();
    /// The next level of the curves' densities, which counts as taken.
    std::vector<Generator> take_densities();
    /// Polynomials up to a degree, powers at the holes: those that are new, which count as taken.
    std::vector<Generator> raise(int degree, int power);
    Eigen::MatrixXcd with_densities(const Eigen::MatrixXcd& of_poles, const Eigen::VectorXcd& z) const;

    std::shared_ptr<const Family> family_;
    int degree_ = -1, power_ = 0, levels_ = 0;
    bool with_corners_ = false;
    std::vector<Generator> generators_;
    std::vector<Pole> poles_;            ///< those of the generators that are poles, in their order
    std::vector<Eigen::Index> pole_at_;  ///< the generators that these are
    Eigen::MatrixXcd transform_;         ///< columns of earlier functions stay as they are
};

}  // namespace beltrami
