#pragma once

#include <beltrami/base/public.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A conformal map to a domain that the surface alone determines, to carry a grid from there.
struct ConformalCarrier : MapResult {
    TargetDomain domain{TargetCurve::circle(0, 1),
                        {}};            ///< the disk with round holes; of a ring, between circles of one centre
    std::optional<SplitProblem> split;  ///< the mesh that was mapped, if it is not the source itself
};

/// The circle domain of a surface whose bridges were split (circle_domain_chart.h). A warning says if its circles have
/// not settled.
/// @param outer_loop the boundary loop that goes to the outer circle
/// @throw Error bad_mesh, bad_boundary, not_solved
ConformalCarrier conformal_carrier(const Surface& source, int outer_loop = 0);

}  // namespace beltrami
