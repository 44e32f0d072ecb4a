#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A smooth closed surface of genus 2, about 4 × 2.4 × 0.9 times @p scale: z² = ¼·E·C₁·C₂ with
/// E = 1 − (x/2)² − (y/1.2)² and C = 1 − (0.4/distance to the axis of a hole)², axes at x = ±0.85. Vertices lie on the
/// surface (to 1e-12·scale), normals point outwards, triangles are near equilateral.
/// @param edge_length mean edge length for scale 1, at most 0.25 (so that the holes stay open)
/// @throw Error bad_option for an impossible size
Mesh double_torus(double edge_length = 0.1, double scale = 1.0);

}  // namespace beltrami
