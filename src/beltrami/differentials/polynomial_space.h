#pragma once

#include <beltrami/differentials/differential_space.h>

namespace beltrami {

/// Polynomials up to a degree on the round unit disk: √((j+1)/π) ζ^j, orthonormal in L² of the disk. On the disk itself
/// powers are orthogonal, so that no orthogonalisation on samples is needed and combinations cost one Horner scheme.
class PolynomialSpace final : public DifferentialSpace {
  public:
    /// @param degree         at least 0
    /// @param largest_degree refined() stops there
    PolynomialSpace(int degree, int largest_degree);

    /// Largest degree that a mesh of so many samples resolves.
    static int largest_degree(int sample_count);
    /// A space to start from, which can grow up to a degree.
    static std::unique_ptr<DifferentialSpace> starting_space(int largest_degree);

    int size() const override { return degree_ + 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const override;
    std::unique_ptr<DifferentialSpace> refined() const override;

  private:
    int degree_, largest_degree_;
};

}  // namespace beltrami
