#pragma once

#include <functional>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami::bench {

/// A smooth function of space, negative inside.
using Level = std::function<double(const Eigen::Vector3d&)>;

/// Where a grid lies that a surface is meshed on: other grids make other triangulations.
struct LevelGrid {
    double edge_length = 0.1;
    Eigen::Vector3d low, high;                         ///< of a box about the surface
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< in edges of the grid
    double turn = 0;                                   ///< about the vertical through the box's middle, radians
};

/// The surface on which a function is 0, by marching tetrahedra, its vertices then evened along it. Nothing is
/// simplified: triangles have few angles that are small.
Mesh level_surface(const Level& level, const LevelGrid& grid);

/// A function of x, by which y is multiplied.
using Stretch = std::function<double(double)>;

/// (x(x − 1)²(x − 2) + y²)² + z² = .027, genus 2, its y multiplied by stretch(x).
/// @param other another triangulation: the grid is turned and moved
Mesh level_double_torus(double edge_length, const Stretch& stretch, bool other);

/// Three rings of radius ½ melted together, genus 3: −log Σ exp(−12 d²)/12 = .04, d the distances to circles about
/// (0, 0), (1.1, 0), (2.2, 0), or about three places at distance .66 of (1.1, 0); y multiplied by stretch(x).
Mesh three_rings(bool in_a_row, double edge_length, const Stretch& stretch, bool other);

/// A mesh in triangles with every edge inside replaced: face centres are added and joined across the edges (Kobbelt
/// 2000). Vertices stay where they are.
Mesh root_three_refined(const Mesh& mesh);

}  // namespace beltrami::bench
