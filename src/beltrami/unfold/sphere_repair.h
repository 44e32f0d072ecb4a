#pragma once

#include <span>
#include <vector>

#include <beltrami/unfold/sphere_faces.h>

namespace beltrami {

/// What was done about flipped faces of a map to the sphere.
struct SphereRepair {
    std::vector<int> flipped;  ///< faces that are left, ascending
    int averaged = 0;          ///< vertices of patches put at means of their neighbours, patch by patch
    int unfolded = 0;          ///< vertices of patches where folds were opened, likewise
};

/// Turns flipped faces of a map to the sphere up again, moving no more vertices than it has to: those of the flipped
/// faces and rings around them, patch by patch in the gnomonic chart at the patch' middle, where geodesics are
/// straight. First each vertex goes to the mean of its neighbours with the source's mean value weights (Floater 2003),
/// in patches of 1 to 8 rings; what then is left, on coarse meshes, to the fold-free map of least distortion
/// (fold_free.h), every face measured in units of its own size in the image; and what is left of that, in limbs too
/// thin for double precision, to the plain mean of its neighbours (Tutte 1963) in patches of up to 32 rings, which
/// spreads vertices more evenly. Patches that leave a hemisphere are passed over.
/// @param points #V×3 unit vectors; changed
/// @param held   vertices that stay
SphereRepair repair_sphere_map(const Surface& source, const SphereFaces& faces, Positions& points,
                               std::span<const int> held = {});

}  // namespace beltrami
