#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Angles of a triangle given by its lengths.
struct TriangleAngles {
    std::array<double, 3> angles;      ///< angles[k] lies opposite length k, radians
    std::array<double, 3> cotangents;  ///< of the angles; all 0 if degenerate
    bool degenerate = false;           ///< the lengths violate the triangle inequality: the angles are π, 0 and 0
};

/// Angles from the logarithms of the three lengths, by half-angle formulas that keep their digits in needles.
/// Lengths that violate the triangle inequality give π opposite the longest one and 0 elsewhere: the continuous
/// extension of Springborn, Schröder, Pinkall 2008, "Conformal equivalence of triangle meshes".
TriangleAngles triangle_angles(const std::array<double, 3>& log_lengths);

/// Cosines of the angles opposite the three lengths, from their logarithms: (b² + c² − a²)/2bc, which makes sense
/// beyond ±1 too, where lengths violate the triangle inequality.
std::array<double, 3> triangle_cosines(const std::array<double, 3>& log_lengths);

/// A flip of an edge, as it must be known to be undone: its half-edges, and the logarithm of its length before.
struct EdgeFlip {
    int halfedge, twin;
    double log_length;
};

/// A triangulation of a surface that knows lengths only, so that its edges can be flipped without moving the surface.
///
/// Half-edge h = 3t + k is edge k of triangle t, from tail(h) to head(h), the triangle on its left. Edges may join a
/// vertex to itself and two edges may join the same vertices, as flips produce them. Boundary edges never flip.
/// Lengths are held as logarithms, so scale factors of any size neither overflow nor underflow.
class IntrinsicTriangulation {
  public:
    /// @param triangles   triangles only, a coherently oriented manifold
    /// @param log_lengths #corners: log of the length from each corner's vertex to the next one of its triangle; both
    ///                    sides of an edge must agree
    IntrinsicTriangulation(const FaceList& triangles, int vertex_count, std::vector<double> log_lengths);

    int vertex_count() const { return vertex_count_; }
    int triangle_count() const { return static_cast<int>(tails_.size()) / 3; }
    int halfedge_count() const { return static_cast<int>(tails_.size()); }

    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    int tail(int h) const { return tails_[h]; }
    int head(int h) const { return tails_[next(h)]; }
    /// The same edge seen from the other side; -1 on the boundary.
    int twin(int h) const { return twins_[h]; }
    double log_length(int h) const { return log_lengths_[h]; }
    /// log of the length scaled by e^{(u_tail + u_head)/2}.
    double log_length(int h, const Eigen::VectorXd& u) const {
        return log_lengths_[h] + 0.5 * (u[tails_[h]] + u[head(h)]);
    }
    /// Logarithms of a triangle's lengths in the metric scaled by u.
    std::array<double, 3> log_lengths(int triangle, const Eigen::VectorXd& u) const {
        const int h = 3 * triangle;
        return {log_length(h, u), log_length(h + 1, u), log_length(h + 2, u)};
    }
    /// Angles of a triangle in the metric scaled by u; entry k belongs to half-edge 3t + k and lies opposite it.
    TriangleAngles angles(int triangle, const Eigen::VectorXd& u) const {
        return triangle_angles(log_lengths(triangle, u));
    }

    /// Flips edges, new lengths measured by unfolding the two triangles, until the triangulation is Delaunay: the
    /// surface stays what it is. @return the number of flips
    int make_delaunay() { return static_cast<int>(delaunay_flips().size()); }
    /// The same, every flip in its order.
    std::vector<EdgeFlip> delaunay_flips();

    /// Flips edges until the metric scaled by u is Delaunay; new lengths by Ptolemy's relation, which commutes with the
    /// scaling, so that the discrete conformal class stays what it is. Lengths need not satisfy the triangle
    /// inequality. Source: Springborn 2020, "Ideal hyperbolic polyhedra and discrete uniformization"; Gillespie,
    /// Springborn, Crane 2021, "Discrete conformal equivalence of polyhedral surfaces". @return the number of flips
    int make_delaunay(const Eigen::VectorXd& u) { return static_cast<int>(delaunay_flips(u).size()); }
    /// The same, every flip in its order.
    std::vector<EdgeFlip> delaunay_flips(const Eigen::VectorXd& u);

    /// The logarithm of the length that an edge has after a flip, by Ptolemy's relation.
    /// @pre two different triangles meet there
    double ptolemy_log_length(int h) const { return flipped_log_length(h, Rule::ptolemy); }

    /// Replaces an edge by the other diagonal of its two triangles: with h = i→j, apex k on its left and l on its
    /// right, h becomes l→k. The four sides of the quadrilateral move to other half-edges of the two triangles.
    /// @pre two different triangles meet there
    void flip(int h, double log_length);

    /// Puts the edge of the last flip that is not yet undone back, half-edges and all.
    void undo(const EdgeFlip& last) {
        for (int turn = 0; turn < 3; ++turn) flip(last.halfedge, last.log_length);
    }

    /// The triangulation less the triangles at a vertex, whose other edges then are boundary.
    IntrinsicTriangulation without(int vertex) const;

    /// The triangulation glued to its mirror image along the boundary, whose vertices it keeps. Triangle t + #triangles
    /// is the image of t, mirrored(h) that of half-edge h, running the other way; images of vertices inside follow in
    /// their order after vertex_count() of before.
    IntrinsicTriangulation doubled() const;
    /// The image of a half-edge of a triangulation that was doubled, in it, from the image of the head to that of the
    /// tail.
    /// @param halfedges of the triangulation before
    static int mirrored(int h, int halfedges) { return h - h % 3 + 2 - h % 3 + (h < halfedges ? 1 : -1) * halfedges; }

    /// Cuts the triangle at a boundary half-edge in two, from its apex to the foot of the perpendicular (to the middle
    /// of the edge if the foot is not well inside it): the surface stays what it is.
    /// @return the new vertex, numbered vertex_count() of before. The half-edge then ends there.
    int split_boundary(int h);

  private:
    enum class Rule { unfold, ptolemy };
    template <Rule rule>
    std::vector<EdgeFlip> flip_to_delaunay(const Eigen::VectorXd& u);
    IntrinsicTriangulation() = default;
    double flipped_log_length(int h, Rule rule) const;
    void glue(int h, int twin);

    int vertex_count_ = 0;
    std::vector<int> tails_;
    std::vector<int> twins_;
    std::vector<double> log_lengths_;
    std::vector<double> cosines_;  // of the angle opposite each half-edge; scratch of the flip algorithm
};

}  // namespace beltrami
