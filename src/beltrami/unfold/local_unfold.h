#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// A map whose folds were opened where they are.
struct LocalUnfolding {
    Eigen::VectorXcd map;  ///< #V
    bool fold_free = false;
    std::vector<int> unfolded;  ///< faces that were flipped, ascending
    int factorizations = 0;
};

/// Opens the folds of a map in patches around them, a few rings and then more, by fold_free_map for the coefficient 0,
/// and leaves the rest as it is. A patch is taken in its own scale, so that folds open in parts that a conformal map
/// crowds to 1e-10 of the whole, where an energy of the whole sees nothing.
/// @param freedoms #V, free or fixed
LocalUnfolding unfold_locally(const Surface& source, const std::vector<Freedom>& freedoms, Eigen::VectorXcd map);

}  // namespace beltrami
