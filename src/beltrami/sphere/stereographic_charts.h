#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map to the unit sphere as texture coordinates: a pair of stereographic charts side by side. The faces whose middle
/// lies north of the equator are projected from the south pole, to about the unit disk around 0; the others from the
/// north pole, mirrored so that faces run counter-clockwise there too, to the right of it. Conformal, no face is torn;
/// a vertex between faces of both has a point in each.
/// @param points #V×3 unit vectors
TextureCoordinates stereographic_charts(const FaceList& faces, const Positions& points);

}  // namespace beltrami
