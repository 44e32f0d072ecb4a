#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/targets/slide_curve.h>

namespace beltrami BELTRAMI_PUBLIC {

/// An oriented surface in space that maps go to, and all that a map which moves along it asks of it: which point of the
/// surface a moved one becomes, what is up there, and which place of a mesh it is.
class Target {
  public:
    /// A point of the surface.
    struct Point {
        Eigen::Vector3d position = Eigen::Vector3d::Zero();
        Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< of length 1, on the surface's outer side
        MeshPoint place;                                       ///< on a mesh; elsewhere its face is −1
        Eigen::Vector2d parameters = Eigen::Vector2d::Zero();  ///< (u, v) of a parametrised surface
    };
    using Points = std::vector<Point>;

    virtual ~Target() = default;

    /// The point of the surface that is nearest to a point of space. Several threads may ask.
    /// @param point finite
    virtual Point nearest(const Eigen::Vector3d& point) const = 0;

    /// The point of the surface to which a point of it comes that was moved off along the tangent plane: the nearest
    /// one; on parametrised and implicit surfaces the nearest that is found from there.
    /// @param moved finite
    virtual Point retract(const Eigen::Vector3d& moved, const Point& /*from*/) const { return nearest(moved); }

    /// What motions of a point are across, so that it moves as they say to first order: its normal, but inside a face
    /// of a mesh that of the face.
    virtual Eigen::Vector3d across(const Point& point) const { return point.normal; }

    /// Where conformal maps of the surface onto itself leave maps to it undetermined that hold no vertex: the
    /// representative with its centre of mass in the middle. Elsewhere the points as they are.
    /// @param weights #V of the points
    virtual Points centred(Points points, const Eigen::VectorXd& /*weights*/) const { return points; }

    /// Of such maps too: a motion along the surface less what it has of motions that are conformal to first order, by
    /// least squares. An energy is flat along those up to the mesh's error. Elsewhere the motion as it is.
    /// @param points  #V×3 of the surface
    /// @param motion  #V×3, tangent there
    /// @param weights #V
    virtual Positions without_drift(const Positions& /*points*/, Positions motion,
                                    const Eigen::VectorXd& /*weights*/) const {
        return motion;
    }

    /// The curves that bound the surface, of a mesh in the order of its boundary loops.
    virtual SlideCurves boundary() const { return {}; }

    /// The mesh of which the surface consists; null where it is none.
    virtual const Mesh* mesh() const { return nullptr; }
};

/// The nearest points of the surface to many points of space (#P×3 or #P×2, one row each), on all threads.
/// @throw Error bad_option naming points that are not finite
Target::Points nearest_points(const Target& target, const Positions& points);

/// #P×3 positions of points, and their normals.
Positions positions_of(const Target::Points& points);
Positions normals_of(const Target::Points& points);

}  // namespace beltrami
