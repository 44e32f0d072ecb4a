#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/where.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What a warning is about.
enum class WarningKind {
    file,              ///< what a file holds could not all be taken as it stands
    mesh,              ///< the diagnosis of a mesh found something that does not prevent a map
    mended,            ///< the mesh was changed before anything else
    edges_split,       ///< edges between prescribed vertices were split
    chart,             ///< a conformal chart is not conformal at some faces, or flips them
    pinched_faces,     ///< a circle domain has no room for some faces
    differentials,     ///< the space of quadratic differentials is not told clearly, or has another dimension
    constraints,       ///< constraints that φ cannot follow in full
    pieces,            ///< pinned curves cut the surface, but it is solved as one
    start,             ///< another start than what was asked for or usual
    fallback,          ///< another method than the one asked for has found the map
    unfolded,          ///< vertices were moved to turn flipped faces up
    turned_in,         ///< quads turn in at a corner, or nearly collapse, on the sphere
    unresolved_faces,  ///< faces are so small in the map that doubles do not resolve them
    off_centre,        ///< nearly half of a closed surface comes to one point of the sphere
    flipped_faces,     ///< the result is not one-to-one
    degenerate_faces,  ///< the result has faces that collapse
    branch_points,     ///< the result winds more than once around a vertex
    fold_forced,       ///< what is prescribed admits no map without folds, or may not
    iteration_limit,   ///< stopped before it settled
    corner,            ///< at a corner the boundary values alone force a larger K
    below_bound,       ///< more is proved of K* than the iteration found
    rough,             ///< the map is far from constant dilatation
    coefficient,       ///< no map of the kind has the prescribed coefficient
    free_boundary,     ///< parts of the boundary are free
    marks,             ///< a mark is far from its curve
    collapsed_loop,    ///< a boundary loop collapses
    distance,          ///< a distance is an estimate
    comparison,        ///< a method is not in a comparison
    hint,              ///< what may help
};
const char* to_string(WarningKind kind);

/// What should be known of a result that was reached all the same.
struct Warning {
    WarningKind kind;
    std::string sentence;  ///< plain words, without a final full stop
    Where where = {};      ///< places, as far as there are any

    friend bool operator==(const Warning&, const Warning&) = default;
};

using Warnings = std::vector<Warning>;

/// The warning with a name before its sentence: "name: sentence".
Warning prefixed(const std::string& name, Warning warning);

/// Appends @p more.
void append(Warnings& warnings, const Warnings& more);

/// The sentences alone.
std::vector<std::string> sentences(const Warnings& warnings);

}  // namespace beltrami
