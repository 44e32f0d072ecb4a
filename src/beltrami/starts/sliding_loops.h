#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/solve/sliding_boundary.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A boundary loop and what became of it.
struct LoopOnto {
    int loop = 0;                    ///< of the source's boundary loops
    int curve = 0;                   ///< of the target
    std::vector<double> parameters;  ///< arc length on the curve of every vertex of the loop, ascending
    double area_ratio = 0;  ///< area within the image polygon over that within the curve: near 1 if it runs around once
};

/// What became of the loops.
/// @param curves of every loop of the source
std::vector<LoopOnto> loops_onto(const Surface& source, const SlidingBoundary& boundary, const std::vector<int>& curves,
                                 const Eigen::VectorXcd& map);

/// @throw Error not_solved if the image of a loop encloses less than half of what its vertices could on the curve: it
/// has collapsed
void require_not_collapsed(const std::vector<LoopOnto>& loops);

}  // namespace beltrami
