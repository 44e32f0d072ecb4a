#pragma once

#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/certificate/quadratic_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Maps that are quadratic on triangles, with power elements around cone points: what a verified upper bound of K* is
/// made of. Nodes are the vertices, then the midpoints of topology's edges, as for QuadraticMap.
///
/// Around an inner vertex v whose angles sum to Θ ≠ 2π no map that is differentiable there is better than
/// max(2π/Θ, Θ/2π). On the triangles at v the map is instead
///
///     f = f_v + ρ^γ (f_edge(s) − f_v),   γ = 2π/Θ,
///
/// ρ the distance from v relative to the opposite edge, s the place where the ray from v meets it, f_edge quadratic. It
/// is linear in the nodes, continuous, and its coefficient depends on s only. Midpoints of edges at v have no part.
class QuadraticSpace {
  public:
    /// @param cones inner vertices that get power elements; no two share a triangle
    /// @param source is kept by reference
    /// @pre all faces are triangles
    QuadraticSpace(const Surface& source, const std::vector<int>& cones);

    int node_count() const { return samples_.vertex_count; }
    /// Places at which ∂ and ∂̄ are looked at: corners and midpoints of a triangle, seven rays of a power element.
    /// Their gradients are those of the nodes.
    const Operators& samples() const { return samples_; }
    /// Samples of a face: [first, last).
    int first_sample(int face) const { return first_[face]; }
    /// γ of the vertex in whose power element a face lies; 0: none.
    double power(int face) const { return power_[face]; }
    /// #nodes: midpoints that have no part.
    const std::vector<char>& idle() const { return idle_; }

    /// A number that |μ| exceeds nowhere on each face (#F), proved by Bernstein coefficients of |∂̄f|² − k²|∂f|² up to
    /// rounding, with subdivision where they are larger than what is attained anywhere; infinite where ∂f is not
    /// proved to be different from 0. A map with boundary values of degree 1 that is below 1 everywhere is one-to-one.
    std::vector<double> bounds(const QuadraticMap& map) const;

    /// The value of the map in a face.
    /// @param place barycentric coordinates of the face's corners
    Complex value(const QuadraticMap& map, int face, const std::array<double, 3>& place) const;

  private:
    const Surface& source_;
    Operators samples_;
    std::vector<int> first_;
    std::vector<double> power_;
    std::vector<int> apex_;  ///< #F corner (0, 1, 2) of the cone vertex, −1: none
    std::vector<char> idle_;
};

/// Inner vertices at which angles do not sum to 2π, with the stretch max(2π/Θ, Θ/2π) that a smooth map has there.
struct ConePoint {
    int vertex;
    double stretch;
};
std::vector<ConePoint> cone_points(const Surface& source);

}  // namespace beltrami
