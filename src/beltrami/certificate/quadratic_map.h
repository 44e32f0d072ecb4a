#pragma once

#include <memory>

#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A piecewise quadratic map of a triangle mesh: images of the vertices, then of the midpoints of topology's edges
/// (#V+#E). Its derivatives are linear on a triangle, so where a piecewise linear map errs by h its Reich-Strebel bound
/// errs by h², and that of a piecewise quadratic one by h⁴ where the extremal map is smooth. (Kinks of the polygonal
/// boundary and zeros of φ keep it near h².)
///
/// Where the midpoints of boundary edges go to the midpoints of their images it has the boundary values of a piecewise
/// linear map: it belongs to the same extremal problem.
using QuadraticMap = Eigen::VectorXcd;

/// A piecewise linear map as a piecewise quadratic one.
QuadraticMap straight(const Surface& source, const Eigen::VectorXcd& map);

/// ∂ and ∂̄ of piecewise quadratic maps: three samples a triangle, of degree 2, in the frame of the triangle's own
/// sample.
/// @pre all faces are triangles
Operators quadratic_operators(const Surface& source);

/// The piecewise quadratic f-step: maps with coefficient k conj(φ)/|φ|, φ evaluated at the quadrature points, and the
/// boundary values and prescribed vertices of a problem. #V+#E unknowns, one factorisation for nearly equal k.
class QuadraticStep {
  public:
    /// @param boundary the whole boundary is prescribed and nothing slides
    /// @pre all faces are triangles
    /// @throw Error bad_mesh
    QuadraticStep(const Surface& source, const BoundaryCondition& boundary, const Chart& chart,
                  const DifferentialSpace& space, const Eigen::VectorXcd& coefficients);

    /// @throw Error not_solved
    QuadraticMap solve(double k);
    int factorizations() const { return solver_->factorization_count(); }

  private:
    Surface quadratic_;  ///< the source with quadratic_operators and a boundary that knows the midpoints
    std::unique_ptr<BeltramiSolver> solver_;
    Eigen::VectorXcd prescribed_, towards_;  ///< towards: conj(φ)/|φ| at the samples
    QuadraticMap last_;
};

/// Makes edges straight at triangles on which the determinant is not positive, until there are none or the rest is
/// straight. Positive is proved by the coefficients of the determinant in Bernstein's basis.
/// @return triangles that remain with a determinant not proved positive
std::vector<int> straighten(const Surface& source, QuadraticMap& map);

/// The same, and where triangles remain, takes the images that another map has at their corners, straight between
/// them, until there are none: the rest of @p map stays. At a corner of the boundary values a quadratic solution may
/// fold where a piecewise linear one has been opened.
/// @param other #V images of a piecewise linear map with the same boundary values
/// @return triangles that remain, none if @p other turns none over
std::vector<int> mend(const Surface& source, QuadraticMap& map, const Eigen::VectorXcd& other);

/// The Reich-Strebel integrals of a piecewise quadratic map, with its coefficient at every quadrature point.
/// @return not valid if a determinant is not proved positive
ReichStrebel reich_strebel_quadratic(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                                     const Eigen::VectorXcd& coefficients, const QuadraticMap& map);

}  // namespace beltrami
