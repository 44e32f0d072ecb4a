#pragma once

#include <beltrami/differentials/differential_space.h>

namespace beltrami {

/// e^{inw} for |n| up to a degree on the strip 0 ≤ Im w ≤ Y of period 2π (annulus_strip): the differentials of an
/// annulus whose boundary is held. Orthonormal in L² of the strip. In the ring of radii e^{−Y} and 1 they are powers,
/// of which many degrees differ only along its rims where the annulus is long.
class StripSpace final : public DifferentialSpace {
  public:
    /// @param degree at least 0
    /// @param height Y > 0
    StripSpace(int degree, double height);

    int size() const override { return 2 * degree_ + 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    int degree_;
    double height_;
    Eigen::VectorXd factors_;  ///< by |n|
};

}  // namespace beltrami
