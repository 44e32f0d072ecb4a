#pragma once

#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>

namespace beltrami {

/// What a map attains.
struct AttainedDilatation {
    double K;       ///< infinite where faces are flipped
    bool rigorous;  ///< no point of the map has more; else more is possible between the points looked at
};

/// The largest dilatation of a map's faces. On triangles it is constant. On quads of a surface in the plane surface and
/// map are bilinear, and so are, of the map f∘x⁻¹ with x_ξ, x_η, f_ξ, f_η the sides' derivatives,
///
///     p = x_ξ f_η − x_η f_ξ,   q = f_ξ conj(x_η) − f_η conj(x_ξ),   |μ| = |p|/|q|:
///
/// the Bernstein coefficients of |p|² − k²|q|² bound k, with subdivision until that is within .1 % of what is attained.
/// Quads in space, and quads of which some point turns over, are looked at in their Gauss points and corners alone.
/// @param map      #V
/// @param measured distortion(source.operators, map)
AttainedDilatation attained_dilatation(const Surface& source, const Eigen::VectorXcd& map, const Distortion& measured);

}  // namespace beltrami
