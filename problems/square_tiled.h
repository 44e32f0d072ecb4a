#pragma once

#include <array>
#include <map>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami::bench {

/// A side of a square: 0 bottom, 1 right, 2 top, 3 left, each run counter-clockwise.
using Side = std::array<int, 2>;  // square, side

/// Closed surfaces of unit squares, sides glued in pairs by translations or half-turns: with its flat metric dz² is a
/// holomorphic quadratic differential, so affine maps z + μ z̄ to sheared ones are extremal with k = |μ|, exactly.
struct SquareTiling {
    int squares;
    std::map<Side, Side> gluing;  ///< both ways; the start of one side meets the end of the other
};

/// Three squares, one corner of angle 6π: genus 2, glued by translations.
SquareTiling l_shaped();
/// @param angles sorted angles of the corners in units of π/2, each at least 4; the first such tiling, not by
///               translations alone, of a sequence of pseudo-random ones
SquareTiling half_translation(int squares, const std::vector<int>& angles);

/// A tiling in triangles, k × k cells a square, and where its vertices are.
struct TiledSurface {
    Surface surface;
    std::map<std::array<int, 3>, int> vertices;  ///< of square, i, j
    int cells;

    int vertex(int square, int i, int j) const { return vertices.at({square, i, j}); }
};

/// @param mu     of the metric |dz + μ dz̄|
/// @param jitter of inner vertices, as part of a cell; not 0: diagonals at random too
TiledSurface tiled_surface(const SquareTiling& tiling, int cells, Complex mu = 0, double jitter = 0);

/// The vertices of one surface nearest to where those of another of the same tiling are in their squares.
std::vector<int> same_places(const TiledSurface& from, const TiledSurface& to);

}  // namespace beltrami::bench
