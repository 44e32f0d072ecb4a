#pragma once

#include <array>
#include <memory>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Surfaces in space that are deformed by handles, before any map onto them is asked for. What is factorised depends on
/// the handles' vertices alone, so that moving them is cheap.
class HandledSurface {
  public:
    /// @param source  kept by reference
    /// @param handles vertices, at least one on every component
    HandledSurface(const Surface& source, std::vector<int> handles);
    ~HandledSurface();

    /// The thin plate: displacements that make Σ |Δu|² least, by the cotangent Laplacian.
    /// @param places #handles×3
    /// @return #V×3
    Positions thin_plate(const Positions& places) const;

    /// As rigid as possible (Sorkine, Alexa 2007), from a start: rotations of the vertices' surroundings and positions
    /// in turn. It creases where handles turn far.
    Positions as_rigid_as_possible(const Positions& places, Positions start, int iterations = 60) const;

    int factorization_count() const;

  private:
    struct Systems;
    std::unique_ptr<Systems> systems_;
    const Surface& source_;
    std::vector<int> handles_;
};

/// Edges at which faces of an image turn by more than a right angle that do not in the source, as pairs of vertices.
std::vector<std::array<int, 2>> fold_edges(const Surface& source, const Positions& image);

}  // namespace beltrami
