#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/complex.h>

namespace beltrami {

/// A part of the plane in triangles that run counter-clockwise and do not overlap.
struct PlaneTriangles {
    Eigen::VectorXcd points;
    std::vector<std::array<int, 3>> triangles;
};

/// Values of a function at points of the plane; not finite where it has none.
using PlaneFunction = std::function<Eigen::VectorXcd(const Eigen::VectorXcd&)>;

struct PlaneZero {
    Complex at;
    int order;     ///< −1: a pole
    int triangle;  ///< in which it lies, up to rounding
};

/// Zeros of a function that is holomorphic but for simple poles, and those poles, by the argument principle: where the
/// argument turns around a triangle, or cannot be followed along its edges (a zero or pole lies on them), Newton's
/// method finds the zeros, with those that are known divided out, until their orders account for what the argument
/// turns around all of that. The order of each is what the argument turns on a circle about it, of a fiftieth of the
/// shortest edge there: zeros that lie within it count as one.
///
/// The triangles have to resolve the function: along an edge along which it does not change by half its size it is
/// taken to turn no further. Poles at other places than @p poles are not found.
/// @param poles points of the triangles at which the function may have a simple pole, ascending
/// @param cuts  points, ascending, on curves across which the function may jump: next to these zeros are found only
///              where the argument can be followed around them
/// @return by triangles
std::vector<PlaneZero> zeros_and_poles_in(const PlaneTriangles& region, const PlaneFunction& f,
                                          const std::vector<int>& poles, const std::vector<int>& cuts = {});

/// Barycentric coordinates of a point of the plane.
std::array<double, 3> barycentric(const std::array<Complex, 3>& triangle, Complex point);

/// What the argument of a function turns on a circle, counter-clockwise, in whole turns; nothing where it cannot be
/// followed.
std::optional<int> turns_on_circle(const PlaneFunction& f, Complex centre, double radius);

}  // namespace beltrami
