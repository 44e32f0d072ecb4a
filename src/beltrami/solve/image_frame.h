#pragma once

#include <Eigen/Core>

#include <beltrami/operators/operators.h>

namespace beltrami {

/// The derivatives of a map into space at a sample, in an orthonormal frame of its image that is seen from the outer
/// side of the surface on which the image lies.
struct ImageFrame {
    Complex p, q;            ///< ∂f, ∂̄f
    Eigen::Vector3d e1, e2;  ///< the frame
    bool upright = false;    ///< whether the image is seen from there as the source; |q| < |p| then

    /// A tangent vector of the image in the frame.
    Complex along(const Eigen::Vector3d& vector) const { return {vector.dot(e1), vector.dot(e2)}; }
    /// ∂̄ of a motion as a function of the image, from its derivatives ½ b conj(g) and ½ b g in the source: of the
    /// vertex with the gradient g, which moves by a direction.
    Complex change(Complex g, const Eigen::Vector3d& direction) const {
        const Complex b = along(direction);
        return 0.5 * b * (p * g - q * std::conj(g)) / (std::norm(p) - std::norm(q));
    }
};

/// Of a map to the plane.
inline ImageFrame plane_frame(Complex p, Complex q) {
    return {p, q, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), std::norm(q) < std::norm(p)};
}

/// @param points  #V×3
/// @param normals #V×3 of the surface at the points, of length 1
ImageFrame image_frame(const Operators& operators, int sample, const Positions& points, const Positions& normals);

/// Of the smallest sample at each vertex the longest edge in the image (#V); 1 at vertices without faces.
Eigen::VectorXd local_sizes(const Operators& operators, const Positions& points);

}  // namespace beltrami
