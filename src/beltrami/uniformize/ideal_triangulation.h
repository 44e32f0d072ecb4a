#pragma once

#include <vector>

#include <beltrami/uniformize/scaled_surface.h>

namespace beltrami {

/// A closed surface of genus 0, one vertex of which, v∞, is sent to infinity: what flattens the others in the plane
/// makes a convex polyhedron inscribed in the sphere, by stereographic projection from v∞, whose faces are the
/// triangles. Chords of the sphere have l_ij e^{(u_i+u_j)/2}, with l_i∞ e^{u_i/2} the same constant e^c for all of them
/// in the plane; so a horocycle at infinity bounds u from below,
///
///     a_i = log l_i∞ + u_i/2 − c ≥ 0    for every arc (i, ∞).
///
/// Where the bound is met, vertices are on the link of v∞, the convex hull in the plane, and are held. The others are
/// free; angles are those of finite triangles, without v∞.
///
/// Source: Springborn 2020, "Ideal hyperbolic polyhedra and discrete uniformization" (the variational problem and its
/// bounds); Gillespie, Springborn, Crane 2021, "Discrete conformal equivalence of polyhedral surfaces" (flips).
class IdealTriangulation final : public ScaledSurface {
  public:
    /// @param triangulation closed, of genus 0
    /// @pre simple_stars(triangulation)[ideal_vertex]
    IdealTriangulation(IntrinsicTriangulation triangulation, int ideal_vertex);

    const IntrinsicTriangulation& triangulation() const override { return triangulation_; }
    int ideal_vertex() const { return ideal_; }
    /// Scale factors to start from: the bound on the link, else 0.
    Eigen::VectorXd start() const;
    /// The triangles that lie in the plane.
    IntrinsicTriangulation finite_part() const { return triangulation_.without(ideal_); }

    /// Rules of flips, all by Ptolemy's relation: an edge between two finite triangles whose opposite angles exceed π;
    /// an edge of the link beyond which a finite vertex lies, which joins the link and is raised to its bound; an arc
    /// that is not tight and not convex.
    int make_delaunay(Eigen::VectorXd& u) override;
    bool is_finite(int triangle) const override {
        const int h = 3 * triangle;
        return tail(h) != ideal_ && tail(h + 1) != ideal_ && tail(h + 2) != ideal_;
    }
    bool is_held(int vertex) const override { return vertex == ideal_ || on_link_[vertex]; }
    /// Flips the tight arcs of vertices that the polygon in the plane turns inwards at (angle sum above π), or that it
    /// passes more than once. The new triangle there is degenerate, with the angle π, until u has changed: nothing may
    /// be flipped before.
    int release(const Eigen::VectorXd& u) override;

  private:
    enum class Violation { none, finite, link, arc };

    static int next(int h) { return IntrinsicTriangulation::next(h); }
    static int previous(int h) { return IntrinsicTriangulation::previous(h); }
    int tail(int h) const { return triangulation_.tail(h); }
    int head(int h) const { return triangulation_.head(h); }
    int twin(int h) const { return triangulation_.twin(h); }
    bool is_arc(int h) const { return tail(h) == ideal_ || head(h) == ideal_; }
    /// a_i of an arc.
    double excess(int arc, const Eigen::VectorXd& u) const {
        return triangulation_.log_length(arc) + 0.5 * u[tail(arc) == ideal_ ? head(arc) : tail(arc)] - log_constant_;
    }
    void measure(int triangle, const Eigen::VectorXd& u);
    Violation violation(int h, const Eigen::VectorXd& u) const;
    bool link_violates(int finite_side, int ideal_side, const Eigen::VectorXd& u) const;
    bool arc_violates(int h, const Eigen::VectorXd& u) const;
    bool flip_finite(int h, const Eigen::VectorXd& u);
    void flip_link(int h, Eigen::VectorXd& u, std::vector<int>& changed);
    void find_link();

    IntrinsicTriangulation triangulation_;
    int ideal_;
    double log_constant_ = 0;      // c
    std::vector<char> on_link_;    // #V
    std::vector<double> cosines_;  // of the angle opposite each half-edge of a finite triangle
};

/// Vertices that can be sent to infinity: no edge there ends where it begins, and no two of them join the same
/// vertices, and there are three or more. #V flags.
std::vector<char> simple_stars(const IntrinsicTriangulation& triangulation);

}  // namespace beltrami
