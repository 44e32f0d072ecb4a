#pragma once

#include <complex>

namespace beltrami {

/// A point or vector of the plane.
using Complex = std::complex<double>;

}  // namespace beltrami
