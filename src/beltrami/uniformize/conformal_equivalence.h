#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/uniformize/scaled_surface.h>

namespace beltrami {

/// What the scale factors have to achieve.
struct ScaleFactorProblem {
    Eigen::VectorXd
        target_angles;  ///< #V angle sums wanted, radians; NaN where nothing is asked (no triangles, or u is fixed)
    std::vector<char> free;    ///< #V: u may change here; elsewhere it keeps its start
    double tolerance = 1e-10;  ///< largest angle defect, radians
    int max_iterations = 100;
    bool stop_when_degenerate = true;  ///< give up early where it shows that degenerate triangles will remain
};

/// How the iteration ended.
enum class ScaleFactorStatus {
    converged,     ///< every defect is below the tolerance
    stagnated,     ///< rounding allows no smaller defect
    degenerate,    ///< stopped early: triangles that violate the triangle inequality
    out_of_steps,  ///< max_iterations
};

struct ScaleFactors {
    Eigen::VectorXd u;  ///< #V logarithmic scale factors
    ScaleFactorStatus status = ScaleFactorStatus::out_of_steps;
    int iterations = 0;  ///< Newton steps
    int factorizations = 0;
    int flips = 0;
    double residual = 0;          ///< largest |angle sum − target| over the vertices with a target
    std::vector<int> degenerate;  ///< triangles whose scaled lengths violate the triangle inequality
};

/// Finds u such that the metric scaled by e^{(u_i+u_j)/2} has the wanted angle sums: Newton's method with a line search
/// on the convex energy whose gradient is Θ − Σα and whose Hessian is the cotangent Laplacian. Ptolemy flips keep the
/// scaled metric Delaunay, so only triangles along the boundary, whose edges cannot flip, can degenerate.
/// Source: Springborn, Schröder, Pinkall 2008, "Conformal equivalence of triangle meshes" (energy, gradient, Hessian);
/// Gillespie, Springborn, Crane 2021, "Discrete conformal equivalence of polyhedral surfaces" (flips).
///
/// @param triangulation changed by flips; on return it is Delaunay for the returned u (boundary edges excepted)
/// @param u             #V start; fixed vertices keep their values
/// @throw Error not_solved if the Laplacian cannot be factorised even with a shift of its diagonal
ScaleFactors solve_scale_factors(IntrinsicTriangulation& triangulation, const ScaleFactorProblem& problem,
                                 Eigen::VectorXd u);

/// The same on any surface that can be scaled: before every step it may release vertices that it holds, and the
/// iteration has converged only where it releases none.
ScaleFactors solve_scale_factors(ScaledSurface& surface, const ScaleFactorProblem& problem, Eigen::VectorXd u);

}  // namespace beltrami
