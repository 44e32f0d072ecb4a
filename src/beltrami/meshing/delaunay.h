#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A region of the plane bounded by closed chains of segments that neither cross nor touch: one or more outer ones and
/// holes. A place is inside if it is enclosed by an odd number of chains.
struct PlanarDomain {
    std::vector<Eigen::Vector2d> points;       ///< ends of the segments, and points wanted as vertices in the interior
    std::vector<std::array<int, 2>> segments;  ///< pairs of points
    std::vector<int> curves;  ///< curve of each segment, from 0: segments of a curve have no corner between them
    /// Nearest place on a curve, for the vertices that split its segments; empty: the segments are straight.
    std::function<Eigen::Vector2d(int curve, const Eigen::Vector2d& p)> project = {};
};

/// The desired edge length at a place, positive, in the units of the points.
using SizeField = std::function<double(const Eigen::Vector2d&)>;

struct TriangulateOptions {
    SizeField size = {};       ///< desired edge length; empty: only the angles matter
    double min_angle = 0.489;  ///< radians (28 degrees), wherever the domain has no smaller angle; at most 30 degrees
    int smoothing_passes = 6;  ///< rounds of moving interior vertices where that improves the smallest angle
    bool split_ears = true;    ///< avoid triangles with three boundary vertices, except in corners below 40 degrees
    int max_vertices = 20'000'000;  ///< refinement beyond this is an error
    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// Triangulates a planar domain: constrained Delaunay, refined (Ruppert 1995) until every triangle is smaller than the
/// size field asks for and no angle is below min_angle. Segments that meet in a sharp corner are split on circles
/// around it, and the angle of the corner itself is accepted, so refinement ends for any input. Without a size field
/// and with min_angle = 0 nothing is refined: the constrained Delaunay triangulation of the given points.
/// @return #V×2 mesh, counter-clockwise; vertices: the given points in their order, then the added ones
/// @throw Error bad_option if points coincide, lie outside or segments cross; not_solved beyond max_vertices
Mesh triangulate(const PlanarDomain& domain, const TriangulateOptions& options = {});

/// Parameters 0 = t_0 < … < t_n = 1 that cut a curve of the given length into pieces as long as the size field wants.
/// @param size  desired edge length at a parameter in [0, 1]
/// @param least smallest number n of pieces
/// @throw Error bad_option if that makes more than 100 million pieces, or sizes are not positive
std::vector<double> spread(double length, const std::function<double(double)>& size, int least = 1);

}  // namespace beltrami
