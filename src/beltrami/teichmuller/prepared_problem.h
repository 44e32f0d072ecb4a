#pragma once

#include <beltrami/maps/prescribed_split.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// An extremal problem on a mesh that no prescription nails down.
struct PreparedProblem {
    std::optional<SplitProblem> split;  ///< none where nothing had to be split
    std::optional<Surface> surface;     ///< of split

    /// Vertices that the split has added.
    int added() const { return split ? static_cast<int>(split->parents.size()) : 0; }
};

/// Examines an extremal problem and splits what prescribed vertices nail down, where the options ask for it.
/// @throw Error bad_mesh, bad_boundary, bad_option as extremal_map
PreparedProblem prepare(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options);

}  // namespace beltrami
