#include <beltrami/teichmuller/least_dilatation.h>

#include <algorithm>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

std::vector<int> free_parts(const Surface& source, const BoundaryCondition& boundary) {
    if (boundary.vertices.size() < 2) return {};
    std::vector<char> prescribed(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : boundary.vertices) prescribed[v] = 1;
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        if (std::none_of(loop.begin(), loop.end(), [&](int v) { return prescribed[v]; })) return {};
    return unprescribed_boundary(boundary, source);
}

bool takes_least_maximum(const Surface& source, const Constraints& constraints, Least what) {
    return what == Least::maximum ||
           (constraints.all_prescribed() && !free_parts(source, constraints.prescribed).empty());
}

LeastDilatationMap least_dilatation_map(const Surface& source, const Constraints& constraints,
                                        const LeastDilatationOptions& options) {
    validate(constraints.prescribed, source);
    LeastDilatationMap result;
    if (!takes_least_maximum(source, constraints, options.what)) {
        result.extremal = extremal_map(source, constraints, options.extremal);
        return result;
    }
    const std::vector<int> free = free_parts(source, constraints.prescribed);
    if (!free.empty() && options.maximum.extremal.start)
        throw Error(Cause::bad_boundary,
                    std::to_string(free.size()) +
                        " boundary vertices are free: the map of least maximum has starts of its own then",
                    "prescribe the whole boundary, or give no start", {Things::vertices, free});
    result.maximum = least_maximum_map(source, constraints, options.maximum);
    if (!free.empty() && options.what == Least::dilatation)
        result.maximum->warnings.insert(
            result.maximum->warnings.begin(),
            {WarningKind::free_boundary,
             std::to_string(free.size()) +
                 " boundary vertices are free: no map attains the least K of the shape then, which is 1; this is the "
                 "map whose largest |mu| on this mesh is least",
             {Things::vertices, free}});
    return result;
}

}  // namespace beltrami
