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
    /// Whether a triangle has angles.
    virtual bool is_finite(int) const { return true; }
    /// Whether u stays at a vertex until something changes, whatever its angle sum.
    virtual bool is_held(int) const { return false; }
    /// Lets go vertices that are held but would rather not be. @return how many
    virtual int release(const Eigen::VectorXd&) { return 0; }
};

}  // namespace beltrami
