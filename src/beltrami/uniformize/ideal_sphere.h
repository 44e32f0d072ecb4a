#pragma once

#include <optional>
#include <vector>

#include <beltrami/mesh/topology.h>
#include <beltrami/uniformize/conformal_equivalence.h>
#include <beltrami/uniformize/ideal_triangulation.h>

namespace beltrami {

/// The convex polyhedron inscribed in the sphere that a closed surface is conformally equivalent to, before it is
/// centred.
struct IdealSphere {
    IdealTriangulation triangulation;  ///< edges of the polyhedron, if there are no coplanar faces
    ScaleFactors factors;
    Eigen::VectorXcd plane;  ///< #V stereographic images; that of the ideal vertex is at infinity and not set
    double layout_error = 0;

    /// Whether the iteration ended well, with a drawing that holds together.
    bool solved() const;
};

/// Solves for one ideal vertex.
/// @param triangulation of the surface, Delaunay
/// @param used #V flags of vertices in triangles
/// @throw Error not_solved as solve_scale_factors
IdealSphere ideal_sphere(const IntrinsicTriangulation& triangulation, int ideal_vertex, const std::vector<char>& used,
                         double tolerance, int max_iterations);

/// Vertices that can be sent to infinity, best first: with even, flat stars of five or more edges near the centroid.
/// What is found does not depend on the choice, its rounding does.
std::vector<int> ideal_candidates(const IntrinsicTriangulation& triangulation, const Positions& positions);

}  // namespace beltrami
