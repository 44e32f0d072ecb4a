#pragma once

#include <vector>

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/pole_sums.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// Rational quadratic differentials on a domain inside the unit disk: polynomials, powers of r/(z − c) for every hole,
/// poles r/(z − p) clustered towards every corner from outside (r the distance from p to the corner, falling like
/// exp(−4(√N − √(N−j))); Gopal & Trefethen 2019 show root-exponential convergence for such poles), and a simple pole at
/// every pinned point. Orthonormal in L² of a quadrature; functions that depend on earlier ones are left out.
///
/// Where there are corners, the first space is preliminary and has no poles at them: functions that live on a few faces
/// would be fitted to the folds of the start.
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

    int size() const override { return static_cast<int>(transform_.cols()); }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    const Eigen::MatrixXcd* transform() const override { return &transform_; }
    Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const override;
    Eigen::MatrixXcd pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const override;
    bool quick() const override { return true; }
    std::unique_ptr<DifferentialSpace> refined() const override;
    bool preliminary() const override { return !with_corners_ && !family_->singularities.corners.empty(); }

  private:
    struct Family {
        Singularities singularities;
        Quadrature quadrature;
        int largest_degree, largest_power;
    };

    explicit RationalSpace(std::shared_ptr<const Family> family) : family_(std::move(family)) {}
    /// Appends functions and orthonormalises them against those that are there.
    void add(const std::vector<Pole>& more);
    /// The poles at the corners, which count as taken.
    std::vector<Pole> take_corner_poles();
    /// Polynomials up to a degree, powers at the holes: those that are new, which count as taken.
    std::vector<Pole> raise(int degree, int power);

    std::shared_ptr<const Family> family_;
    int degree_ = -1, power_ = 0;
    bool with_corners_ = false;
    std::vector<Pole> generators_;
    Eigen::MatrixXcd transform_;  ///< columns of earlier functions stay as they are
};

}  // namespace beltrami
