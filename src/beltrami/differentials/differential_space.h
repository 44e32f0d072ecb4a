#pragma once

#include <memory>

#include <beltrami/base/public.h>
#include <beltrami/charts/chart.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Points at which differentials are wanted: positions in the canonical domain, and the derivative of the chart there
/// (1 for values in the canonical domain itself).
struct ChartPoints {
    Eigen::VectorXcd positions;
    Eigen::VectorXcd derivatives;
};

/// A finite-dimensional subspace of the holomorphic quadratic differentials Q of a problem, with a basis. The solver
/// knows nothing else about topology and boundary condition.
///
/// The basis is given as combinations of simple functions, the generators: Φ = G T. Where many points are concerned G
/// is kept and coefficients are passed through T, which is cheaper than multiplying the two.
class DifferentialSpace {
  public:
    virtual ~DifferentialSpace() = default;

    /// Number of basis functions.
    virtual int size() const = 0;
    /// True if combinations with complex coefficients belong to the space (boundary values fixed), false if only real
    /// ones do.
    virtual bool complex_coefficients() const = 0;
    /// Values of every generator, pulled back to the points: #points × #generators.
    virtual Eigen::MatrixXcd generators(const ChartPoints& points) const = 0;
    /// Values of every generator at the source's own samples, in the samples' frames: #S × #generators. Not null where
    /// a space is known there only; generators() and combination() then throw, and no chart is needed.
    virtual const Eigen::MatrixXcd* tabulated() const { return nullptr; }
    /// T: #generators × size(); null where the generators are the basis.
    virtual const Eigen::MatrixXcd* transform() const { return nullptr; }
    /// Values of one combination. @param coefficients size() of them
    virtual Eigen::VectorXcd combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const;
    /// Σ_s weights(s, column) φ_j(s) for every function j: size() × #columns.
    virtual Eigen::MatrixXcd pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const;
    /// Whether combination() and pair() are as cheap as reading stored values of the generators, and run on all
    /// threads.
    virtual bool quick() const { return false; }
    /// A larger space whose first functions are those of this one; null where the mesh resolves no more.
    virtual std::unique_ptr<DifferentialSpace> refined() const = 0;

    /// Whether the space is only meant for the first few iterations, in which folds open: refined() is then to be taken
    /// whatever it does for k.
    virtual bool preliminary() const { return false; }

    /// Values of every basis function: #points × size().
    Eigen::MatrixXcd evaluate(const ChartPoints& points) const;
    /// T c: the coefficients of the generators.
    Eigen::VectorXcd of_generators(const Eigen::VectorXcd& coefficients) const;
    /// Tᵀ g: values of the basis from values of the generators, of anything linear in the functions.
    Eigen::MatrixXcd from_generators(const Eigen::MatrixXcd& of_generators) const;
};

}  // namespace beltrami
