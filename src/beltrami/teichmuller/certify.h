#pragma once

#include <limits>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct CertifyOptions {
    int most_triangles = 300000;  ///< no finer mesh than that for the estimates
    int most_refinements = 6;
    double least_progress = 0.1;  ///< give up where a refinement takes less than this part from the gap
    /// No finer mesh than that for the proof, and no proof on meshes that have more already.
    int most_proof_triangles = 12000;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// An extremal map with a bracket of K*.
struct Certification {
    /// The map of the given mesh. Its bounds are the best of all meshes, K_lower_proved among them; K is the estimate
    /// of the mesh with the largest, within the bracket.
    ExtremalMap result;
    /// K* ≤ this, attained by a piecewise quadratic map and verified up to rounding (verified_bracket.h); infinite
    /// where there is none.
    double K_upper = std::numeric_limits<double>::infinity();
    double gap = std::numeric_limits<double>::infinity();  ///< K_upper/K_lower_proved − 1
    double estimated_gap = 0;                              ///< K/K_lower − 1
    bool reached = false;                                  ///< gap is what was wanted: proved
    std::string reason;                                    ///< a sentence: what is proved, or why it is not
    int refinements = 0;      ///< finer meshes that were solved, for the proof and for the estimate
    int proof_triangles = 0;  ///< of the mesh of the proof; 0: none was tried
};

/// The extremal map, with a proof that K_upper is at most (1 + @p gap) K_lower_proved, or a reason why there is none.
/// K_lower_proved is the largest of the rigorous bounds of the result and those of verified_bracket.h on its refined
/// meshes, single boundary vertices included (edge_corner_bound.h): the polygons themselves are the problem here.
///
/// Where nothing is proved, the estimates are improved instead: the whole problem on midpoint subdivisions
/// (refined_problem.h), each started from the last map, until K/K_lower − 1 is no more than @p gap or that stops to
/// help. Then the reason says what is an estimate.
///
/// K* is that of the polyhedral surface, its polygons and the boundary values linear along their edges; for data
/// sampled from smooth ones it differs from theirs by O(h²), or, where single vertices decide, by O(h). With holes
/// both are those of the map's homotopy class; "edge_corner" and "moduli" among the bounds hold for all classes.
/// @throw as extremal_map; Error bad_option for a gap that is not positive
Certification certify(const Surface& source, const Constraints& constraints, double gap,
                      const ExtremalOptions& options = {}, const CertifyOptions& limits = {});

}  // namespace beltrami
