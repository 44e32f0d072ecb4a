#pragma once

#include <beltrami/baselines/baseline.h>

namespace beltrami::detail {

/// @throw Error bad_option, bad_mesh, bad_boundary: options, one component with a boundary to unfold from, and the
/// boundary condition
void check_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options);

/// Area that the image of the boundary encloses, loops added with their orientation.
/// @pre the whole boundary is prescribed
double enclosed_area(const Surface& source, const BoundaryCondition& boundary);

/// True, with a warning, if the whole boundary is prescribed and encloses no positive area, so that every map folds.
bool must_fold(const Surface& source, const BoundaryCondition& boundary, BaselineMap& result);

/// Harmonic where the whole boundary is prescribed, else least-squares conformal, with the pins there are; moved to a
/// single pin.
Eigen::VectorXcd linear_map(const Surface& source, const BoundaryCondition& boundary, int& factorizations);

/// Scales a map, about the pin if there is one, so that the areas of the image add up to that of the source; only where
/// the boundary condition leaves its size open.
void give_true_size(const Surface& source, const BoundaryCondition& boundary, Eigen::VectorXcd& map);

/// True if no sample is folded or flat.
bool has_no_folds(const Surface& source, const Eigen::VectorXcd& map);

/// Warns of flipped faces.
void warn_of_flips(const Surface& source, BaselineMap& result);
/// After a limit, a warning: "stopped after 7 iterations before the energy settled".
/// @param unsettled "iterations before the energy settled"
void warn_of_limit(const char* unsettled, BaselineMap& result);

}  // namespace beltrami::detail
