#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami {

struct QuadraticProductsOptions {
    double clip = 0.95;  ///< |μ| is held at this where it is larger
    int max_iterations = 12;
    double tolerance = 0.02;  ///< of the direction of φ; k settles to its square
    /// Told the steps made and k; returning false cancels.
    Progress progress = {};
};

/// What Hamilton's iteration finds with piecewise quadratic maps and one-forms, where boundary values crowd.
struct QuadraticProducts {
    /// Of the last map, |μ| held at clip: 1/I⁻ and √(I⁺/I⁻) are estimates, since φ is tabulated. Not valid if samples
    /// that are held have more than a thousandth of ∫|φ|: then nobody knows what a map without folds has there.
    ReichStrebel integrals;
    double held = 0;                              ///< their part of ∫|φ|
    std::shared_ptr<const TabulatedSpace> space;  ///< at the triangles' centroids, one sample each
    Eigen::VectorXcd direction;                   ///< of φ in it, of length 1
    Eigen::VectorXcd phi;                         ///< #F values at the centroids
    double k = 0;                                 ///< of the last c-step
    std::vector<Iteration> history;               ///< one entry a step
    bool settled = false;
    int factorizations = 0;
};

/// The iteration of a disk in which boundary values crowd (crowding.h), with elements whose derivatives are linear on
/// each triangle: at K ≈ 7 a direction of μ that is off by 4° costs 5 % of 1/I⁻, and that of a piecewise linear map
/// errs by as much on the meshes of scans, as do products of piecewise constant one-forms. Maps, harmonic functions and
/// φ live on the same triangles; boundary values stay linear along edges, so the problem is the same.
///
/// At jagged corners quadratic maps fold in a few samples. Making their edges straight spoils all around them; |μ| is
/// held there, as in every c-step.
/// @param harmonic #V the harmonic map, along whose rim waves run
/// @param phi      #S φ and
/// @param k        k from which to begin, of the piecewise linear iteration
/// @pre a disk of triangles, its whole boundary prescribed and nothing else
/// @throw Error not_solved, cancelled
QuadraticProducts quadratic_products(const Surface& source, const BoundaryCondition& boundary,
                                     const Eigen::VectorXcd& harmonic, const Eigen::VectorXcd& phi, double k,
                                     const QuadraticProductsOptions& options = {});

}  // namespace beltrami
