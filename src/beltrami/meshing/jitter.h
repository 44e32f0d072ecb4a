#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Random displacement of the vertices of a generated planar mesh.
struct JitterOptions {
    double amplitude = 0.0;  ///< largest displacement, in mean edge lengths at the vertex; 0 = regular, at most 0.5
    std::uint64_t seed = 1;
    /// @throw Error bad_option if the amplitude lies outside 0 … 0.5
    void validate() const;
};

/// Moves every interior vertex into a random place of a disk around it, and boundary vertices along their curve. Where
/// a face would keep less than a tenth of its area, the displacements of its vertices are halved until it does not, so
/// no face ever flips. The same seed gives the same mesh everywhere.
/// @param project takes a boundary vertex and a place near it to the place on its curve; empty: boundary vertices stay
/// @param keep    #V flags of vertices that stay; empty: none
/// @pre planar mesh, counter-clockwise
Mesh jittered(Mesh mesh, const JitterOptions& options,
              const std::function<Eigen::Vector2d(int vertex, const Eigen::Vector2d& p)>& project = {},
              const std::vector<char>& keep = {});

}  // namespace beltrami
