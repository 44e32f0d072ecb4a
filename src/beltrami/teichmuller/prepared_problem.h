#pragma once

#include <string>

#include <beltrami/constraints/constraints.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/teichmuller/extremal_options.h>

namespace beltrami {

/// A problem on a mesh that no prescription nails down.
struct PreparedProblem {
    std::optional<SplitProblem> split;  ///< none where nothing had to be split
    std::optional<Surface> surface;     ///< of split

    /// The surface to solve on.
    const Surface& surface_of(const Surface& source) const { return surface ? *surface : source; }
    /// What the result says about the split.
    /// @param kind of the vertices between which edges were split
    /// @pre split
    Warning split_warning(const char* kind) const;
};

/// The problem on a mesh that was split; the source's own where nothing had to be.
PreparedProblem prepared(SplitProblem split);

/// Examines an extremal problem with prescribed boundary values and splits it, where the options ask for it.
/// @throw Error bad_mesh, bad_boundary, bad_option as extremal_map
PreparedProblem prepare(const Surface& source, const Constraints& constraints, const ExtremalOptions& options);

}  // namespace beltrami
