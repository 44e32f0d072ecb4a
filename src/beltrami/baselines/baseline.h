#pragma once

#include <functional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Maps that others compute, with one signature, to compare extremal maps with. The source is one component with a
/// boundary.
struct BaselineOptions {
    int max_iterations = 1000;
    /// Stop when √(part by which a step lowers the energy) is below this, for ARAP the part of the source area, for
    /// MIPS as Newton's method predicts it, for the alternation the part of the image's area. For the QC iteration:
    /// when the coefficient changes by less than this (root mean square). No unit.
    double tolerance = 1e-5;
    double smoothing = 0.5;    ///< of arg μ by one pass of the QC iteration, 0 … 1; the other methods ignore it
    int smoothing_passes = 1;  ///< between two solves of the QC iteration, at least 0
    /// Called once per iteration with its number and the energy (ARAP: per source area, 0 for an isometry; MIPS: mean,
    /// 1 for a conformal map; alternation and QC iteration: Σ A |∂̄f − ν∂f|² per area of the image); returning false
    /// cancels (Error cancelled).
    std::function<bool(int iteration, double energy)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct BaselineMap {
    Eigen::VectorXcd map;    ///< #V
    int iterations = 0;      ///< 0 for a linear map
    int factorizations = 0;  ///< of #V×#V systems and larger
    bool converged = false;
    Warnings warnings;
};

/// The harmonic map (Pinkall & Polthier 1993): cotangent weights on triangles.
/// @pre every boundary vertex is prescribed
/// @throw Error bad_mesh, bad_boundary, not_solved
BaselineMap harmonic_baseline(const Surface& source, const BoundaryCondition& boundary,
                              const BaselineOptions& options = {});

/// The least-squares conformal map (Lévy et al. 2002): two or more pins, or none; what is not pinned is free.
/// Without pins the areas of the image add up to that of the source.
/// @throw Error bad_mesh, bad_boundary, not_solved
BaselineMap lscm_baseline(const Surface& source, const BoundaryCondition& boundary,
                          const BaselineOptions& options = {});

/// Tutte's map (1963): every vertex inside in the mean of its neighbours. Where a disk goes to a convex polygon no face
/// folds; the shapes of the source play no part. Elsewhere a warning says that folds are not excluded.
/// @pre every boundary vertex is prescribed
/// @throw Error bad_mesh, bad_boundary, not_solved
BaselineMap tutte_baseline(const Surface& source, const BoundaryCondition& boundary,
                           const BaselineOptions& options = {});

/// The same with Floater's mean value weights (2003), which see the shapes: affine maps of a disk in the plane come out
/// exactly.
BaselineMap mean_value_baseline(const Surface& source, const BoundaryCondition& boundary,
                                const BaselineOptions& options = {});

/// As rigid as possible (Liu, Zhang, Xu, Gotsman, Gortler 2008): a local minimum of Σ A ‖Df − R‖², R the nearest
/// rotation, by alternation, one factorisation and as many solves as iterations. Any number of pins. It starts from the
/// harmonic map where the whole boundary is prescribed, else from the least-squares conformal one. The energy never
/// rises; folds are not excluded.
///
/// The energy compares lengths. Where the whole boundary is prescribed, hence the area of the image, the source is
/// scaled to that area first; else lengths count as they are.
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
BaselineMap arap_baseline(const Surface& source, const BoundaryCondition& boundary,
                          const BaselineOptions& options = {});

/// MIPS, the most isometric parametrization (Hormann & Greiner 1999): a local minimum of Σ A
/// (|∂f|²+|∂̄f|²)/(|∂f|²−|∂̄f|²) by Newton's method (fold_free.h), without folds. Any number of pins. It starts from the
/// first map without folds among: the harmonic map where the whole boundary is prescribed, else the least-squares
/// conformal one; Tutte's (1963) where the boundary is sent to a convex polygon or nothing is prescribed, onto a circle
/// then; the first of these unfolded. With less than two pins the areas of the image add up to that of the source.
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
BaselineMap mips_baseline(const Surface& source, const BoundaryCondition& boundary,
                          const BaselineOptions& options = {});

/// The alternation of Weber, Myles & Zorin 2012 (Algorithm 1) for the Teichmüller map, kept as the paper has it for
/// comparison with extremal_map: descent of Σ A |∂̄f − k conj(φ)/|φ| ∂f|² in turn over φ (a quadratic problem with
/// lagged weights 1/|φ|, then a line search), k (the best one) and f (one linear solve), from the harmonic map. φ is
/// discretely holomorphic, a harmonic 1-form on the edges (section 4.1). The energy never rises.
///
/// Any surface of genus 0, with holes and interior pins. Folds are not excluded. Deviations: k by least squares, where
/// the paper's eq. (12) is garbled; φ from 2∂u, where (8) as printed gives the conjugate; a surface in space is
/// flattened only to write φ down, and keeps its metric in ∂ and ∂̄; at most 10 steps of φ between two of f; |φ| below
/// 1e-4 of its maximum counts as that in the weights. Interior pins, which the paper does not treat, hold f only: φ has
/// no poles there.
/// @pre the whole boundary is prescribed
/// @throw Error bad_mesh (genus), bad_boundary, not_solved, cancelled, bad_option
BaselineMap alternation_baseline(const Surface& source, const BoundaryCondition& boundary,
                                 const BaselineOptions& options = {});

/// The QC iteration of Lui, Gu & Yau 2014 (arXiv 1307.2679; Ng, Gu & Lui, section 5.2, without their damping): from the
/// harmonic map, |μ| of every face is replaced by the mean over all faces, arg μ smoothed by one Jacobi step over face
/// neighbours, and the map with that coefficient solved for; again and again. Everything is local and nothing knows of
/// holomorphic differentials, so a limit need not be a Teichmüller map (Gruber & Aulisa 2022, remark 5.1, on multiply
/// connected domains; docs/baselines.md has measurements). No energy need fall.
///
/// Any topology, with interior pins. Folds are not excluded. Details: arg μ goes by `smoothing` of the way to the mean
/// of its neighbours, differences taken in (−π, π]; the default of one half is Gruber & Aulisa's Algorithm 4, by way of
/// the edges; 0 leaves arg μ alone. One pass a step is the papers'; more of them make it worse (their remark 5.3).
/// Coefficients of neighbours are turned into the face's frame across their common edge, e^{−2iθ}, so that surfaces
/// need no flattening; |μ| counts as at most 0.95 in the mean; a quad's samples are neighbours of each other.
/// @pre the whole boundary is prescribed
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
BaselineMap qc_iteration_baseline(const Surface& source, const BoundaryCondition& boundary,
                                  const BaselineOptions& options = {});

}  // namespace beltrami
