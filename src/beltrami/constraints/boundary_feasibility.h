#pragma once

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Refuses boundary data that no one-to-one, orientation-preserving map of a genus-0 surface to the plane has. Any
/// number of boundary loops; vertices that are not prescribed are free, and only what does not depend on them is
/// examined. Passing is necessary for a map to exist; for wholly prescribed loops it is sufficient in the continuous
/// problem (not on a given mesh: see split_prescribed).
///
/// Refused are, each with the vertices in indices():
/// - images of different prescribed vertices that coincide;
/// - images of boundary edges that meet: of one loop (turning straight back, crossing itself) or of two;
/// - a wholly prescribed loop that runs the wrong way round: counter-clockwise is right for @p outer_loop, clockwise
/// for
///   every other one, both run through with the faces on the left;
/// - images outside the outer loop's image, or inside another loop's image;
/// - interior pins on the image of a boundary edge;
/// - lines of vertices that pass by the image of the outer loop, where that is wholly prescribed;
/// - a face without interior edges, all prescribed, whose image folds (every other face with all its vertices
/// prescribed
///   gets a free vertex by split_prescribed, so it is no obstruction).
/// Comparisons are in floating point; pins within 1e-14 of the data's diameter of a segment count as lying on it, and a
/// turn by π to within 1e-12 counts as straight back. Time n log n.
/// @param outer_loop index in topology.boundary_loops of the loop whose image surrounds all others; not read if the
///        surface is closed
/// @throw Error bad_boundary as above, or from validate(); bad_mesh unless there is one component of genus 0;
///        bad_option if there is no such loop
void require_feasible(const Surface& source, const BoundaryCondition& boundary, int outer_loop = 0);

}  // namespace beltrami
