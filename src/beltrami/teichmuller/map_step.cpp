#include <beltrami/teichmuller/map_step.h>

namespace beltrami {

namespace {

/// Conjugate gradients that did not suffice are tried again from this part of the tolerance on, which stands for the
/// change of the coefficient.
constexpr double kTryAgain = 0.3;

}  // namespace

void FixedMapStep::solve(const Eigen::VectorXcd& nu, Eigen::VectorXcd& map, double tolerance) {
    if (near_ && tolerance < kTryAgain * given_up_at_) {
        const int before = solver_.factorization_count();
        map = solver_.solve_near(nu, prescribed_, map, tolerance);
        if (solver_.factorization_count() > before) given_up_at_ = tolerance;
        return;
    }
    solver_.factorize(nu, directions_);
    map = solver_.solve(prescribed_);
    near_ = true;
}

}  // namespace beltrami
