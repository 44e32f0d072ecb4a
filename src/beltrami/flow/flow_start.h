#pragma once

#include <beltrami/base/public.h>
#include <beltrami/starts/sliding_start.h>

namespace beltrami BELTRAMI_PUBLIC {

class Shape;

struct FlowStartOptions {
    double target_edge_length = 0;  ///< of the mesh of a target that is not round; 0: that of the source, relatively
    std::vector<double> start_turns = {};   ///< see sliding_start
    std::vector<const Shape*> shapes = {};  ///< surfaces whose charts are kept; the source is asked for its own
};

/// A start for flows onto a domain, as extremal_map finds it: the loops matched and the harmonic map, or one led along
/// a way (sliding_start.h). Marked vertices are held; without two holes so are as many others as conformal maps leave
/// free.
/// @throw Error bad_mesh (one component of genus 0 with a boundary), bad_boundary, bad_option, not_solved
SlidingStart flow_start(const Surface& source, const TargetDomain& target, const Correspondence& wanted = {},
                        const FlowStartOptions& options = {});

/// A given map as a start: every loop goes to the curve that its vertices are nearest to, they to the nearest points.
/// @param map  #V in the target's plane
/// @param held vertices of the boundary that keep their places; see above for more
/// @throw Error bad_mesh, bad_option (sizes, numbers that are not finite), bad_boundary: two loops on one curve, held
///        vertices inside
SlidingStart flow_start(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& map,
                        const std::vector<int>& held = {});

}  // namespace beltrami
