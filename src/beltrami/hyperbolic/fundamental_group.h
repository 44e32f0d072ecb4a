#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/hyperbolic/equivariant_map.h>

namespace beltrami {

/// A step together with its homology class.
struct MarkedStep {
    DiskIsometry isometry;
    Eigen::RowVectorXi homology;

    MarkedStep operator*(const MarkedStep& other) const {
        return {isometry * other.isometry, homology + other.homology};
    }
    MarkedStep inverse() const { return {isometry.inverse(), -homology}; }
};

/// How far a step is from the identity, its homology included.
double not_closed(const MarkedStep& step);

/// A triangulated closed surface cut open: a tree of vertices, a tree of triangles across other edges, and the 2g edges
/// in neither, each of which closes a loop through the root.
struct CutTree {
    int root = 0;
    std::vector<int> to_vertex;    ///< #V the half-edge of the tree that ends there; −1 at the root
    std::vector<int> order;        ///< vertices, from the root on
    std::vector<int> to_triangle;  ///< #triangles the half-edge of a triangle that is glued to the one before; −1: root
    std::vector<int> triangle_order;
    std::vector<int> generators;  ///< half-edges, each the smaller of its two
};

/// @param costs #halfedges: the tree of vertices takes cheap edges, that of triangles dear ones
/// @param first half-edges that are to be in the tree of vertices, if they close no loop
/// @param barred flags of half-edges (both of an edge) that neither tree takes; empty: none
CutTree cut_tree(const IntrinsicTriangulation& triangulation, int root, const std::vector<double>& costs,
                 const std::vector<int>& first = {}, const std::vector<char>& barred = {});

/// The tree of shortest paths from the root and, across the others, that of the longest loops (Erickson, Whittlesey
/// 2005): generators are short.
/// @param lengths #halfedges; infinite where no path is to go
CutTree short_cut_tree(const IntrinsicTriangulation& triangulation, const std::vector<double>& lengths, int root);

/// The same of a surface with a boundary, within the doubled triangulation that its metric has: there are 1 − χ
/// generators, free. Triangles and what is outside the surface are joined in one tree; triangle_order is empty.
CutTree short_cut_tree_with_boundary(const HyperbolicSurface& metric, const std::vector<double>& lengths, int root);

/// Lengths of the half-edges of a metric's own triangles that are edges of the surface; infinite of diagonals of quads,
/// and of mirror images.
std::vector<double> edge_lengths(const Topology& topology, const HyperbolicSurface& metric);

/// The loops of the generators as closed paths of vertices through the root: along the tree, across, and back.
std::vector<std::vector<int>> generator_paths(const IntrinsicTriangulation& triangulation, const CutTree& tree);

/// A letter of a word: a generator, or its inverse.
struct Letter {
    int generator;
    bool inverse;
    bool operator==(const Letter&) const = default;
};

/// The boundary of the surface cut open along the loops: a word that is 1 in the fundamental group.
std::vector<Letter> boundary_word(const IntrinsicTriangulation& triangulation, const CutTree& tree);

/// The isometries of the generators, in the frame of the root.
/// @param steps #halfedges
std::vector<DiskIsometry> generator_isometries(const IntrinsicTriangulation& triangulation, const CutTree& tree,
                                               const std::vector<DiskIsometry>& steps);

/// Steps across the tree of triangles from all others, by the flatness of the triangles.
/// @param steps #halfedges of the source's triangles
/// @return how far the product around the root triangle is from 1: 0 but for rounding where the others agree
double fill_by_flatness(const IntrinsicTriangulation& triangulation, const CutTree& tree,
                        std::vector<MarkedStep>& steps);

/// A map's steps per half-edge of the source's triangles, and back.
std::vector<MarkedStep> halfedge_steps(const Surface& source, const EquivariantMap& map);
/// Where the source has a boundary, those of its double too: along mirror images the mirror images.
std::vector<MarkedStep> with_mirror_images(std::vector<MarkedStep> steps, const Topology& source);
void set_halfedge_steps(const Surface& source, const std::vector<MarkedStep>& steps, EquivariantMap& map);

}  // namespace beltrami
