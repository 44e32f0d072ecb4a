#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/complex.h>
#include <beltrami/mesh/mesh.h>

/// Meshes of planar domains for maps that are not smooth at given places.
namespace beltrami::bench {

/// The outer boundary of a domain: a closed curve by t in 0 ≤ t ≤ 1, counter-clockwise, its speed never 0.
struct OuterCurve {
    std::function<Complex(double)> at;
    std::vector<double> ends = {0};  ///< ascending in 0 ≤ t < 1: vertices of the mesh, corners may be there
};
/// The unit circle, with vertices at these angles.
OuterCurve unit_circle(std::vector<double> angles = {});

struct RoundHoleOf {
    Complex centre;
    double radius;
};

/// Where meshes are fine.
struct GradedPlaces {
    std::vector<Complex> pins;         ///< inside: the first vertices of the mesh
    std::vector<Complex> transitions;  ///< on the boundary
    std::vector<RoundHoleOf> holes;    ///< round, with edges of 2π/40 of their radius or shorter
    double hole_edge = 1;              ///< … of this part of the others
};

/// Edges are h, but finer towards pins and transitions. There an extremal map is like the distance r and φ like 1/r: on
/// edges g(r) the map has interpolation errors g²/r, those of μ are g/r, and with them comes ∫(g/r)² dr to the
/// differences of k and of φ. For a number of triangles ∫r/g² dr that is least for g = h r^(3/4); and the triangles at
/// the place itself, which know nothing of the map, weigh as much as they are long: at transitions that is h²/10.
Mesh graded_mesh(double edge_length, const OuterCurve& outer, const GradedPlaces& fine);

}  // namespace beltrami::bench
