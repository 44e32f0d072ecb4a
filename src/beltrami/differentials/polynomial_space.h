#pragma once

#include <vector>

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/pole_sums.h>

namespace beltrami {

/// Polynomials up to a degree on the round unit disk: √((j+1)/π) ζ^j, orthonormal in L² of the disk. On the disk itself
/// powers are orthogonal, so that no orthogonalisation on samples is needed and combinations cost no more than sums of
/// powers.
class PolynomialSpace final : public DifferentialSpace {
  public:
    /// @param degree         at least 0
    /// @param largest_degree refined() stops there
    PolynomialSpace(int degree, int largest_degree);

    /// More than this smooth data do not ask for.
    static constexpr int kMostDegree = 40;
    /// Largest degree that a mesh of so many samples resolves, at most @p most.
    static int largest_degree(int sample_count, int most = kMostDegree);
    /// A space to start from, which can grow up to a degree.
    static std::unique_ptr<DifferentialSpace> starting_space(int largest_degree);

    int size() const override { return degree_ + 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const override;
    Eigen::MatrixXcd pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const override;
    bool quick() const override { return true; }
    std::unique_ptr<DifferentialSpace> refined() const override;

  private:
    int degree_, largest_degree_;
    std::vector<Pole> powers_;
    Eigen::VectorXd factors_;  ///< of the powers
};

}  // namespace beltrami
