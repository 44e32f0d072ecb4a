#pragma once

#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// Adds what can be proved about K* (proved_bounds.h) to the bounds of a result.
void add_proofs(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options,
                ExtremalMap& result);

/// Adds the pair bound of refined meshes (refined_pair.h), which is up to 8 % larger where values crowd, to the bounds.
/// Not of quads, of meshes of more than 20 000 faces, nor where the bracket is closed.
/// @param known a lower bound that there is
void add_finer_pair(const Surface& source, const BoundaryCondition& boundary, double known, ExtremalMap& result);

/// The largest of K_lower, of what the bounds prove, and of what quadrilaterals force in the chart.
double largest_known(const ExtremalMap& result);
/// Whether a K is clearly below what is known: the φ of which it is does not show the extremal map.
bool clearly_below(double K, double known);

/// Raises K_lower_proved, K_lower and K to what the bounds prove; where the K found was clearly lower the termination
/// and a warning say so.
void raise_to_proofs(ExtremalMap& result);

/// The largest rigorous lower bound of K* among bounds; 1 if there is none.
double largest_proof(const std::vector<Bound>& bounds);

}  // namespace beltrami
