#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/uniformize/flatten.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A flattening whose faces, drawn straight, are not flipped.
struct FoldFreeFlattening {
    Flattening flattening;      ///< its positions those without folds; flipped what is left
    std::vector<int> unfolded;  ///< faces that came out flipped, ascending
    bool kept_boundary = true;  ///< false: folds did not open with the boundary where it was
    bool fold_free = false;     ///< false only where rounding leaves no map without folds
    int factorizations = 0;     ///< of flattening and unfolding
};

/// flatten(), and where edges that were flipped on the way leave faces flipped, the nearest map without folds: opened
/// in patches around them, the boundary where it is; else as a whole with the boundary free, from there or from a map
/// onto a disk that has none (fold_free.h; scaled to the area of the flattening).
/// @pre, @throw as flatten
FoldFreeFlattening fold_free_flattening(const Surface& surface, const FlattenOptions& options = {});

}  // namespace beltrami
