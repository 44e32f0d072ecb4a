#pragma once

#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {

/// What Newton's method for scale factors works on: a triangulation that can be made Delaunay for any of them.
class ScaledSurface {
  public:
    virtual ~ScaledSurface() = default;
    virtual const IntrinsicTriangulation& triangulation() const = 0;
    /// Flips edges until the metric scaled by u is Delaunay, raising u where the surface sets it a least value.
    /// @return the number of flips
    virtual int make_delaunay(Eigen::VectorXd& u) = 0;
    /// Angles of a triangle in the metric scaled by u, and what stands for their cotangents in the Hessian of the
    /// energy Σ w ((du_i − du_j)² + c (du_i + du_j)²), w half the sum of both sides of an edge.
    virtual TriangleAngles angles(int triangle, const Eigen::VectorXd& u) const {
        return triangulation().angles(triangle, u);
    }
    /// c of an edge: how much the metric, and not only its ratios, depends on the scale; 0 where it is flat.
    virtual double scale_share(int /*halfedge*/, const Eigen::VectorXd& /*u*/) const { return 0; }
    /// Whether a triangle has angles.
    virtual bool is_finite(int) const { return true; }
    /// Whether u stays at a vertex until something changes, whatever its angle sum.
    virtual bool is_held(int) const { return false; }
    /// Lets go vertices that are held but would rather not be. @return how many
    virtual int release(const Eigen::VectorXd&) { return 0; }
};

}  // namespace beltrami
