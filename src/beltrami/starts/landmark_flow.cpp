#include <beltrami/starts/landmark_flow.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <beltrami/base/parallel.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr double kRank = 1e-10;
constexpr double kWidth = 0.6;

/// Great circles from points to points, at constant speed from time 0 to 1.
class GreatCircles {
  public:
    GreatCircles(const Positions& from, const Positions& to) : from_(from), across_(from.rows(), 3) {
        angles_.resize(from.rows());
        for (Eigen::Index i = 0; i < from.rows(); ++i) {
            const Eigen::Vector3d a = from.row(i), b = to.row(i);
            const Eigen::Vector3d across = b - a - (b - a).dot(a) * a;
            angles_[i] = std::atan2(across.norm(), a.dot(b));
            // To the opposite point every way is as short.
            across_.row(i) = across.norm() > 1e-12 ? across.normalized() : TangentFrame(a).first;
        }
    }
    Positions at(double time) const { return combined(time, 0, 1); }
    Positions velocities(double time) const { return combined(time, 1, 0); }

  private:
    /// Position or its derivative by time.
    Positions combined(double time, int derivative, int order) const {
        Positions result(from_.rows(), 3);
        for (Eigen::Index i = 0; i < from_.rows(); ++i) {
            const double c = std::cos(time * angles_[i]), s = std::sin(time * angles_[i]);
            result.row(i) = order * (c * from_.row(i) + s * across_.row(i)) +
                            derivative * angles_[i] * (c * across_.row(i) - s * from_.row(i));
        }
        return result;
    }
    Positions from_, across_;
    Eigen::VectorXd angles_;
};

void normalize_rows(Positions& points) {
    for (Eigen::Index v = 0; v < points.rows(); ++v) points.row(v).normalize();
}

Eigen::VectorXd distances_to_next(const Positions& points) {
    Eigen::VectorXd result = Eigen::VectorXd::Constant(points.rows(), std::numeric_limits<double>::infinity());
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (Eigen::Index j = 0; j < points.rows(); ++j)
            if (i != j) result[i] = std::min(result[i], (points.row(i) - points.row(j)).norm());
    return result;
}

}  // namespace

LandmarkField::LandmarkField(Positions landmarks, const Positions& velocities, double width)
    : landmarks_(std::move(landmarks)), scale_(1 / (2 * width * width)) {
    const Eigen::Index n = landmarks_.rows();
    Eigen::MatrixXd matrix(3 * n, 3 * n);
    Eigen::VectorXd right(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector3d x = landmarks_.row(i);
        const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - x * x.transpose();
        for (Eigen::Index j = 0; j < n; ++j)
            matrix.block<3, 3>(3 * i, 3 * j) =
                std::exp(-scale_ * (landmarks_.row(i) - landmarks_.row(j)).squaredNorm()) * tangential;
        right.segment<3>(3 * i) = velocities.row(i).transpose();
    }
    const Eigen::VectorXd solution = least_squares(matrix, right, kRank);
    weights_ = Eigen::Map<const Positions>(solution.data(), n, 3);
}

Eigen::RowVector3d LandmarkField::at(const Eigen::RowVector3d& point) const {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (Eigen::Index j = 0; j < landmarks_.rows(); ++j)
        sum += std::exp(-scale_ * (point - landmarks_.row(j)).squaredNorm()) * weights_.row(j);
    return sum - sum.dot(point) * point;
}

Positions LandmarkField::at(const Positions& points) const {
    Positions result(points.rows(), 3);
    parallel_for(0, static_cast<int>(points.rows()), [&](int first, int last) {
        for (int v = first; v < last; ++v) result.row(v) = at(Eigen::RowVector3d(points.row(v)));
    });
    return result;
}

Positions along_great_circles(const Positions& from, const Positions& to, double time) {
    return GreatCircles(from, to).at(time);
}

double landmark_width(const Positions& from, const Positions& to) {
    Eigen::VectorXd next = distances_to_next(from).cwiseMin(distances_to_next(to));
    std::sort(next.begin(), next.end());
    const Eigen::Index n = next.size();
    const double median = n == 0 ? 1 : 0.5 * (next[(n - 1) / 2] + next[n / 2]);
    return kWidth * std::min(1.0, median);
}

Positions landmark_flow(Positions points, const std::vector<Positions>& stops, int steps, std::optional<double> width) {
    for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg) {
        const GreatCircles way(stops[leg], stops[leg + 1]);
        const double reach = width.value_or(landmark_width(stops[leg], stops[leg + 1])), h = 1.0 / steps;
        for (int step = 0; step < steps; ++step) {
            const LandmarkField here(way.at(step * h), way.velocities(step * h), reach),
                halfway(way.at((step + 0.5) * h), way.velocities((step + 0.5) * h), reach);
            Positions middle = points + 0.5 * h * here.at(points);
            normalize_rows(middle);
            points += h * halfway.at(middle);
            normalize_rows(points);
        }
    }
    return points;
}

}  // namespace beltrami
