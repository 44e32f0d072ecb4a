#pragma once

#include <memory>

#include <beltrami/differentials/differential_space.h>

namespace beltrami {

/// Whether a harmonic map stretches its source so much throughout that φ is, but for little, the square of a one-form
/// of it: a strip, a square sent to a long rectangle. φ then has poles at the rectangle's corners and |μ| is near 1,
/// which polynomials miss by far.
bool is_elongated(const Operators& operators, const Eigen::VectorXcd& harmonic);

/// Where |μ| of such a map is to be held: the largest of a face that the harmonic map does not turn over, with room for
/// the extremal map, at most .9999.
double clip_of_elongated(const Operators& operators, const Eigen::VectorXcd& harmonic);

/// {ω_u², ω_u ω_v, ω_v²}, ω = ∂ of the real and imaginary part of a harmonic map, holomorphic as far as the map is
/// harmonic, and polynomials of a low degree in the chart; known at the samples. The map's Hopf differential is among
/// them, and where boundary values are affine along the sides of a rectangle so is φ.
std::unique_ptr<DifferentialSpace> harmonic_square_space(const Surface& source, const Chart& chart,
                                                         const Eigen::VectorXcd& harmonic);

}  // namespace beltrami
