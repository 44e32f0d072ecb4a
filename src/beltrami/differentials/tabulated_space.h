#pragma once

#include <beltrami/differentials/differential_space.h>

namespace beltrami {

/// Which combinations of given functions belong to a space.
enum class Coefficients { real, complex };

/// A space of differentials that are known at the samples of one mesh only, in the samples' frames: the outcome of a
/// solve on that mesh. Approximately holomorphic; Reich-Strebel integrals with it are estimates, not bounds.
class TabulatedSpace final : public DifferentialSpace {
  public:
    /// @param values #S × m, one column for each function
    /// @throw Error bad_option if a value is not finite
    explicit TabulatedSpace(Eigen::MatrixXcd values, Coefficients coefficients = Coefficients::real);

    int size() const override { return static_cast<int>(values_.cols()); }
    bool complex_coefficients() const override { return coefficients_ == Coefficients::complex; }
    const Eigen::MatrixXcd* tabulated() const override { return &values_; }
    /// @throw std::logic_error always: nothing is known between the samples
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    Eigen::MatrixXcd values_;
    Coefficients coefficients_;
};

/// What takes the place of a chart for tabulated spaces: no positions, no exclusions, and the derivative of a
/// similarity to the area π everywhere, whatever the surface.
Chart chart_of_frames(const Surface& source);

}  // namespace beltrami
