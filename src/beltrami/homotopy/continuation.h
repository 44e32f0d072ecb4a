#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Boundary values on the way from a planar domain to prescribed ones: the centres of the holes move along polylines
/// through waypoints, straight without any. Maps that follow the way in small steps end in the homotopy class that it
/// describes; with two or more holes that includes how the holes braid around each other.
///
/// At t = 0 the loops are those of the domain, moved by the similarity that fits its outer loop to the prescribed one
/// best, at t = 1 the prescribed ones. Between them the logarithms of a loop's points about its centre are
/// interpolated, in the branch of least turning: it turns and grows evenly and does not collapse. Loops that come near
/// each other or the outer one shrink for a while.
class Continuation {
  public:
    /// @param positions #V places in the plane in which the domain is not folded: a chart's, or the mesh's own
    /// @param boundary  the whole boundary
    /// @throw Error bad_boundary if loops are not wholly prescribed, or run around their inside in the image otherwise
    ///        than in the domain; naming two holes whose centres meet, or a hole whose centre leaves the outer loop;
    ///        bad_option for waypoints of loops or steps that do not exist
    Continuation(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                 const BoundaryCondition& boundary, const std::vector<Waypoint>& waypoints = {});

    /// Boundary values at 0 ≤ t ≤ 1; exactly the prescribed ones at 1. Other prescribed vertices only at 1.
    /// @throw Error bad_boundary naming loops that have no room
    BoundaryCondition at(double t) const;

    /// The domain at t = 0 (#V): a map with the boundary values at(0), from which to start.
    const Eigen::VectorXcd& start() const { return start_; }
    /// Number of straight pieces of the way: t = i/pieces() is step i.
    int pieces() const { return pieces_; }
    /// Where the centre of a loop's image is.
    Complex centre(int loop, double t) const;

  private:
    struct Loop {
        std::vector<Complex> centres;     ///< pieces+1
        std::vector<Complex> logarithms;  ///< of each vertex' direction from the centre at t = 0
        std::vector<Complex> change;      ///< of the logarithms until t = 1
    };

    std::vector<Complex> shape(int loop, double t) const;
    void require_free_ways() const;

    std::vector<std::vector<int>> vertices_;
    int outer_loop_;
    int pieces_ = 1;
    BoundaryCondition boundary_;
    Eigen::VectorXcd start_;
    std::vector<Loop> loops_;
    double diameter_ = 0;  ///< of the prescribed outer loop
};

/// A map that was led along a continuation.
struct FollowedMap {
    Eigen::VectorXcd map;  ///< #V, without folds, with the prescribed boundary values
    int steps = 0;
    int repaired_steps = 0;  ///< steps after which folds had to be opened (fold_free.h)
};

/// Leads the domain along a continuation: every step solves with the coefficient of the last map and the next boundary
/// values, which is a harmonic map of the last image and so keeps the class while it does not fold. Steps that fold are
/// halved; below @p smallest_step the folds, few by then, are opened.
/// @param largest_step, smallest_step parts of one straight piece
/// @throw Error not_solved if folds do not open, with the step; what Continuation::at throws
FollowedMap follow(const Surface& source, const Continuation& continuation, double largest_step = 0.125,
                   double smallest_step = 0.0625);

/// The boundary values at equal steps, the last of which are the prescribed ones. Where a map folds on the way, take
/// more.
/// @param substeps steps in each straight piece, at least 1
std::vector<BoundaryCondition> continuation_steps(const Surface& source, const Eigen::VectorXcd& positions,
                                                  int outer_loop, const BoundaryCondition& boundary,
                                                  const std::vector<Waypoint>& waypoints = {}, int substeps = 8);

}  // namespace beltrami
