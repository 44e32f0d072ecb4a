#include <beltrami/registration/alignment.h>

#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <beltrami/locate/point_at.h>
#include <beltrami/registration/nearest_places.h>

namespace beltrami {

namespace {

constexpr int kMostSteps = 60;
constexpr double kSettled = 1e-7;       // change of a rotation
constexpr double kClearlyBetter = 0.9;  // of the root mean square distance
constexpr int kMostPoints = 1500;       // of the source, by which it is brought near

double area(const Mesh& mesh) {
    double sum = 0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

/// Centre and principal axes of a surface, by area.
struct Frame {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    Eigen::Matrix3d axes;  // columns, from the shortest to the longest

    explicit Frame(const Mesh& mesh) {
        std::vector<Eigen::RowVector3d> middles;
        std::vector<double> areas;
        double total = 0;
        for (int f = 0; f < mesh.face_count(); ++f) {
            Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
            for (const int v : mesh.faces[f]) middle += mesh.point(v).transpose() / mesh.faces.degree(f);
            middles.push_back(middle);
            areas.push_back(face_vector_area(mesh, f).norm());
            centre += areas.back() * middle;
            total += areas.back();
        }
        centre /= total;
        Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
        for (std::size_t f = 0; f < middles.size(); ++f)
            moments += areas[f] * (middles[f] - centre).transpose() * (middles[f] - centre);
        axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
        if (axes.determinant() < 0) axes.col(0) *= -1;
    }
};

struct Pose {
    Eigen::Matrix3d rotation;
    Eigen::RowVector3d shift;
    double distance = 0;  // root mean square

    Positions operator()(const Positions& points) const { return (points * rotation.transpose()).rowwise() + shift; }
};

double root_mean_square(const std::vector<NearestPlace>& places) {
    double sum = 0;
    for (const NearestPlace& place : places) sum += place.distance * place.distance;
    return std::sqrt(sum / static_cast<double>(places.size()));
}

/// Iterated closest points from a pose.
Pose settled(const Positions& points, const Mesh& target, Pose pose) {
    for (int step = 0; step < kMostSteps; ++step) {
        const std::vector<NearestPlace> nearest = nearest_places(target, pose(points));
        Eigen::Matrix3Xd from = points.transpose(), to(3, points.rows());
        for (Eigen::Index i = 0; i < points.rows(); ++i)
            to.col(i) = point_at(target, nearest[static_cast<std::size_t>(i)].place);
        const Eigen::Matrix4d fitted = Eigen::umeyama(from, to, false);
        const double change = (fitted.topLeftCorner<3, 3>() - pose.rotation).norm();
        pose.rotation = fitted.topLeftCorner<3, 3>();
        pose.shift = fitted.topRightCorner<3, 1>().transpose();
        if (change < kSettled) break;
    }
    pose.distance = root_mean_square(nearest_places(target, pose(points)));
    return pose;
}

}  // namespace

Positions aligned(const Mesh& source, const Mesh& target, Alignment how) {
    Positions all(source.vertex_count(), 3);
    for (int v = 0; v < source.vertex_count(); ++v) all.row(v) = source.point(v).transpose();
    if (how == Alignment::none) return all;
    Frame from(source);
    const Frame to(target);
    if (how == Alignment::similarity) {
        const double scale = std::sqrt(area(target) / area(source));
        all *= scale;
        from.centre *= scale;
    }
    const int stride = 1 + source.vertex_count() / kMostPoints;
    Positions some((all.rows() + stride - 1) / stride, 3);
    for (Eigen::Index i = 0; i < some.rows(); ++i) some.row(i) = all.row(i * stride);

    std::vector<Eigen::Matrix3d> rotations{Eigen::Matrix3d::Identity()};
    for (const int flip : {0, 1, 2, 3}) {
        Eigen::Vector3d signs(1, 1, 1);
        if (flip > 0) signs = -signs, signs[flip - 1] = 1;
        rotations.push_back(to.axes * signs.asDiagonal() * from.axes.transpose());
    }
    Pose best;
    for (std::size_t r = 0; r < rotations.size(); ++r) {
        const Eigen::RowVector3d shift = to.centre - from.centre * rotations[r].transpose();
        const Pose pose = settled(some, target, {rotations[r], shift});
        if (r == 0 || pose.distance < kClearlyBetter * best.distance) best = pose;
    }
    return best(all);
}

}  // namespace beltrami
