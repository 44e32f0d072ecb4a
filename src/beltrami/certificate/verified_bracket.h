#pragma once

#include <limits>
#include <string>

#include <beltrami/base/public.h>
#include <beltrami/certificate/pair_bound.h>
#include <beltrami/certificate/quadratic_space.h>

namespace beltrami BELTRAMI_PUBLIC {

struct VerifiedBracketOptions {
    double gap = 0.01;            ///< stop at K_upper ≤ (1 + gap) K_lower
    double K_lower = 1;           ///< proved already
    int most_triangles = 12000;   ///< of a mesh that is refined again
    int most_rounds = 8;          ///< of refinement
    double least_progress = 0.1;  ///< give up where two rounds take less than this part from the gap
    PairBoundOptions pair;
};

/// Two numbers between which K* is proved to lie, up to rounding, and the map that shows the upper one.
struct VerifiedBracket {
    double K_lower = 1, K_upper = std::numeric_limits<double>::infinity();
    bool reached = false;
    std::string reason;  ///< a clause: why it ended
    Surface surface;     ///< the source, refined where it had to be: the same polyhedral surface
    BoundaryCondition boundary;
    std::vector<int> cones;  ///< vertices with power elements
    QuadraticMap map;        ///< of QuadraticSpace(surface, cones)
    int refinements = 0, factorizations = 0;
    double pair = 1;  ///< the largest bound by pairs on the refined meshes
};

/// Proves a bracket of K* for the polyhedral surface and boundary values that are linear along its edges. The upper end
/// is attained by a piecewise quadratic map with power elements at cone points (quadratic_space.h): |μ| is lowered by
/// one-sided least squares where it is largest (one_sided.h), the map is prolonged exactly onto meshes refined where it
/// still is: triangles into four, but at kinked boundary vertices and pins, where the dilatation depends on the number
/// of sectors and not on their size, the opposite edges are halved, then a ring is cut off. The lower end is raised by
/// pairs of piecewise linear functions on these meshes (pair_bound.h).
///
/// With holes both ends are those of the homotopy class of @p map, with the given K_lower.
/// @param map #V a piecewise linear map with the boundary values
/// @pre all faces are triangles, the whole boundary is prescribed, no vertex is held to a line
/// @throw Error not_solved
VerifiedBracket verified_bracket(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                                 const VerifiedBracketOptions& options = {});

}  // namespace beltrami
