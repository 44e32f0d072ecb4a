#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/topology.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The point of a face corner; z = 0 for two columns.
inline Eigen::Vector3d corner_point(const Positions& corners, int corner) {
    return {corners(corner, 0), corners(corner, 1), corners.cols() > 2 ? corners(corner, 2) : 0.0};
}

/// A surface in triangles, with edge lengths as logarithms relative to exp(log_unit), so that its size never matters.
struct TriangleMetric {
    FaceList triangles;
    std::vector<int> faces;           ///< of the surface, per triangle
    std::vector<double> log_lengths;  ///< per triangle corner, of the edge to the next one
    double log_unit = 0;
    double lengthened = 0;  ///< added to every edge to give triangles without area some; 0 as a rule
};

/// The metric in which every face has the shape of its corner points (#corners×2 or ×3); where two faces differ about
/// their edge, it has the mean length. Quads are split by split_quad(). Triangles without area (or coinciding vertices)
/// make all edges longer by about 1e-10 of their mean (Sharp, Crane 2020, "A Laplacian for nonmanifold triangle
/// meshes", intrinsic mollification).
/// @throw Error bad_mesh if all corners coincide, or naming faces where mean lengths violate the triangle inequality by
///        1e-4 or more
TriangleMetric triangle_metric(const Mesh& surface, const Topology& shape, const Positions& corners);

}  // namespace beltrami
