#pragma once

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/plane/circle_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A Möbius map of the unit disk to itself, z ↦ e^{iα} (z − a)/(1 − āz): the isometries of the hyperbolic plane that
/// keep its orientation.
struct DiskMoebius {
    double rotation = 0;  ///< α, −π < α ≤ π
    Complex centre = 0;   ///< a, |a| < 1: what goes to 0

    Complex operator()(Complex z) const;
    Eigen::VectorXcd operator()(const Eigen::VectorXcd& places) const;
    /// The image of a circle within the disk is a circle.
    RoundHole operator()(const RoundHole& hole) const;
};

/// The centre and the radius of a circle in the hyperbolic plane, whose metric is 2|dz|/(1 − |z|²).
/// @pre the circle lies within the unit disk
struct HyperbolicCircle {
    Complex centre;
    double radius;
};
HyperbolicCircle hyperbolic_circle(const RoundHole& hole);

/// sinh² of half the hyperbolic distance, |z − w|²/((1 − |z|²)(1 − |w|²)): a quarter of its square, where that is
/// small.
double hyperbolic_gap(Complex z, Complex w);

/// The map that takes a circle to one around 0.
DiskMoebius centring(const RoundHole& hole);

}  // namespace beltrami
