#pragma once

#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The places of a surface that a chart maps to given points: face, three of its vertices, barycentric coordinates.
/// A point outside the chart's polygons, as between a chord and its arc, takes the nearest place of the boundary.
/// @param points    finite
/// @param tolerance how far outside a point may lie, relative to the diameter of the chart
/// @throw Error bad_boundary naming the points that lie farther outside
std::vector<MeshPoint> locate_in_chart(const Surface& surface, const Eigen::VectorXcd& chart,
                                       std::span<const Complex> points, double tolerance = 0.05);

/// Positions of places of a mesh: one row a place, as many columns as the mesh has.
Positions positions_on(const Mesh& mesh, std::span<const MeshPoint> places);

/// A place on a boundary loop: on the edge from vertex @ref edge of the loop to the next one.
struct BoundaryPlace {
    int loop = 0;
    int edge = 0;         ///< index into topology.boundary_loops[loop]
    double fraction = 0;  ///< of the edge, 0 ≤ fraction < 1
};

/// The place of a loop that a circle-domain chart maps to the point at @p angle (radians) of its circle: edges are run
/// through at even angular speed.
BoundaryPlace boundary_place(const Surface& surface, const CircleDomainChart& chart, int loop, double angle);

/// The same place as a point of the face beside the edge.
MeshPoint mesh_point(const Surface& surface, const BoundaryPlace& place);

}  // namespace beltrami
