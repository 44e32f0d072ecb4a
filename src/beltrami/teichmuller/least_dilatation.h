#pragma once

#include <optional>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/least_maximum.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Boundary vertices that are free where every loop has some that are prescribed, two in all at least, else none: a
/// loop of which nothing is said has been forgotten, or is meant to be free as a whole.
std::vector<int> free_parts(const Surface& source, const BoundaryCondition& boundary);

/// What is to be least of a map.
enum class Least {
    dilatation,  ///< K, of the smooth problem
    maximum,     ///< |μ| of the faces of this mesh
};

struct LeastDilatationOptions {
    Least what = Least::dilatation;
    ExtremalOptions extremal;     ///< of the extremal map, where that is the result
    LeastMaximumOptions maximum;  ///< of the map of least maximum, where that is
};

/// One of the two.
struct LeastDilatationMap {
    std::optional<ExtremalMap> extremal;
    std::optional<LeastMaximumMap> maximum;
};

/// Whether least_dilatation_map() returns the map of least maximum: that is asked for, or parts of the boundary are
/// free.
bool takes_least_maximum(const Surface& source, const Constraints& constraints, Least what);

/// The map of least dilatation: the extremal map, or, where parts of the boundary are free, the map of least maximum,
/// for there no map attains the least K of the shape, which is 1. A warning (free_boundary) says so, unless that map is
/// asked for.
/// @throw Error as extremal_map and least_maximum_map; bad_boundary where a loop has no prescribed vertex and the least
///        dilatation is asked for, or where parts are free and a start is given
LeastDilatationMap least_dilatation_map(const Surface& source, const Constraints& constraints,
                                        const LeastDilatationOptions& options = {});

}  // namespace beltrami
