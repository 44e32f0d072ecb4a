#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/certificate/pair_bound.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Which of the bounds below to work out.
struct ProvedBoundsOptions {
    /// Faces up to which the pair bound and, on disks, the quadrilateral one are taken.
    int most_faces_for_pairs = 5000;
    PairBoundOptions pair;
    /// Whether the polygons themselves are the problem, however many vertices they have. Else what a single vertex of
    /// a loop of 24 or more proves is a bound of the polygons only: such a loop may be sampled from a smooth one.
    bool exact_polygons = false;
};

/// Bounds that are proofs up to rounding.
struct ProvedBounds {
    std::vector<Bound> bounds;  ///< rigorous ones, the best of each kind
    int corner_vertex = -1;     ///< of the bound "edge_corner"
    int factorizations = 0;

    /// The largest of K*; 1 if there is none.
    double K() const;
};

/// Lower bounds of the dilatation of every map with the boundary values, for the polyhedral surface and values that are
/// linear along edges:
/// - "edge_corner": edge_corner_bound.h, for nothing;
/// - "moduli": a disk onto a rectangle, four corners to four corners, and rings (modulus.h);
/// - "pair": pair_bound.h, also on the double cover branched at the pins of a disk. The image is meshed by
///   @p map where that folds nothing, else by a triangulation of its polygon. On surfaces with holes period_pair.h,
///   where the map folds nothing.
/// On surfaces with holes "edge_corner" and "moduli" hold for every homotopy class, "pair" for that of the map.
/// @param map #V a map with these boundary values, with folds or without
/// @pre the whole boundary is prescribed
ProvedBounds proved_bounds(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                           const ProvedBoundsOptions& options = {});

/// The same for a map from anywhere with its own boundary values, with what it attains: nothing else about it is used.
/// Bounds of the polygons count as bounds of K*.
/// @param map #V
/// @return also "attained", the largest K of a face, unless the map turns a face over
/// @throw Error bad_mesh unless the source is a disk; bad_boundary if the boundary's image is not a simple polygon that
///        runs counter-clockwise
ProvedBounds bounds_of_map(const Surface& source, const Eigen::VectorXcd& map);

}  // namespace beltrami
