#pragma once

#include <array>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// What a map of a closed surface to the sphere must not turn over: every triangle, and every quad at each corner that
/// is not reflex in the source; or, less strictly, the two triangles that stand for a quad (split_quad). Triangles of
/// the image are geodesic.
class SphereFaces {
  public:
    /// @param source kept by reference
    explicit SphereFaces(const Surface& source);

    /// Whether the face keeps its orientation in the map (#V×3 unit vectors).
    bool upright(int face, const Positions& points) const;
    /// Faces that do not, ascending.
    std::vector<int> flipped(const Positions& points) const;
    /// Whether every face does as triangles: quads may turn in.
    bool upright_as_triangles(const Positions& points) const;

  private:
    /// Of a quad.
    struct Quad {
        std::array<char, 4> reflex;
        std::array<std::array<int, 3>, 2> triangles;
    };
    const Surface& source_;
    std::vector<Quad> quads_;  // #F; empty if there are none
};

}  // namespace beltrami
