#pragma once

#include <limits>

#include <beltrami/certificate/pair_bound.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

struct RefinedPairOptions {
    double enough = std::numeric_limits<double>::infinity();  ///< a bound that need not be raised
    int most_faces = 20'000;                                  ///< of a mesh that is refined still
    int most_rounds = 10;
};

/// What pairs on refined meshes prove.
struct RefinedPair {
    double K = 1;  ///< K* ≥ this
    int faces = 0, rounds = 0, factorizations = 0;
};

/// The bound of pair_bound() on meshes of the same surface with the same boundary values, whose edges are halved where
/// finer functions would lower the energies of the pair most: at the vertices of a jagged rim, where its functions are
/// r^½, uniform refinement needs a multiple of the faces.
///
/// The gain is estimated edge by edge: a function that is 1 in the middle of an edge and linear on the faces' quarters
/// lowers the energy of v by (∫∇v·∇ψ)² / ∫|∇ψ|².
/// @param map #V a map with the boundary values, whose image's mesh is refined along; where it folds, the polygon is
///            triangulated anew (filled_image)
/// @pre a disk of triangles, its whole boundary prescribed
/// @throw Error not_solved
RefinedPair refined_pair_bound(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& map,
                               const RefinedPairOptions& options = {});

}  // namespace beltrami
