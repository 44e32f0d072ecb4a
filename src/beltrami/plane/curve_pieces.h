#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/plane/closed_spline.h>
#include <beltrami/plane/segment_tree.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami::detail {

/// "(x, y)", for sentences.
std::string at_place(Complex p);

/// What a TargetCurve shares with its copies: the pieces of which it is made, arcs of a circle, sides or cubics, and a
/// tree of boxes over them in which nearest points and windings are found.
struct CurvePieces {
    using Kind = TargetCurve::Kind;

    /// A run of consecutive pieces; its first half follows it.
    struct Run {
        SegmentTree::Box box;
        int first, last;
        int second = 0;  ///< the second half; 0: one piece alone
    };

    Kind kind = Kind::circle;
    Complex centre;
    double radius = 0;
    bool counter_clockwise = true;
    std::vector<Complex> points;
    std::vector<double> knots;
    std::vector<double> ends;     ///< 0 = s_0 < … < s_n = length of the pieces
    std::vector<Cubic> cubics;    ///< of a spline, one a piece
    std::vector<Complex> joints;  ///< where pieces begin, and where the last one ends
    std::vector<double> widths;   ///< how far a piece may be from its chord
    std::vector<Run> runs;
    double area = 0;

    double length() const { return ends.back(); }
    int piece_count() const { return static_cast<int>(ends.size()) - 1; }
    /// The piece at a parameter, 0 ≤ s ≤ length().
    int piece_at(double s) const;
    Complex side(int piece) const { return joints[piece + 1] - joints[piece]; }

    /// From the kind, the circle or the points and the direction everything else.
    /// @throw Error bad_option if a spline has a cusp
    void follow();
    /// @pre 0 ≤ s ≤ length(), as for hint
    CurvePlace at(double s) const;
    double nearest(Complex p, std::optional<double> hint) const;
    /// The angle by which the direction from a point turns along the whole curve.
    double turning(Complex p) const { return turning(0, p); }

  private:
    struct Nearest;
    int build(int first, int last);
    double parameter_on(int piece, double s) const;
    void nearest_on(int piece, Complex p, Nearest& best) const;
    double turning_on(double begin, double end, Complex a, Complex b, Complex p, int depth) const;
    double turning(int run, Complex p) const;
};

}  // namespace beltrami::detail
