#include <beltrami/linear/anderson.h>

#include <beltrami/linear/decomposition.h>

namespace beltrami {

Eigen::VectorXd AndersonAcceleration::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g) {
    const Eigen::VectorXd residual = g - x;
    if (last_g_.size() == g.size()) {
        g_differences_.push_back(g - last_g_);
        residual_differences_.push_back(residual - last_residual_);
        if (static_cast<int>(g_differences_.size()) > window_) {
            g_differences_.pop_front();
            residual_differences_.pop_front();
        }
    } else if (!g_differences_.empty() && g_differences_.back().size() != g.size()) {
        reset();
    }
    last_g_ = g;
    last_residual_ = residual;
    const auto m = static_cast<Eigen::Index>(g_differences_.size());
    if (m == 0) return g;

    Eigen::MatrixXd R(g.size(), m);
    for (Eigen::Index j = 0; j < m; ++j) R.col(j) = residual_differences_[static_cast<std::size_t>(j)];
    const Eigen::VectorXd gamma = least_squares(R, residual);
    Eigen::VectorXd result = g;
    for (Eigen::Index j = 0; j < m; ++j) result -= gamma[j] * g_differences_[static_cast<std::size_t>(j)];
    return result.allFinite() ? result : g;
}

void AndersonAcceleration::reset() {
    g_differences_.clear();
    residual_differences_.clear();
    leave_point();
}

void AndersonAcceleration::leave_point() {
    last_g_.resize(0);
    last_residual_.resize(0);
}

}  // namespace beltrami
