#include <beltrami/solve/sliding_map_step.h>

namespace beltrami {

namespace {

/// While a boundary vertex moves by more than this part of its curve, an old factor is of no use.
constexpr double kNearBelow = 0.05;

}  // namespace

SlidingMapStep::SlidingMapStep(const Surface& source, SlidingBoundary& boundary, Eigen::VectorXcd map,
                               int expected_factorizations)
    : PlaneMapStep(source.operators),
      boundary_(boundary),
      solver_(source, boundary.freedoms(), expected_factorizations) {
    set_map(std::move(map));
}

void SlidingMapStep::solve(const Eigen::VectorXcd& nu, double tolerance) {
    SlidingBoundary::Linearized linearized = boundary_.linearized(solver_.gradient(map_, nu));
    // Where the energy is concave along a curve, its curvature could make the system indefinite.
    linearized.extra_diagonal = linearized.extra_diagonal.cwiseMax(0.0);
    if (movement_ < kNearBelow) {
        map_ = solver_.solve_near(nu, linearized.directions, linearized.extra_diagonal, map_, map_, tolerance);
    } else {
        solver_.factorize(nu, linearized.directions, linearized.extra_diagonal);
        map_ = solver_.solve(map_);
    }
    movement_ = boundary_.advance(map_);
    boundary_.place(map_);
}

}  // namespace beltrami
