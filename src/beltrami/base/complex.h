#pragma once

#include <complex>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A point or vector of the plane.
using Complex = std::complex<double>;

}  // namespace beltrami
