#include <beltrami/constraints/constraints.h>

#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

void validate(const Constraints& constraints, const Surface& source) {
    const Correspondence& wanted = constraints.correspondence;
    const std::size_t loops = source.topology.boundary_loops.size();
    if (wanted.outer_loop < 0 || static_cast<std::size_t>(wanted.outer_loop) >= loops)
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(wanted.outer_loop) +
                                           ": the source has " + std::to_string(loops));
    if (!wanted.turns.empty() && wanted.waypoints)
        throw Error(Cause::bad_option, "turns are given besides waypoints, which fix them", "give one of them");
    if (!wanted.turns.empty() && wanted.turns.size() != loops)
        throw Error(Cause::bad_option,
                    "turns are given for " + std::to_string(wanted.turns.size()) + " boundary loops, the surface has " +
                        std::to_string(loops),
                    "give one number per loop, 0 for the outer one");
    for (const Mark& mark : wanted.marks) {
        if (constraints.domain() && std::holds_alternative<TargetVertex>(mark.to))
            throw Error(Cause::bad_option, "marks by vertices of the target are given for a target that has none",
                        "give places on its curves instead", {Things::vertices, {mark.vertex}});
        if (constraints.surface() && std::holds_alternative<CurveParameter>(mark.to))
            throw Error(Cause::bad_option, "marks on curves are given for a target that is a surface",
                        "give pairs of vertices instead", {Things::vertices, {mark.vertex}});
        if (mark.vertex < 0 || mark.vertex >= source.mesh.vertex_count() || !source.topology.on_boundary[mark.vertex])
            throw Error(Cause::bad_boundary,
                        "the marked vertex " + std::to_string(mark.vertex) + " is not on the boundary of the source",
                        "mark boundary vertices only", {Things::vertices, {mark.vertex}});
    }
}

}  // namespace beltrami
