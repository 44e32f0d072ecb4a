#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/homotopy/homotopy.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The ring r ≤ |z − centre| ≤ ρ around a hole, free of all other loops; the hole itself lies in |z − centre| ≤ r.
struct HoleRing {
    int loop = 0;
    Complex centre;
    double inner = 0;  ///< r
    double outer = 0;  ///< ρ: empty unless r < ρ
};

/// The widest ring around the centre of a hole.
/// @param positions #V places in the plane, as for loop_paths
HoleRing hole_ring(const Surface& source, const Eigen::VectorXcd& positions, int loop);

/// A map with the boundary values of @p map and other turns: map ∘ T, with T the product of Dehn twists around the
/// holes, T(z) = c + (z − c) e^{2πi n s}, s = log(ρ/|z − c|)/log(ρ/r) in the hole's ring (even shear there), 0 outside
/// and 1 inside it. A twist around one hole leaves the turns of the others as they are. Works for folded maps too,
/// whose turns have no meaning before or after.
/// @param positions   #V places in the plane, as for loop_paths; rings are round, so circle domains suit best
/// @param map         #V images
/// @param extra_turns one number per boundary loop, that of the outer loop is not used
/// @throw Error bad_option for the wrong number of turns; bad_mesh naming a hole with turns that has no free ring;
///        not_solved naming a hole around which the mesh is too coarse to hold the turns (see loop_paths)
Eigen::VectorXcd twisted_map(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                             const Eigen::VectorXcd& map, const std::vector<int>& extra_turns);

/// The map of a ring-like surface that is harmonic in the logarithm, with any turns, without a first map:
/// f = c + (z − z_c) e^H with H harmonic in the surface's metric, c a point inside the image of the hole, z_c inside
/// the hole. Between concentric circles run through evenly it is the extremal map itself, z|z|^{κ−1}e^{is log|z|}.
/// @param positions #V as for loop_paths; only arg(z − z_c) along edges and its harmonicity matter
/// @param boundary  the whole boundary
/// @param turns     wanted turns of the hole (homotopy.h)
/// @pre two boundary loops
/// @throw Error bad_boundary if loops are not wholly prescribed, or their images do not run once around c
Eigen::VectorXcd logarithmic_map(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                                 const BoundaryCondition& boundary, int turns);

/// A start in a wanted class.
struct StartInClass {
    Eigen::VectorXcd map;    ///< #V
    HomotopyClass homotopy;  ///< of map; its turns are those wanted
    int repaired = 0;        ///< flipped faces of the harmonic map that had to be opened before its turns could be read
};

/// A start with the wanted turns at every hole. On a ring logarithmic_map (the harmonic map where that has the turns
/// and fewer folds): a harmonic map folds where the hole grows and is squeezed without bound where it shrinks. With
/// more holes the harmonic map where it has the turns, else its folds are removed (fold_free.h) and twisted_map
/// applied.
/// @param turns one number per boundary loop, that of the outer loop is not used; empty: none anywhere
/// @throw as the above; also not_solved if the folds of the harmonic map do not open
StartInClass start_in_class(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                            const BoundaryCondition& boundary, const std::vector<int>& turns);

}  // namespace beltrami
