#include <beltrami/solve/map_step.h>

namespace beltrami {

namespace {

/// The tolerance stands for the change of the coefficient. Where conjugate gradients did not suffice they are tried
/// again once it is down to this part; and where it is larger than then, for then they were asked for too much.
constexpr double kTryAgain = 0.3;

}  // namespace

void FixedMapStep::solve(const Eigen::VectorXcd& nu, double tolerance) {
    if (near_ && !(kTryAgain * given_up_at_ <= tolerance && tolerance <= given_up_at_)) {
        const int before = solver_.factorization_count();
        map_ = solver_.solve_near(nu, prescribed_, map_, tolerance);
        if (solver_.factorization_count() > before) given_up_at_ = tolerance;
        return;
    }
    solver_.factorize(nu, directions_);
    map_ = solver_.solve(prescribed_);
    near_ = true;
}

}  // namespace beltrami
