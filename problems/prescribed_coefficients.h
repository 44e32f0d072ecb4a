#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami::bench {

/// Maps with known coefficients, and the meshes of Wong & Zhao 2014.

/// The square of corners 1, i, −1, −i around 0 in four triangles, split into four @p levels times, new boundary
/// vertices on the unit circle: 4·4^levels triangles; 0 and 1 are the vertices 0 and 1.
Mesh disk_of_square(int levels);

/// The map of the unit disk onto itself with the coefficient kz that keeps 0 and 1: ζ = z e^{k z̄} has it, and ζ
/// e^{h(ζ)} has its image of the circle on a circle for the right holomorphic h, here a polynomial.
class DiskStretch {
  public:
    /// @param k real, |k| < 1
    explicit DiskStretch(double k);
    Complex operator()(Complex z) const;
    /// Largest distance of the circle's image from the circle.
    double residual() const { return residual_; }

  private:
    std::vector<Complex> values(Complex zeta) const;
    Complex onto_circle(Complex z) const;

    double k_, radius_ = 1, residual_ = 0;
    std::vector<std::vector<Complex>> recurrence_;  ///< of the polynomials that are orthogonal on the curve
    std::vector<Complex> coefficients_;
    Complex one_ = 1;
};

/// z ↦ (z + μz̄)/(1 + μ) in the stereographic coordinate from the south pole: the map of the sphere with the constant
/// coefficient μ there that keeps 0, 1, ∞. #V×3 images.
Positions stretched_sphere(const Positions& points, Complex mu);

}  // namespace beltrami::bench
