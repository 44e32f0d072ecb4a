#pragma once

#include <complex>

namespace beltrami::bench {

/// Carlson's symmetric integral R_F(x, y, z) by duplication (Carlson 1995, Numerical Algorithms 10), for arguments off
/// the negative real axis, at most one of them 0.
std::complex<double> carlson_rf(std::complex<double> x, std::complex<double> y, std::complex<double> z);

/// Complete elliptic integral K(m), m the modulus, 0 ≤ m < 1.
double complete_elliptic(double m);

/// The conformal map of the unit disk to a rectangle that takes the points at the angles ±phi, π ± phi to its corners,
/// 0 < phi < π/2: centred at 0, 2K(m) high and K′(m) wide, m = tan²(phi/2). Angle 0 lies in the middle of the right
/// side.
class DiskRectangle {
  public:
    explicit DiskRectangle(double phi);
    double width() const { return width_; }
    double height() const { return height_; }
    std::complex<double> to_rectangle(std::complex<double> z) const;  ///< |z| ≤ 1
    std::complex<double> to_disk(std::complex<double> w) const;       ///< w in the rectangle

  private:
    double scale_ = 0, modulus_ = 0, width_ = 0, height_ = 0;
};

}  // namespace beltrami::bench
