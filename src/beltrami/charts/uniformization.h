#pragma once

#include <optional>

#include <beltrami/base/public.h>
#include <beltrami/charts/circle_domain_chart.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface on its canonical domain, normalised so that congruent domains are those of conformally equivalent surfaces
/// with loops in the same order.
struct Uniformization {
    Eigen::VectorXcd map;          ///< #V in the unit disk: rims on their circles to rounding
    std::vector<RoundHole> holes;  ///< one for every loop but the outer one: the one at the centre first, then in order
    /// The 3n − 3 moduli of n ≥ 2 holes, r₁, x₂, r₂, x₃, y₃, r₃, …; of one hole r₁; of a disk none.
    std::vector<double> moduli;
    /// Of a ring: log(1/r₁)/2π, the conformal module.
    std::optional<double> module;
    CircleDomainChart chart;  ///< before it was normalised: how it was found, and its warnings
};

/// The conformal map of a surface of genus 0 with a boundary to the round disk, or to the disk less round holes
/// (circle_domain_chart), after the Möbius map of the disk that makes it unique:
/// - a disk keeps its area centred at 0, and the first vertex of the loop goes to 1;
/// - with holes, that of loop @p centre goes to a circle around 0; the next one's centre lies on the positive real axis
///   then, or, where there is no other, the first vertex of the outer loop goes to 1.
/// @param centre of the loops but the outer one; nothing: the first
/// @throw Error bad_option if there is no such loop; bad_mesh unless there is one component of genus 0 with boundary;
///        not_solved as circle_domain_chart
Uniformization uniformization(const Surface& source, int outer_loop = 0, std::optional<int> centre = {});

/// The same from a circle domain at hand.
Uniformization uniformization(const Surface& source, CircleDomainChart chart, std::optional<int> centre = {});

}  // namespace beltrami
