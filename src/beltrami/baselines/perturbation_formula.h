#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The motion V with V_w̄ = ρ that keeps 0, 1 and ∞, by the integral over the plane
///
///     V(w) = −w(w − 1)/π ∫ ρ(z) / (z (z − 1)(z − w)) dx dy,
///
/// every triangle by its middle: #V times #F terms, where TargetStep solves a sparse system. ρ is 0 beyond the mesh.
/// Source: Lui, Lam, Wong, Gu 2012, "Texture map and video compression using Beltrami representation", there for the
/// disk; Wong & Zhao 2014, eq. (3.6), whose kernel keeps 0, 1 and ∞ and not 0, 1 and −1.
/// @param faces  triangles
/// @param image  #V places
/// @param change #F ρ, on the image
Eigen::VectorXcd perturbation_motion(const FaceList& faces, const Eigen::VectorXcd& image,
                                     const Eigen::VectorXcd& change);

struct PerturbationFlowOptions {
    double tolerance = 1e-3;  ///< stop when no vertex moves by more, in the units of the plane
    int max_iterations = 100;
};

struct PerturbationFlow {
    Eigen::VectorXcd map;
    int iterations = 0;
    bool converged = false;
};

/// Maps with a prescribed coefficient by perturbation_motion(), kept for comparison with surface_flow: of a planar mesh
/// onto itself that keep every vertex of the boundary, and so extend to the plane by the identity. A step is halved
/// until it flips no triangle.
/// @param mu #S in the plane's frame
/// @throw Error bad_mesh unless the source is a planar mesh of triangles; bad_option (μ)
PerturbationFlow perturbation_flow(const Surface& source, const Eigen::VectorXcd& mu,
                                   const PerturbationFlowOptions& options = {});

}  // namespace beltrami
