#pragma once

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// In which frame of a face a coefficient is written.
enum class CoefficientFrame {
    samples,     ///< that of the operators: the plane's own of a planar mesh, else as first_edge
    first_edge,  ///< with the face's first edge as real axis
    plane,       ///< the plane in which the mesh lies
    /// That of z = (x + iy)/(1 + x₃) at the middle of the face, of a mesh on the unit sphere: south is at infinity.
    stereographic,
};

/// The direction of the face's first edge in the frame of every sample: #S, of length 1.
Eigen::VectorXcd first_edge_directions(const Surface& surface);

/// μ of the samples in the frames whose real axis is the first edge of their face. Turning a planar mesh changes
/// nothing of it.
/// @param mu #S in the samples' frames
Eigen::VectorXcd mu_along_first_edge(const Surface& surface, const Eigen::VectorXcd& mu);

/// The same of a quadratic differential φ dz².
/// @param phi #S in the samples' frames
Eigen::VectorXcd phi_along_first_edge(const Surface& surface, const Eigen::VectorXcd& phi);

/// dz/dw of the stereographic coordinate at the middle of the face of every sample, w in the sample's frame: #S.
/// @throw Error bad_option naming vertices that are not on the unit sphere
Eigen::VectorXcd stereographic_derivatives(const Surface& surface);

/// Coefficients given for faces in the samples' frames: #S, the same for all samples of a quad.
/// @param face_mu #F
/// @param frame   of face_mu
/// @throw Error bad_option if there are not #F of them, frame is plane and the surface does not lie in one, or frame is
///        stereographic and vertices, which are named, do not lie on the unit sphere
Eigen::VectorXcd mu_at_samples(const Surface& surface, const Eigen::VectorXcd& face_mu,
                               CoefficientFrame frame = CoefficientFrame::samples);

}  // namespace beltrami
