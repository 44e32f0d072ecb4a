#pragma once

#include <Eigen/Core>

#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {

/// A flat metric drawn in the plane.
struct Layout {
    Eigen::VectorXcd positions;  ///< #V; 0 at vertices without triangles
    double error = 0;  ///< largest | |z_i − z_j| − l_ij | over all edges, relative to the drawing's diameter
};

/// Draws the triangulation, scaled by u, breadth first from the triangle with the longest edge. Directions are carried
/// as angles and lengths taken afresh from the metric, so that crossing tiny triangles costs no digits. The mean of the
/// drawn points is 0.
/// @pre simply connected, connected, angle sum 2π at interior vertices
Layout lay_out(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& u);

}  // namespace beltrami
