#pragma once

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

// Triangles on the unit sphere are geodesic; they run counter-clockwise as seen from outside where nothing is flipped.

/// Inverse stereographic projection from the south pole, which is at infinity: z ↦ (2 Re z, 2 Im z, 1 − |z|²)/(1 +
/// |z|²). Triangles that run counter-clockwise in the plane do so on the sphere, seen from outside.
Eigen::Vector3d sphere_point(Complex z);

/// The same of every point (#V×3).
Positions sphere_points(const Eigen::VectorXcd& z);

/// Stereographic projection from the south pole, the inverse of sphere_point().
/// @pre not the south pole
Complex stereographic(const Eigen::Vector3d& point);

/// det[a, b, c] from differences: positive exactly where the geodesic triangle runs counter-clockwise, seen from
/// outside, also where it is tiny.
double oriented_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// The solid angle of a geodesic triangle, steradian, negative where it is flipped. Source: Van Oosterom, Strackee
/// 1983, "The solid angle of a plane triangle".
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// How often triangles cover the sphere: Σ solid angles/4π, 1 for a homeomorphism.
double covering_degree(const FaceList& triangles, const Positions& points);

/// Two unit vectors that complete a unit vector to a right-handed frame (first, second, normal).
struct TangentFrame {
    Eigen::Vector3d first, second;
    explicit TangentFrame(const Eigen::Vector3d& normal);
};

/// Central projection from the sphere's centre to the tangent plane at a point: geodesics become straight lines, so
/// that the orientation of triangles is kept exactly.
class GnomonicChart {
  public:
    explicit GnomonicChart(const Eigen::Vector3d& centre) : centre_(centre), frame_(centre) {}
    /// @pre inside the hemisphere around the centre
    Complex operator()(const Eigen::Vector3d& point) const {
        const Eigen::Vector3d from = point - centre_;  // keeps the digits of what is near
        return Complex(from.dot(frame_.first), from.dot(frame_.second)) / point.dot(centre_);
    }
    Eigen::Vector3d point(Complex z) const {
        return (centre_ + z.real() * frame_.first + z.imag() * frame_.second).normalized();
    }

  private:
    Eigen::Vector3d centre_;
    TangentFrame frame_;
};

}  // namespace beltrami
