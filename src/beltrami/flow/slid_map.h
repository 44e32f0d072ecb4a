#pragma once

#include <string>
#include <vector>

#include <beltrami/teichmuller/sliding_start.h>

namespace beltrami {

/// What iterations whose boundary slides end with: FlowMap, TMapSchemeResult.
struct SlidMap {
    Eigen::VectorXcd map;         ///< #V images in the target's plane
    Distortion distortion;        ///< of map
    std::vector<LoopOnto> loops;  ///< in the order of the source's loops
    Termination termination = Termination::converged;
    int factorizations = 0;
    std::vector<std::string> warnings;

    bool one_to_one() const { return distortion.flipped.empty() && distortion.degenerate.empty(); }
};

/// @throw Error bad_option if the start is one of another source
void require_start_of(const Surface& source, const SlidingStart& start);

/// From the map and where its boundary is: distortion and loops. The start's factorisations are added.
void record_map(const Surface& source, const SlidingStart& start, const SlidingBoundary& boundary, SlidMap& result);

/// Warnings about flipped faces and, after a limit, about @p stopped: "7 iterations before the map settled".
void warn_of_folds_and_limit(const std::string& stopped, SlidMap& result);

}  // namespace beltrami
