#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/random.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami::bench {

/// Explicit homeomorphisms of the plane onto itself, all keeping orientation.
using PlaneMap = std::function<Complex(Complex)>;

/// Stretch by e^amount along a direction (radians) and e^−amount across.
PlaneMap affine_stretch(double amount, double direction);
/// c + (z−c)(|z−c|² + core²)^{(κ−1)/2}, κ > 0: the radii's power away from the core.
PlaneMap radial_power(Complex centre, double exponent, double core);
/// Radii r → r(1 + amount·exp(−r²/width²)) about a centre, −1 < amount < 2.2.
PlaneMap radial_swell(Complex centre, double amount, double width);
/// Turned by angle·exp(−r²/width²) about a centre.
PlaneMap twist(Complex centre, double angle, double width);
/// Turned as a whole within the inner radius, not at all beyond the outer one, smoothly in between.
PlaneMap rigid_turn(Complex centre, double angle, double inner, double outer);
/// Scaled as a whole within the inner radius, not at all beyond the outer one; inner·factor < outer.
PlaneMap rigid_scale(Complex centre, double factor, double inner, double outer);
/// Turned by ½ amount·log(r² + core²): a logarithmic spiral.
PlaneMap spiral(Complex centre, double amount, double core);
/// Every line in a direction slides along itself by amplitude·sin(frequency·d + phase), d its distance from 0.
PlaneMap shear_wave(double direction, double amplitude, double frequency, double phase);
/// The coordinate along a direction becomes x + amount·sin(frequency·x + phase)/frequency, |amount| < 1.
PlaneMap squeeze(double direction, double amount, double frequency, double phase);
/// The first, then the second, …
PlaneMap composition(std::vector<PlaneMap> steps);

/// A family of random homeomorphisms about the unit disk, the identity at strength 0, ever wilder beyond.
/// @param centres places about which some of the steps turn and stretch, besides random ones
std::function<PlaneMap(double strength)> random_homeomorphisms(Random& random, const std::vector<Complex>& centres);

}  // namespace beltrami::bench
