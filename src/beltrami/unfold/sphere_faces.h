#pragma once

#include <array>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// What a map of a closed surface to the sphere must not turn over: every triangle, and every quad at each corner that
/// is not reflex in the source. Triangles of the image are geodesic.
class SphereFaces {
  public:
    /// @param source kept by reference
    explicit SphereFaces(const Surface& source);

    /// Whether the face keeps its orientation in the map (#V×3 unit vectors).
    bool upright(int face, const Positions& points) const;
    /// Faces that do not, ascending.
    std::vector<int> flipped(const Positions& points) const;

  private:
    const Surface& source_;
    std::vector<std::array<char, 4>> reflex_;  // #F, of quads; empty if there are none
};

}  // namespace beltrami
