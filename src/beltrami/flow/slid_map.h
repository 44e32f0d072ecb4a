#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/starts/sliding_start.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What iterations whose boundary slides end with: FlowMap, TMapSchemeResult.
struct SlidMap : MapResult {
    std::vector<LoopOnto> loops;  ///< in the order of the source's loops
};

/// @throw Error bad_option if the start is one of another source
void require_start_of(const Surface& source, const SlidingStart& start);

/// From the map and where its boundary is: distortion and loops. The start's factorisations are added.
void record_map(const Surface& source, const SlidingStart& start, const SlidingBoundary& boundary, SlidMap& result);

}  // namespace beltrami
