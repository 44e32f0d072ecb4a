#include <beltrami/teichmuller/extremal_map.h>

#include <beltrami/teichmuller/extremal_solver.h>

namespace beltrami {

namespace {

/// By so much a corner's bound must exceed K.
constexpr double kCornerMargin = 0.01;

}  // namespace

bool corner_decides(const BoundaryCorner& corner, double K) {
    return corner.safe_bound > (1 + kCornerMargin) * K;
}

Warning corner_warning(const BoundaryCorner& corner) {
    return {
        WarningKind::corner,
        "at vertex " + std::to_string(corner.vertex) + " the boundary values alone force K ≥ " +
            std::to_string(corner.safe_bound) +
            ": the extremal map is not of Teichmüller type; gentler speed there or other boundary values would lower K",
        {Things::vertices, {corner.vertex}}};
}

ExtremalMap extremal_map(const Mesh& source, const Constraints& constraints, const ExtremalOptions& options) {
    return extremal_map(Surface(source), constraints, options);
}

ExtremalMap extremal_map(const Surface& source, const Constraints& constraints, const ExtremalOptions& options) {
    return ExtremalSolver(source, constraints, options).solve();
}

}  // namespace beltrami
