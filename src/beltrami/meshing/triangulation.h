#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

namespace beltrami {

/// A constrained Delaunay triangulation that grows by insertion: the engine under triangulate(). It fills a large
/// square whose four corners are the vertices 0 … 3; every other vertex is the caller's. All decisions use exact
/// predicates.
class Triangulation {
  public:
    /// Edge i of a triangle lies opposite its vertex i, from vertex i+1 to vertex i+2.
    struct Triangle {
        std::array<int, 3> vertices;    ///< counter-clockwise
        std::array<int, 3> neighbours;  ///< triangle across edge i, -1 outside the square
        std::array<int, 3> curves;      ///< curve that edge i is a part of; -1: not constrained
        bool inside = false;            ///< belongs to the domain (see mark_inside)
    };
    struct Edge {
        int triangle = -1;
        int index = 0;
    };
    static constexpr int corner_count = 4;

    /// An empty square, much larger than the box low … high.
    Triangulation(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

    const std::vector<Eigen::Vector2d>& points() const { return points_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    const Triangle& triangle(int t) const { return triangles_[t]; }
    const Eigen::Vector2d& point(int vertex) const { return points_[vertex]; }
    /// Some triangle of the vertex.
    int triangle_of(int vertex) const { return triangle_of_[vertex]; }
    static int next(int i) { return i == 2 ? 0 : i + 1; }
    static int previous(int i) { return i == 0 ? 2 : i - 1; }

    /// The triangle that contains p (possibly on its border), found by walking from @p hint.
    /// @pre p lies in the square
    int locate(const Eigen::Vector2d& p, int hint) const;
    /// Inserts a point and restores the Delaunay property.
    /// @param triangle one that contains p
    /// @return the new vertex, or the vertex that is there already
    int insert(const Eigen::Vector2d& p, int triangle);
    /// Splits an edge at a point on it or so near that both sides stay counter-clockwise; the halves keep its curve.
    /// @return the new vertex, or -1 (and nothing done) if a triangle would turn over
    int split_edge(Edge edge, const Eigen::Vector2d& p);
    /// Splits a triangle without restoring the Delaunay property elsewhere.
    int insert_inside(const Eigen::Vector2d& p, int triangle);
    /// Makes the edges between a and b (several, if vertices lie on the way) parts of a curve. Delaunay is not
    /// restored.
    /// @throw Error bad_option if the segment crosses a constrained one
    void constrain(int a, int b, int curve);
    /// Flips edges until the triangulation is constrained Delaunay.
    void restore_delaunay();
    /// Replaces the edge by the other diagonal of its two triangles.
    /// @pre unconstrained, with a neighbour; the two triangles form a strictly convex quadrangle
    void flip(Edge edge);
    bool is_convex(Edge edge) const;
    /// A triangle is inside if a path from the square's border to it crosses an odd number of constrained edges.
    void mark_inside();
    /// The edge from a to b as an edge of the triangle on its left; triangle -1 if there is none.
    Edge find_edge(int a, int b) const;
    /// The same edge, seen from its other triangle.
    Edge twin(Edge edge) const;
    /// Triangles around a vertex, counter-clockwise. @pre not a corner of the square
    void star(int vertex, std::vector<int>& triangles) const;
    /// Moves a vertex. @pre no triangle of its star turns over
    void move(int vertex, const Eigen::Vector2d& p) { points_[vertex] = p; }

  private:
    int add_vertex(const Eigen::Vector2d& p);
    int add_triangle(const Triangle& triangle);
    void link(int t, int index, int neighbour, int curve);
    void legalize(std::vector<int>& stack, int vertex);
    int index_of(int t, int vertex) const;
    int neighbour_index(int t, int neighbour) const;
    Eigen::Vector2d corner(int t, int i) const { return points_[triangles_[t].vertices[i]]; }

    std::vector<Eigen::Vector2d> points_;
    std::vector<Triangle> triangles_;
    std::vector<int> triangle_of_;
};

}  // namespace beltrami
