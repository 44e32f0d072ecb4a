#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

namespace detail {
struct CurvePieces;
}

/// Where a curve passes at a parameter, and how.
struct CurvePlace {
    Complex point;
    Complex tangent;    ///< γ'(s), of length 1
    Complex curvature;  ///< γ''(s): across the tangent, 1/radius long; 0 on sides of polygons
};

/// A simple closed curve in the plane by its arc length s, in the units of the plane. Parameters are taken modulo
/// length(). Every curve is made counter-clockwise; reversed() runs the other way, as the holes of a domain do so that
/// the domain is on the left. A value: copies share their data and may be read by several threads.
///
/// At the corners of a polygon tangent(s) is the direction of the side that begins there, tangent_before(s) that of the
/// side that ends there; elsewhere both are the same.
class TargetCurve {
  public:
    enum class Kind { circle, polygon, spline };

    /// s = 0 at centre + radius.
    /// @throw Error bad_option unless the centre is finite and the radius positive
    static TargetCurve circle(Complex centre, double radius);

    /// @param corners at least 3, in either direction, not repeating the first; s = 0 at the first
    /// @throw Error bad_option if corners are too few, not finite or neighbours coincide, or sides meet (both named)
    static TargetCurve polygon(const std::vector<Complex>& corners);

    /// The closed twice differentiable cubic spline through points, its knots spaced like the chords: of fourth order
    /// in the spacing of points on a smooth curve.
    /// @param points at least 3, in either direction, not repeating the first; s = 0 at the first
    /// @throw Error bad_option as for polygon, or if the spline has a cusp
    static TargetCurve spline(const std::vector<Complex>& points);

    Kind kind() const;
    double length() const;
    /// Area enclosed, positive whichever way the curve runs.
    double area() const;
    bool counter_clockwise() const;
    /// The same curve the other way round, made anew: its point(s) is point(−s) of this one.
    TargetCurve reversed() const;

    /// The parameter in 0 ≤ s < length().
    double wrap(double s) const;
    /// Arc length from one place forward to another, in 0 ≤ . < length().
    double ahead(double from, double to) const { return wrap(to - from); }

    Complex point(double s) const { return at(s).point; }
    Complex tangent(double s) const { return at(s).tangent; }
    Complex tangent_before(double s) const;
    Complex curvature(double s) const { return at(s).curvature; }
    CurvePlace at(double s) const;

    /// Parameter of the point of the curve nearest to @p p, of the whole curve; logarithmic time in its pieces.
    /// @param hint a parameter near the result makes the search faster, and is kept where several points are nearest
    double nearest(Complex p, std::optional<double> hint = {}) const;

    /// How often the curve runs around a point: 1 or −1 inside, 0 outside. @pre the point is not on the curve
    int winding(Complex p) const;
    bool contains(Complex p) const { return winding(p) != 0; }

    /// Parameters of the corners that turn by more than @p min_turn (radians), ascending; none on circles and splines.
    std::vector<double> corners(double min_turn = 1e-9) const;
    /// Parameters of points() in their order, beginning with 0; none on a circle.
    const std::vector<double>& knots() const;
    /// What the curve was made of, in the direction in which it runs: corners of the polygon, points of the spline.
    const std::vector<Complex>& points() const;
    /// @pre kind() is circle
    Complex centre() const;
    double radius() const;

    /// Ends 0 = s_0 < … < s_n = length() of pieces without corners, each turning by less than 60°.
    const std::vector<double>& piece_ends() const;
    /// The diagonal of a box around the curve.
    double diameter() const;

  private:
    explicit TargetCurve(std::shared_ptr<const detail::CurvePieces> data) : data_(std::move(data)) {}
    static TargetCurve through(Kind kind, const std::vector<Complex>& points);

    std::shared_ptr<const detail::CurvePieces> data_;
};

}  // namespace beltrami
