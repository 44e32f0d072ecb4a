#pragma once

#include <optional>

#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/forms/period_matrix.h>

namespace beltrami {

/// The quadratic differentials of a closed surface of genus 2 as products ω_i ω_j of its two holomorphic 1-forms, which
/// span them. Where dz² of a flat metric is a square it is exact.
/// @param source of triangles
/// @return 3 functions, orthonormal in L² of the surface, complex coefficients; nothing for other genera, and where the
///         products are too alike
std::optional<TabulatedSpace> holomorphic_products(const Surface& source, const PeriodMatrix& periods);

}  // namespace beltrami
