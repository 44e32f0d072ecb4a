#pragma once

#include <array>
#include <vector>

#include <beltrami/curves/curve_mesh.h>

namespace beltrami {

/// A point where a path meets the mesh: a vertex (b is −1), or the point (1 − t) a + t b of an edge that it crosses
/// into the triangle to the left of the edge from a to b.
struct PathNode {
    int a = -1, b = -1;
    double t = 0;
    Eigen::Vector3d point;
};

/// The geodesic between two vertices that is found from the shortest path along edges: locally shortest, a straight
/// line where the triangles that it crosses are laid out in the plane. Where it bends at a vertex both ways around the
/// vertex are tried, by pulling the path taut in the strip of triangles on that side (the funnel of Lee and Preparata
/// 1984); the shorter one is kept until no vertex lets it become shorter. Source: Xin and Wang 2007, "Efficiently
/// determining a locally exact shortest path on polyhedral surfaces"; the strips need no flips of edges, so that the
/// nodes lie on the mesh as it is.
/// @return the nodes, both ends included
/// @throw Error bad_boundary if no edges lead from one to the other
std::vector<PathNode> straight_path(const CurveMesh& mesh, int from, int to);

}  // namespace beltrami
