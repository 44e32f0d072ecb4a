#include <beltrami/teichmuller/map_step.h>

namespace beltrami {

void FixedMapStep::solve(const Eigen::VectorXcd& nu, Eigen::VectorXcd& map, double tolerance) {
    if (near_) {
        map = solver_.solve_near(nu, prescribed_, map, tolerance);
        return;
    }
    solver_.factorize(nu, directions_);
    map = solver_.solve(prescribed_);
    near_ = true;
}

}  // namespace beltrami
