#pragma once

#include <optional>
#include <vector>

#include <beltrami/certificate/sharpened_bound.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

/// What the Reich-Strebel integrals say about a map and its φ: the numbers of the record.
struct SolutionBounds {
    double k = 0, K = 1;        ///< the best estimate there is
    double K_lower = 1;         ///< the largest bound; 1 if there is none
    std::vector<Bound> bounds;  ///< reich_strebel, reich_strebel_estimate, averaged_estimate; the best of each kind
    int factorizations = 0;
};

/// A map with the φ and k of its c-step.
struct Solution {
    const Surface& source;
    const BoundaryCondition& boundary;
    const Chart& chart;
    const DifferentialSpace& space;
    const Eigen::VectorXcd& coefficients;  ///< of φ
    const Eigen::VectorXcd& phi;           ///< #S
    double k;
    const Eigen::VectorXcd& map;  ///< #V
    const Distortion& distortion;
    const ReichStrebel& integrals;       ///< of map and φ
    const std::vector<LoopPath>& paths;  ///< of holes; empty without any
    int outer_loop = 0;
    /// Wanted turns of every loop, as in ExtremalOptions; empty: those of map.
    const std::vector<int>& turns;
};

/// Bounds and estimates, K_lower ≤ K ≤ K_max. The estimate is the best that can be had, in this order:
/// - √(I⁺/I⁻) of the sharpened bound's map,
/// - from k = .8 on 1/I⁻ of the averaged coefficient,
/// - √(I⁺/I⁻) of the map itself,
/// - (1+k)/(1−k).
/// A sharpened bound counts only where its map has the same turns; where the turns of map mean nothing and none are
/// given, it is called not rigorous. Between two holes and more it belongs to the braid of its own map.
/// @param subdivisions of the mesh for sharpened_bound; empty: 0 from k = .8 on or where the bracket is wider
///                     than 1 %, else no sharpened bound;
///                     negative: none
SolutionBounds solution_bounds(const Solution& solution, std::optional<int> subdivisions);

}  // namespace beltrami
