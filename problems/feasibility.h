#pragma once

#include <string>
#include <vector>

#include "problems/problems.h"

namespace beltrami::bench {

/// Why a problem's boundary values cannot be those of a one-to-one map that keeps orientation, or empty: every loop's
/// image simple, the outer one counter-clockwise, those of holes clockwise, disjoint and side by side inside the outer.
std::string infeasibility(const Problem& problem);

/// What a piecewise linear map to the plane does to the faces of a mesh (triangles, in the plane or space).
struct MapQuality {
    int flipped = 0;       ///< faces whose image has no positive area
    double max_mu = 0;     ///< largest |μ|; 1 where ∂f vanishes alone
    double p95_mu = 0;     ///< the |μ| below which 95 % of the faces are
    double pin_error = 0;  ///< largest distance of a prescribed vertex from its image
};
MapQuality map_quality(const Problem& problem, const Eigen::VectorXcd& map);

/// By how many turns two maps with the same boundary values differ: for each boundary loop its counter-clockwise
/// turns against the outer one under @p map, less those under @p other; 0 for the outer loop 0. All 0 for homotopic
/// maps; with two or more holes maps of different braids can have all 0 too.
/// @pre both maps are without flips (else an edge can cross the image of a hole)
std::vector<int> relative_turns(const Problem& problem, const Eigen::VectorXcd& map, const Eigen::VectorXcd& other);

}  // namespace beltrami::bench
