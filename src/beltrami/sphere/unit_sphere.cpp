#include <beltrami/sphere/unit_sphere.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace beltrami {

Eigen::Vector3d sphere_point(Complex z) {
    const double size = std::norm(z);
    if (!(size < 1e300)) return {0, 0, -1};
    return Eigen::Vector3d(2 * z.real(), 2 * z.imag(), 1 - size) / (1 + size);
}

Positions sphere_points(const Eigen::VectorXcd& z) {
    Positions points(z.size(), 3);
    for (Eigen::Index v = 0; v < z.size(); ++v) points.row(v) = sphere_point(z[v]);
    return points;
}

Complex stereographic(const Eigen::Vector3d& point) {
    return Complex(point.x(), point.y()) / (1 + point.z());
}

double oriented_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return a.dot((b - a).cross(c - a));
}

double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return 2 * std::atan2(oriented_volume(a, b, c), 1 + a.dot(b) + b.dot(c) + c.dot(a));
}

double covering_degree(const FaceList& triangles, const Positions& points) {
    double sum = 0;
    for (int t = 0; t < triangles.size(); ++t) {
        const auto v = triangles[t];
        sum += solid_angle(points.row(v[0]), points.row(v[1]), points.row(v[2]));
    }
    return sum / (4 * std::numbers::pi);
}

TangentFrame::TangentFrame(const Eigen::Vector3d& normal) {
    const Eigen::Vector3d axis =
        std::abs(normal.x()) < 0.6 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY().eval();
    first = (axis - axis.dot(normal) * normal).normalized();
    second = normal.cross(first);
}

}  // namespace beltrami
