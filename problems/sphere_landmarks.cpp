#include "problems/sphere_landmarks.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <beltrami/generate/sphere.h>
#include <beltrami/sphere/moebius_fit.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/starts/landmark_flow.h>

namespace beltrami::bench {

namespace {

using Modular = std::array<double, 4>;  // a b; c d

/// Arithmetic-geometric mean on the right branch.
Complex agm(Complex a, Complex b) {
    for (int i = 0; i < 60 && std::abs(a - b) > 1e-16 * std::abs(a); ++i) {
        const Complex mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        if (std::real(std::conj(mean) * b) < 0) b = -b;
        a = mean;
    }
    return a;
}

Complex tau(Complex lambda) {
    return Complex(0, 1) * agm(1, std::sqrt(1.0 - lambda)) / agm(1, std::sqrt(lambda));
}

double hyperbolic_distance(Complex a, Complex b) {
    return std::acosh(1 + std::norm(a - b) / (2 * a.imag() * b.imag()));
}

Modular product(const Modular& a, const Modular& b) {
    return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]};
}

Complex image(const Modular& m, Complex t) {
    return (m[0] * t + m[1]) / (m[2] * t + m[3]);
}

/// τ followed along cross ratios: of all values that Γ(2) gives the one nearest to the last.
class Follower {
  public:
    void add(Complex lambda) {
        const Complex base = tau(lambda);
        if (!begun_) {
            first_ = last_ = base;
            begun_ = true;
            return;
        }
        constexpr std::array<Modular, 5> kGenerators{
            {{1, 2, 0, 1}, {1, -2, 0, 1}, {1, 0, 2, 1}, {1, 0, -2, 1}, {1, 0, 0, 1}}};
        Modular nearest = offset_;
        double least = 1e300;
        for (const Modular& a : kGenerators)
            for (const Modular& b : kGenerators) {
                const Modular word = product(product(a, b), offset_);
                const double distance = hyperbolic_distance(image(word, base), last_);
                if (distance < least) least = distance, nearest = word;
            }
        offset_ = nearest;
        last_ = image(offset_, base);
    }
    double k() const { return std::tanh(hyperbolic_distance(first_, last_) / 2); }

  private:
    Modular offset_{1, 0, 0, 1};
    Complex first_, last_;
    bool begun_ = false;
};

Complex cross_ratio(const Positions& p) {
    const auto z = [&](int i) { return stereographic(p.row(i)); };
    return (z(0) - z(2)) * (z(1) - z(3)) / ((z(0) - z(3)) * (z(1) - z(2)));
}

/// Rotations after which no symmetry of the octahedron is one of the axes.
const Eigen::Matrix3d& rotation_of_four() {
    static const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(2.825633562173526, Eigen::Vector3d(-0.31580371, -0.17282248, 0.93295252).normalized())
            .toRotationMatrix();
    return rotation;
}
const Eigen::Matrix3d& rotation_of_eight() {
    static const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(2.007229902412718, Eigen::Vector3d(-0.54419428, -0.50072701, 0.67314564).normalized())
            .toRotationMatrix();
    return rotation;
}

Positions ring_points(const TwoRings& rings) {
    Positions points(8, 3);
    for (int j = 0; j < 4; ++j) {
        const double angle = j * std::numbers::pi / 2;
        points.row(j) = sphere_point(std::polar(rings.r, angle));
        points.row(4 + j) = sphere_point(std::polar(rings.s, rings.alpha + angle));
    }
    return points;
}

double exact_k(const TwoRings& from, const TwoRings& to) {
    Follower follower;
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i) {
        const double t = static_cast<double>(i) / kSteps;
        const double r = std::lerp(from.r, to.r, t), s = std::lerp(from.s, to.s, t);
        follower.add(std::polar(std::pow(r / s, 4), -4 * std::lerp(from.alpha, to.alpha, t)));
    }
    return follower.k();
}

/// Moves the nearest vertices to points, and what is around them with them. @return the vertices
std::vector<int> snap(Mesh& mesh, const Positions& points) {
    std::vector<int> vertices;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        Eigen::VectorXd distance = (mesh.positions.rowwise() - points.row(i)).rowwise().norm();
        for (const int v : vertices) distance[v] = 9;
        Eigen::Index nearest = 0;
        distance.minCoeff(&nearest);
        vertices.push_back(static_cast<int>(nearest));
    }
    double edge = 0;
    for (int f = 0; f < mesh.face_count(); ++f)
        edge += (mesh.point(mesh.faces[f][1]) - mesh.point(mesh.faces[f][0])).norm() / mesh.face_count();
    mesh.positions = landmark_flow(mesh.positions, {mesh.positions(vertices, Eigen::all), points}, 4, 1.5 * edge);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        mesh.positions.row(vertices[i]) = points.row(static_cast<Eigen::Index>(i));
    return vertices;
}

}  // namespace

SphereLandmarks four_landmarks(int levels, double amplitude) {
    SphereLandmarks problem{octahedral_sphere(levels), {}, 0};
    const Eigen::Matrix3d& rotation = rotation_of_four();
    problem.mesh.positions *= rotation.transpose();
    const std::vector<int> vertices{0, 2, 1, 4};
    Positions moved(4, 3);
    moved << .0, .3, .2, .25, -.1, .3, -.2, .3, 0, .3, .3, -.2;
    Positions to = problem.mesh.positions(vertices, Eigen::all) + amplitude * moved * rotation.transpose();
    to.rowwise().normalize();
    const Positions from =
        moebius_fitted(problem.mesh.positions(vertices, Eigen::all), std::vector<int>{0, 1, 2, 3}, to);
    Follower follower;
    for (int i = 0; i <= 200; ++i) follower.add(cross_ratio(along_great_circles(from, to, i / 200.0)));
    problem.exact_k = follower.k();
    for (int i = 0; i < 4; ++i) problem.landmarks.push_back({vertices[i], to.row(i)});
    return problem;
}

SphereLandmarks eight_landmarks(int levels, const TwoRings& from, const TwoRings& to) {
    SphereLandmarks problem{octahedral_sphere(levels), {}, exact_k(from, to)};
    problem.mesh.positions *= rotation_of_eight().transpose();
    const std::vector<int> vertices = snap(problem.mesh, ring_points(from));
    const Positions images = ring_points(to);
    for (int i = 0; i < 8; ++i) problem.landmarks.push_back({vertices[i], images.row(i)});
    return problem;
}

}  // namespace beltrami::bench
