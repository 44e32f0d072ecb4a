#pragma once

// What the problem files share.

#include <functional>
#include <string>
#include <vector>

#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/planar_domains.h>

#include "problems/homeomorphism.h"
#include "problems/problems.h"

namespace beltrami::bench {

/// x + iy of a vertex of a planar mesh.
inline Complex place(const Mesh& mesh, int vertex) {
    return {mesh.positions(vertex, 0), mesh.positions(vertex, 1)};
}
inline Eigen::Vector2d point(Complex z) {
    return {z.real(), z.imag()};
}

/// f at every vertex of a planar mesh.
Eigen::VectorXcd values(const Mesh& mesh, const PlaneMap& f);

/// A planar mesh with f as boundary values on every loop.
Problem with_boundary_values(std::string name, std::string statement, Mesh mesh, const PlaneMap& f);
/// The same with a known homeomorphism f that has these boundary values: f is the witness.
Problem with_homeomorphism(std::string name, std::string statement, Mesh mesh, const PlaneMap& f);
/// The same where f is the extremal map and k its dilatation.
Problem with_exact_map(std::string name, std::string statement, Mesh mesh, const PlaneMap& f, double k);

/// Boundary values that take each of the given vertices of a loop (in the loop's order) to the corner beside it, the
/// vertices in between by arc length along straight sides.
void pin_sides(BoundaryCondition& boundary, const Mesh& mesh, const std::vector<int>& loop,
               const std::vector<int>& vertices, const std::vector<Complex>& corners);

/// The vertex at a place, to 1e-9.
/// @throw Error bad_option if there is none
int vertex_at(const Mesh& mesh, Complex place);

}  // namespace beltrami::bench
