#pragma once

#include <array>
#include <vector>

#include <beltrami/constraints/boundary_corners.h>

namespace beltrami::detail {

/// Edges that a window has at most on each side.
inline constexpr int kWindow = 32;

/// One boundary loop laid out in the plane, and its images.
struct Outline {
    std::vector<int> vertices;
    std::vector<double> angles;      ///< interior, the sum over the faces' corners in the metric
    std::vector<Complex> developed;  ///< #n + 2·reach positions; vertex i stands at i + reach, and repeats around
    std::vector<Complex> images;     ///< #n
    std::vector<char> prescribed;    ///< #n
    std::array<double, 3> noise{};   ///< displacement (source, image, source units) that residuals show everywhere
    int reach = 1;                   ///< edges that windows have at most

    int size() const { return static_cast<int>(vertices.size()); }
};

/// The outlines of all loops, without noise.
std::vector<Outline> outlines(const Surface& source, const BoundaryCondition& boundary);

/// How far a window may reach on both sides of a vertex, in edges.
struct Reach {
    int out, in;
};

/// One kind of jump, in one window.
struct Jump {
    double value = 0;    ///< π − α, π − β, log(c2/c1) or p − 1
    double sigma = 0;    ///< its standard deviation
    double allowed = 1;  ///< its threshold
    bool known = false;
};

/// A fit over one window: jumps of the source's direction, the image's direction, the speed, and the exponent.
struct WindowFit {
    std::array<Jump, 4> jumps;
    std::array<double, 3> residual{};  ///< displacements that the first three fits leave; 0 without a degree of freedom
    std::array<double, 2> log_speed{};           ///< log c1 and log c2 for p = 1
    std::array<double, 2> log_speed_of_power{};  ///< the same for the exponent found
    bool power = false;                          ///< the exponent is needed to describe the data
};

/// Fits vertex @p position over @p scale edges to both sides. @pre scale ≤ outline.reach
WindowFit fit_window(const Outline& outline, int position, int scale, const CornerOptions& options);

/// What all windows say together (the loop is not set). A jump is as significant as its most significant window, but
/// no more than any window allows, measured jump plus deviations. Angles and speeds are those of the window with the
/// smallest deviation.
BoundaryCorner fit_corner(const Outline& outline, int position, Reach reach, const CornerOptions& options);

}  // namespace beltrami::detail
