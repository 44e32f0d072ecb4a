#pragma once

#include <functional>
#include <optional>

#include <beltrami/targets/target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface given by two parameters.
class ParametricTarget final : public Target {
  public:
    /// A place with the derivatives by the parameters, which are independent there; the normal is along du × dv.
    struct Jet {
        Eigen::Vector3d position, du, dv;
    };
    using Function = std::function<Jet(double u, double v)>;
    struct Range {
        double first, last;
        bool periodic;
    };

    /// @param boundary the curves that bound it, where a range is not periodic
    /// @param unit     of a surface that is the plane rolled up: the lengths of du and dv, the same everywhere and at
    ///                 right angles
    ParametricTarget(Function function, Range u, Range v, SlideCurves boundary = {},
                     std::optional<Eigen::Vector2d> unit = {});

    Point at(double u, double v) const;
    /// From the nearest of a grid of places on.
    Point nearest(const Eigen::Vector3d& point) const override;
    Point retract(const Eigen::Vector3d& moved, const Point& from) const override;
    SlideCurves boundary() const override { return boundary_; }

    /// A surface unrolled into the plane.
    struct Unrolled {
        Eigen::Vector2d unit;   ///< lengths that the parameters' units have
        Eigen::Vector2d turns;  ///< whole turns of the parameters, as lengths; 0 where one is not periodic
    };
    /// Nothing unless the surface is the plane rolled up, as a cylinder is.
    std::optional<Unrolled> unrolled() const;

  private:
    Function function_;
    Range u_, v_;
    SlideCurves boundary_;
    std::optional<Eigen::Vector2d> unit_;
    std::vector<Point> grid_;
};

/// The torus of revolution of generate/grids.h, u along the large circle and v along the small one, both with period 1.
/// @throw Error bad_option unless major > minor > 0
ParametricTarget torus_target(double major, double minor);

/// The modified tori of Wong & Zhao 2014, section 5.4, both with period 1 in u and v:
/// first with h = 4 + 1.7 cos 2πv + .3 cos 6π(u + v): (h cos 2πu, h sin 2πu, 1.7 sin 2πv);
/// second with q = 1.5 + .4 cos 10πu, h = 4 + q cos 2πv: (h cos 2πu, h sin 2πu, q sin 2πv).
ParametricTarget first_modified_torus();
ParametricTarget second_modified_torus();

/// The cylinder of generate/grids.h about the z-axis, 0 ≤ z ≤ height, bounded by its lower and its upper circle.
/// @throw Error bad_option unless both are positive
ParametricTarget cylinder_target(double radius, double height);

}  // namespace beltrami
