#pragma once

#include <Eigen/Core>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/differentials/zeros_and_poles.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What a page draws of a quadratic differential φ.
struct PageDifferential {
    /// #F direction of the horizontal trajectory (φ dz² > 0) in each face, counter-clockwise from its first edge, in
    /// radians from 0 to π; NaN where φ is 0 or not known.
    Eigen::VectorXd angles;
    std::vector<CriticalPoint> points;  ///< zeros and poles
};

/// @param phi          #S values of the differential at the samples, in their frames
/// @param differential the same, where its zeros and poles are looked for
/// @pre the surface has the metric of its mesh
PageDifferential page_differential(const Surface& surface, const Eigen::VectorXcd& phi,
                                   const QuadraticDifferential& differential);

}  // namespace beltrami
