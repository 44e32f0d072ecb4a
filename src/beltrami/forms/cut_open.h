#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A closed surface cut open along edges into a disk: the same faces in the same order, with a vertex for each side of
/// the cut.
struct CutOpen {
    Mesh disk;  ///< positions are those of the vertices that were; no texture coordinates
    std::vector<int>
        vertices;  ///< of the surface, for each of the disk: all of it in order, then the further sides of the cut
    int seam_edges = 0;  ///< edges of the cut
};

/// Cuts a closed surface open. Of genus 0 along the shortest path along edges between two vertices that are far from
/// each other; else along the shortest loops through one vertex that leave one disk (Erickson, Har-Peled 2004,
/// "Optimally cutting a surface into a disk"), as a tree of shortest paths and one of faces give them, without the ends
/// that lead nowhere.
/// @throw Error bad_mesh unless the surface is one component, closed and without boundary
CutOpen cut_open(const Surface& surface);

}  // namespace beltrami
