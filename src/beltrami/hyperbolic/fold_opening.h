#pragma once

#include <beltrami/hyperbolic/equivariant_map.h>

namespace beltrami {

/// Moves the images of the corners of flipped faces, one after the other, to where the faces around them are not
/// flipped: where an outline has teeth, or edges are far longer than others beside them, a harmonic map may flip a few,
/// and so may its discretisation. A vertex goes towards the place that is as far as can be from the lines of the edges
/// around it, as far as the worst face there becomes best; boundary vertices along the boundary. All else stays, and so
/// do vertices of more than 24 faces.
/// @param source of triangles
/// @return how many vertices were moved
int open_folds(const Surface& source, EquivariantMap& map);

}  // namespace beltrami
