#pragma once

#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

struct CertifyOptions {
    int most_triangles = 300000;  ///< no finer mesh than that
    int most_refinements = 6;
    double least_progress = 0.1;  ///< give up where a refinement takes less than this part from the gap

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// An extremal map with a bracket of K*.
struct Certification {
    /// The map of the given mesh. K and K_lower are those of the mesh with the largest bound; the bounds are the best
    /// of all meshes: the largest Reich-Strebel bound, and the largest rigorous one where that is another.
    ExtremalMap result;
    double gap = 0;  ///< K/K_lower − 1
    bool reached = false;
    std::string reason;   ///< a sentence: why it ended
    int refinements = 0;  ///< finer meshes that were solved
};

/// The extremal map, with refinements until K/K_lower − 1 is no more than @p gap, or a reason why not: flipped faces, a
/// corner of the boundary values that forces a larger K than the φ found (boundary_corners.h), the size limit, no
/// progress. First the bound of piecewise quadratic maps on the given mesh; then the whole problem again on midpoint
/// subdivisions (refined_problem.h), started from the last map, with as many differentials as the finer mesh resolves.
///
/// K* is that of the polygons and the boundary values linear along their edges; for data sampled from smooth ones it
/// differs from theirs by O(h²).
/// @throw as extremal_map; Error bad_option for a gap that is not positive
Certification certify(const Surface& source, const Constraints& constraints, double gap,
                      const ExtremalOptions& options = {}, const CertifyOptions& limits = {});

}  // namespace beltrami
