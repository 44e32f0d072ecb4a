#pragma once

#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/forms/homology.h>
#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/hyperbolic/nearest_vertices.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What a class of maps onto a surface is told by: a step for every half-edge, with its homology. Of a torus, whose
/// deck transformations are told by homology alone, the steps are identities.
struct EdgeGroup {
    const IntrinsicTriangulation& triangulation;  ///< doubled where the surface has a boundary
    const std::vector<DiskIsometry>& steps;       ///< #halfedges
    const Topology& topology;
    const HomologyBasis& homology;
};

/// A homotopy class of maps between two surfaces, as a map in it. Boundary loops go to boundary loops, and slide.
struct Marking {
    EquivariantMap map;
    int mended = 0;     ///< faces around which the images did not close up, until edges there were led another way
    double defect = 0;  ///< what is left: above 1e-6 there is no such map
};

/// The class of a map that takes every vertex near a vertex of the target: edges go along the shortest paths of edges
/// between these, boundary edges the shorter way along the boundary. Faces whose images do not close up are mended
/// where the others allow it: edges near them are led as those farther off say.
/// @param source of triangles, @param triangulation of it, doubled where it has a boundary
/// @param images #V vertices of the target, of a boundary loop on one boundary loop
/// @throw Error bad_mesh for faces of the source that are not triangles; bad_option where the images contradict each
///        other, naming the faces and saying the defect, or where those of a boundary edge lie on no common loop
Marking marking_by_vertices(const Surface& source, const IntrinsicTriangulation& triangulation, const EdgeGroup& target,
                            const std::vector<int>& images);

/// The class of maps between closed surfaces that takes loops to loops: 2g closed paths of vertices of the source
/// through one vertex, whose union cuts it open to a disk (generators of its fundamental group, as those of cut_tree),
/// and as many of the target.
/// @param paths, images 2g each, each beginning with its common vertex; of the source each has one edge more than its
///                      part of a tree, beside those before it
/// @throw Error bad_option where the paths are none or do not cut the source open, or where the images contradict each
///        other, with the defect
Marking marking_by_loops(const Surface& source, const IntrinsicTriangulation& triangulation, const EdgeGroup& target,
                         const std::vector<std::vector<int>>& paths, const std::vector<std::vector<int>>& images);

/// The class after as many Dehn twists of the source about a simple closed path, to the left if positive.
/// @param path closed, of vertices of the source, no vertex twice; where it meets the boundary, about a curve beside it
/// @throw Error bad_option for a path that is none
EquivariantMap twisted(const Surface& source, const IntrinsicTriangulation& triangulation, EquivariantMap map,
                       const std::vector<int>& path, int turns);

}  // namespace beltrami
