#pragma once

#include <functional>
#include <string>
#include <vector>

#include <beltrami/maps/boundary_condition.h>

namespace beltrami {

/// Maps that others compute, with one signature, to compare extremal maps with. The source is one component with a
/// boundary.
struct BaselineOptions {
    int max_iterations = 1000;
    /// Stop when √(part by which a step lowers the energy) is below this, for ARAP the part of the source area, for
    /// MIPS as Newton's method predicts it. No unit.
    double tolerance = 1e-5;
    /// Called once per iteration with its number and the energy (ARAP: per source area, 0 for an isometry; MIPS: mean,
    /// 1 for a conformal map); returning false cancels (Error cancelled).
    std::function<bool(int iteration, double energy)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct BaselineMap {
    Eigen::VectorXcd map;    ///< #V
    int iterations = 0;      ///< 0 for a linear map
    int factorizations = 0;  ///< of #V×#V systems and larger
    bool converged = false;
    std::vector<std::string> warnings;
};

/// The harmonic map (Pinkall & Polthier 1993): cotangent weights on triangles.
/// @pre every boundary vertex is prescribed
/// @throw Error bad_mesh, bad_boundary, not_solved
BaselineMap harmonic_baseline(const Surface& source, const BoundaryCondition& boundary,
                              const BaselineOptions& options = {});

/// The least-squares conformal map (Lévy et al. 2002): two or more pins, or none; what is not pinned is free.
/// @throw Error bad_mesh, bad_boundary, not_solved
BaselineMap lscm_baseline(const Surface& source, const BoundaryCondition& boundary,
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
/// then; the first of these untangled.
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
BaselineMap mips_baseline(const Surface& source, const BoundaryCondition& boundary,
                          const BaselineOptions& options = {});

}  // namespace beltrami
