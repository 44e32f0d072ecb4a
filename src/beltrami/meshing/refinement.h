#pragma once

#include <array>
#include <queue>
#include <utility>
#include <vector>

#include <beltrami/meshing/delaunay.h>
#include <beltrami/meshing/triangulation.h>

namespace beltrami {

/// Delaunay refinement of the inside of a constrained triangulation; used by triangulate().
class Refinement {
  public:
    /// @param curve_ends for each curve its two end vertices, or {-1, -1} for a closed one
    Refinement(Triangulation& triangulation, const PlanarDomain& domain, const TriangulateOptions& options,
               std::vector<std::array<int, 2>> curve_ends);

    /// Splits segments and triangles until sizes and angles are as wanted.
    void refine();
    /// Moves interior vertices towards better angles; the triangulation stays Delaunay.
    void smooth();
    /// Removes triangles with three boundary vertices.
    void split_ears();

  private:
    using Edge = Triangulation::Edge;
    struct Candidate {
        double badness;
        int triangle;
        std::array<int, 3> vertices;  // to see whether the triangle still is the one that was queued
        bool operator<(const Candidate& other) const {
            return std::pair(badness, other.triangle) < std::pair(other.badness, triangle);
        }
    };

    double wanted_size(const Eigen::Vector2d& p) const;
    double badness(int t) const;
    bool is_across_sharp_corner(int u, int v) const;
    bool is_sharp(int corner) const;
    bool encroaches(const Eigen::Vector2d& p, int a, int b) const;
    void examine(int t);
    void examine_star(int vertex);
    void split_segments();
    bool split_segment(Edge edge);
    bool split_triangle(const Candidate& candidate);
    Edge first_segment_towards(int t, const Eigen::Vector2d& target, int& last) const;
    void require_room() const;
    void improve(int vertex);
    double star_quality(int vertex, const Eigen::Vector2d& p) const;
    double smallest_angle_cosine(const std::array<Eigen::Vector2d, 3>& p) const;
    bool is_on_boundary(int vertex) const { return curve_of_[vertex] != interior; }

    static constexpr int interior = -1;
    static constexpr int corner = -2;

    Triangulation& mesh_;
    const PlanarDomain& domain_;
    const TriangulateOptions& options_;
    std::vector<std::array<int, 2>> curve_ends_;
    std::vector<int> curve_of_;  // per vertex: its curve, interior or corner (end of curves)
    std::vector<char> sharp_;    // per input vertex: end of two curves at less than 60 degrees
    int input_count_ = 0;
    double floor_ = 0.0;        // no edge shorter than this is split
    double ratio_limit_ = 0.0;  // (shortest edge / circumradius)² at the angle limit
    std::priority_queue<Candidate> bad_triangles_;
    std::vector<std::pair<int, int>> bad_segments_;
    mutable std::vector<int> star_;
};

}  // namespace beltrami
