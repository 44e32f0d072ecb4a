#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A boundary loop whose vertices lie on a curve and slide along it, but for those that are held.
struct SlidingLoop {
    int loop = 0;       ///< of topology.boundary_loops
    TargetCurve curve;  ///< runs as the loop does: the image is on its left
    /// Arc length of every vertex of the loop, in its order: ascending, the last less than length() above the first.
    std::vector<double> parameters;
    std::vector<char> held;  ///< 1 for vertices that stay where they are: marks, arcs that are prescribed

    /// Arc length from one vertex to the next, counted on beyond the loop's end.
    double increment(int i) const;
};

/// Boundary vertices that slide along curves, in steps that keep their order: what a linear solve may do with them, and
/// how they move along the true curves. Other loops, arcs and inner vertices may be prescribed beside them.
///
/// Without a safeguard the vertices of a loop can all run to one arc, which is then left with winding number 0: the
/// energy looks excellent, the map is none. So the increments of the parameters between neighbours stay positive in
/// every step: none shrinks to less than a tenth (or grows beyond 2 radians), what is cut off is spread over the
/// others.
class SlidingBoundary {
  public:
    /// @param source     kept by reference
    /// @param loops      the boundary loops that slide
    /// @param prescribed the vertices of all other loops; held vertices of these that are to lie elsewhere than at
    /// their
    ///                   parameters; vertices inside that are pinned or held to lines
    /// @throw Error bad_boundary naming loops that are missing or whose parameters do not ascend, and prescribed
    ///        vertices that slide
    SlidingBoundary(const Surface& source, std::vector<SlidingLoop> loops, BoundaryCondition prescribed = {});

    const std::vector<SlidingLoop>& loops() const { return loops_; }
    /// #V: held and prescribed vertices are fixed, those of lines and the others of sliding loops slide, all others are
    /// free.
    std::vector<Freedom> freedoms() const;
    /// Puts vertices of the boundary and prescribed ones on their places, those of lines on their lines.
    void place(Eigen::VectorXcd& map) const;

    /// What a linear solve needs to know.
    struct Linearized {
        Eigen::VectorXcd directions;  ///< #V unit tangents, directions of lines; 0 elsewhere
        /// #V the curvature of the energy that comes from the curves', 0 inside.
        Eigen::VectorXd extra_diagonal;
    };
    /// @param force #V half the gradient of the energy at the present map (BeltramiSolver::gradient). At a sharp corner
    ///              of its curve it decides along which side a vertex leaves, or that it stays.
    Linearized linearized(const Eigen::VectorXcd& force);

    /// Moves boundary vertices along their curves by what a solve has moved them along the directions of the last
    /// linearized(), as far as the safeguard allows. A vertex that comes to a sharp corner stops there.
    /// @param moved #V the result of the solve
    /// @return largest movement of a vertex, as part of its curve's length
    double advance(const Eigen::VectorXcd& moved);

    /// Takes other images for what is prescribed. On a loop on which such a vertex moves the others keep their part of
    /// the way between those beside them.
    /// @param prescribed the same vertices
    /// @param places of every loop on which a vertex moves: held are those that are prescribed, at their parameters
    void move(BoundaryCondition prescribed, const std::vector<SlidingLoop>& places);

    /// Everything prescribed, the vertices of loops where they stand.
    BoundaryCondition in_place() const;

    /// Takes the parameters of a map whose boundary vertices lie on the curves, near where they are now.
    void adopt(const Eigen::VectorXcd& map);

    /// The least increment of a parameter between neighbours, relative to the mean one of its loop.
    double least_increment() const;

  private:
    struct Rim {
        std::vector<double> floors;   ///< least increments
        std::vector<double> corners;  ///< parameters of sharp ones
        std::vector<char> stuck;      ///< at a corner that the energy does not let go
        std::vector<Complex> base, directions;
    };
    void require_whole_boundary(const std::vector<char>& slides) const;

    const Surface& source_;
    std::vector<SlidingLoop> loops_;
    BoundaryCondition prescribed_;
    std::vector<Rim> rims_;
};

/// Increments that sum up to what they did before: each held between its bounds, what is cut off spread over the others
/// in proportion to the room they have.
/// @param wanted increments with the same sum as the present ones
/// @pre Σ least ≤ Σ wanted ≤ Σ most
std::vector<double> guarded_increments(std::vector<double> wanted, const std::vector<double>& least,
                                       const std::vector<double>& most);

}  // namespace beltrami
