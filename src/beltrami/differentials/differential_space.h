#pragma once

#include <memory>

#include <beltrami/conformal/chart.h>

namespace beltrami {

/// Points at which differentials are wanted: positions in the canonical domain, and the derivative of the chart there
/// (1 for values in the canonical domain itself).
struct ChartPoints {
    Eigen::VectorXcd positions;
    Eigen::VectorXcd derivatives;
};

/// A finite-dimensional subspace of the holomorphic quadratic differentials Q of a problem, with a basis. The solver
/// knows nothing else about topology and boundary condition.
class DifferentialSpace {
  public:
    virtual ~DifferentialSpace() = default;

    /// Number of basis functions.
    virtual int size() const = 0;
    /// True if combinations with complex coefficients belong to the space (boundary values fixed), false if only real
    /// ones do.
    virtual bool complex_coefficients() const = 0;
    /// Values of every basis function, pulled back to the points: #points × size().
    virtual Eigen::MatrixXcd evaluate(const ChartPoints& points) const = 0;
    /// Values of one combination. @param coefficients size() of them
    virtual Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
        return evaluate(points) * coefficients;
    }
    /// A larger space whose first functions are those of this one; null where the mesh resolves no more.
    virtual std::unique_ptr<DifferentialSpace> refined() const = 0;
};

}  // namespace beltrami
