#pragma once

#include <vector>

#include <beltrami/targets/target_domain.h>

namespace beltrami {

/// A vertex of the source's boundary and the place on the target's boundary to which it is to go.
struct Mark {
    int vertex = 0;
    int curve = 0;         ///< of the target domain
    double parameter = 0;  ///< arc length on that curve
};

/// The mark that sends a vertex to the nearest point of the nearest curve (of equally near ones the first).
/// @throw Error bad_boundary if the point is not finite
Mark nearest_mark(const TargetDomain& domain, int vertex, Complex point);

/// @throw Error bad_option unless partners pairs every loop with a curve of its own; bad_boundary naming vertices that
///        are not on the boundary or marked twice, marks that are not on the partner of their loop, fall on one place
///        or follow each other along the curve in another order than along the loop
void validate(const std::vector<Mark>& marks, const Surface& source, const TargetDomain& domain,
              const std::vector<int>& partners);

}  // namespace beltrami
