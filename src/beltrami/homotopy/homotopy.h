#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The path of edges along which the turns of a hole are counted: from a vertex of the outer loop to one of the hole's.
struct LoopPath {
    int loop = 0;               ///< of topology.boundary_loops
    std::vector<int> vertices;  ///< first on the outer loop, last on the hole's
};

/// The paths of all holes. The end vertices are the nearest pair of outer loop and hole that see each other past the
/// other holes (of equally near ones the smallest vertex of the hole), the path between them keeps close to their
/// straight line and meets no other boundary vertex where the mesh allows that. In a concentric annulus it is radial.
/// Where no pair sees each other it is the shortest path of edges.
/// @param positions  #V places in the plane, where no face is flipped: a chart's, or the mesh's own
/// @param outer_loop the loop around all others, as a rule 0
/// @return one per loop other than the outer one, ascending
/// @throw Error bad_option if outer_loop does not exist; bad_mesh if a hole is on another component
std::vector<LoopPath> loop_paths(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop);

/// How a map turns the outer loop against a hole.
///
/// Prescribed boundary values leave an integer per hole. With p_0 … p_m the path and c a point inside the image of the
/// hole's loop, the angle Σ arg((f(p_{i+1}) − c)/(f(p_i) − c)) is α + 2π · turns, with α ∈ (−π, π] the one that the
/// images of p_0 and p_m fix: whole counter-clockwise turns on the way from the outer loop to the hole beyond the
/// smallest angle.
struct HoleTurns {
    int loop = 0;
    int turns = 0;
    double angle = 0;  ///< the whole sum, radians
    int outer_vertex = -1, hole_vertex = -1;
    /// No face at the path is flipped or collapsed. Else the sum is a number without meaning: near folds a path can
    /// pass on either side of the hole's image.
    bool meaningful = false;
};

/// The homotopy class of a map relative to its boundary values, up to the braid of the holes around each other.
struct HomotopyClass {
    int outer_loop = 0;
    std::vector<HoleTurns> holes;  ///< one per loop other than the outer one, ascending

    /// Whether both have the same turns at the same holes, all of them meaningful.
    bool same_turns(const HomotopyClass& other) const;
};

/// @param positions #V as for loop_paths
/// @param map       #V images
/// @pre genus 0
/// @throw as loop_paths; also Error bad_mesh unless the surface has genus 0
HomotopyClass homotopy_class(const Surface& source, const Eigen::VectorXcd& positions, const Eigen::VectorXcd& map,
                             int outer_loop = 0);

/// The same along paths found before, for maps that are looked at often.
HomotopyClass homotopy_class(const Surface& source, const std::vector<LoopPath>& paths, const Eigen::VectorXcd& map,
                             int outer_loop = 0);

/// The angle in (−π, π] that the end points of a path fix, seen from @p centre. −π up to rounding counts as π.
double smallest_angle(Complex from, Complex to, Complex centre);

/// The images of a loop.
std::vector<Complex> loop_images(const std::vector<int>& loop, const Eigen::VectorXcd& map);

}  // namespace beltrami
