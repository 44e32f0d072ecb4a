#pragma once

#include <span>
#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// A surface whose faces around some vertices are finer, and maps of it to the unit sphere.
struct AroundLandmarks {
    Surface surface;              ///< the old vertices first
    std::vector<Positions> maps;  ///< #V×3 unit vectors, the new vertices halfway between the old ones
};

/// How often edges are halved around landmarks, and how far: rings of faces beyond those at the landmarks.
struct Fineness {
    int halvings, rings;
};

/// Halves the edges of the faces at the given vertices and of rings around those, and does it again there. φ has a pole
/// at a landmark, μ turns around it, and a few faces cannot follow: what they lose is most of the error of k.
/// @param maps of the surface to the unit sphere; where no face is flipped none is flipped afterwards
/// @pre all faces are triangles
AroundLandmarks refined_around(const Surface& source, std::span<const int> landmarks, std::vector<Positions> maps,
                               Fineness fineness);

/// The same with all edges halved, once.
AroundLandmarks refined_everywhere(const Surface& source, std::vector<Positions> maps);

}  // namespace beltrami
