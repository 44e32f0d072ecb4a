#include <beltrami/teichmuller/soft_landmarks.h>

#include <algorithm>
#include <cmath>

#include <beltrami/operators/distortion.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/starts/landmark_flow.h>
#include <beltrami/unfold/sphere_faces.h>

namespace beltrami {

namespace {

constexpr int kCarryingSteps = 4;     // of the flow of a move
constexpr int kSettlingSteps = 4;     // of the map after a move
constexpr double kLongestMove = 0.5;  // in units of the fields' width

double distance_of(double k) {
    return std::atanh(std::clamp(k, 0.0, 1 - 1e-12));
}

}  // namespace

SoftLandmarks::SoftLandmarks(const Surface& source, SphereProblem& problem, SphereMapStep& step,
                             const std::vector<int>& vertices, Positions wanted, Eigen::VectorXd weights,
                             HamiltonIteration::Options options)
    : source_(source),
      problem_(problem),
      step_(step),
      vertices_(vertices),
      wanted_(std::move(wanted)),
      places_(step.points()(vertices, Eigen::all)),
      weights_(std::move(weights)),
      options_(std::move(options)),
      width_(landmark_width(wanted_, wanted_)) {
    options_.max_iterations = kSettlingSteps;
}

/// The map and its φ settle where the landmarks are.
void SoftLandmarks::follow() {
    const HamiltonIteration iteration = problem_.settle(step_, options_);
    steps_ += iteration.iterations();
    last_ = iteration.last_step();
}

Eigen::VectorXd SoftLandmarks::coordinates() const {
    return Eigen::Map<const Eigen::VectorXd>(places_.data(), places_.size());
}

double SoftLandmarks::value() const {
    double sum = distance_of(last_.k);
    for (Eigen::Index i = 0; i < weights_.size(); ++i)
        if (std::isfinite(weights_[i])) sum += weights_[i] * (places_.row(i) - wanted_.row(i)).squaredNorm();
    return sum;
}

/// 3 #L numbers, tangent; 0 at landmarks that are met.
Eigen::VectorXd SoftLandmarks::gradient() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(places_.size());
    const std::vector<double>& areas = source_.operators.weights;
    double total = 0;
    for (std::size_t s = 0; s < areas.size(); ++s)
        total += areas[s] * std::abs(last_.phi[static_cast<Eigen::Index>(s)]);
    for (Eigen::Index i = 0; i < places_.rows(); ++i) {
        if (!std::isfinite(weights_[i])) continue;
        const Eigen::Vector3d place = places_.row(i), off = (places_.row(i) - wanted_.row(i)).transpose();
        const TangentFrame frame(place);
        for (const Eigen::Vector3d& direction : {frame.first, frame.second}) {
            Positions velocities = Positions::Zero(places_.rows(), 3);
            velocities.row(i) = direction;
            const Positions motion = LandmarkField(places_, velocities, width_).at(step_.points());
            const Eigen::VectorXcd change = coefficient_change(source_.operators, step_.points(), motion);
            double slope = 0;
            for (std::size_t s = 0; s < areas.size(); ++s) {
                const auto sample = static_cast<Eigen::Index>(s);
                slope += areas[s] * std::real(last_.phi[sample] * change[sample]);
            }
            result.segment<3>(3 * i) += (slope / total + 2 * weights_[i] * off.dot(direction)) * direction;
        }
    }
    return result;
}

bool SoftLandmarks::move(const Eigen::VectorXd& step) {
    Positions to = places_;
    for (Eigen::Index i = 0; i < to.rows(); ++i)
        if (std::isfinite(weights_[i])) to.row(i) = (to.row(i) + step.segment<3>(3 * i).transpose()).normalized();
    Positions points = landmark_flow(step_.points(), {places_, to}, kCarryingSteps, width_);
    for (std::size_t i = 0; i < vertices_.size(); ++i) points.row(vertices_[i]) = to.row(static_cast<Eigen::Index>(i));
    if (!SphereFaces(source_).flipped(points).empty()) return false;
    map_before_ = step_.snapshot();
    places_before_ = std::move(places_);
    last_before_ = last_;
    step_.set_points(std::move(points));
    places_ = std::move(to);
    follow();
    return true;
}

void SoftLandmarks::undo() {
    step_.restore(map_before_);
    places_ = places_before_;
    last_ = last_before_;
}

int SoftLandmarks::settle() {
    follow();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(places_.size(), places_.size());
    for (Eigen::Index i = 0; i < weights_.size(); ++i)
        hessian.diagonal().segment<3>(3 * i).setConstant(1 / (width_ * width_) +
                                                         (std::isfinite(weights_[i]) ? 2 * weights_[i] : 0));
    balance(*this, std::move(hessian), kLongestMove * width_, 3);
    return steps_;
}

}  // namespace beltrami
