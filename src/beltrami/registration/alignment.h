#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How a surface is brought near another one before their points are compared.
enum class Alignment {
    none,        ///< it lies as it lies
    rigid,       ///< rotated and moved
    similarity,  ///< scaled to the same area first
};

/// The vertices of a mesh after the rotation that brings it nearest to another one: iterated closest points (Besl,
/// McKay 1992) from the position that it has, centred, and from those in which the principal axes agree; of these the
/// one whose points end nearest, the position that it has unless another is clearly better.
/// @return #V×3
/// @throw Error bad_mesh where a mesh has no faces
Positions aligned(const Mesh& source, const Mesh& target, Alignment how);

}  // namespace beltrami
