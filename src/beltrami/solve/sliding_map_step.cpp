#include <beltrami/solve/sliding_map_step.h>

namespace beltrami {

namespace {

/// While a boundary vertex moves by more than this part of its curve, an old factor is of no use.
constexpr double kNearBelow = 0.05;

}  // namespace

SlidingMapStep::SlidingMapStep(const Surface& source, SlidingBoundary& boundary, int expected_factorizations)
    : boundary_(boundary), solver_(source, boundary.freedoms(), expected_factorizations) {}

void SlidingMapStep::solve(const Eigen::VectorXcd& nu, Eigen::VectorXcd& map, double tolerance) {
    SlidingBoundary::Linearized linearized = boundary_.linearized(solver_.gradient(map, nu));
    // Where the energy is concave along a curve, its curvature could make the system indefinite.
    linearized.extra_diagonal = linearized.extra_diagonal.cwiseMax(0.0);
    if (movement_ < kNearBelow) {
        map = solver_.solve_near(nu, linearized.directions, linearized.extra_diagonal, map, map, tolerance);
    } else {
        solver_.factorize(nu, linearized.directions, linearized.extra_diagonal);
        map = solver_.solve(map);
    }
    movement_ = boundary_.advance(map);
    boundary_.place(map);
}

}  // namespace beltrami
