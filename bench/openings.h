#pragma once

// Closed meshes opened to disks, as scans are: by a plane with a small opening, and by a seam along edges.

#include <beltrami/mesh/mesh.h>

namespace beltrami::bench {

/// The mesh without what lies beyond a plane across its longest axis: about @p part of its vertices, more or less where
/// that leaves one opening, on the side where the cut is shorter; the largest component of what is left.
/// @pre triangles or quads, genus 0
Mesh opened_by_plane(const Mesh& closed, double part = 0.03);

/// The mesh cut open along the shortest path of edges between two vertices far apart: a zigzag seam, whose vertices
/// but the ends are there twice.
/// @pre triangles, closed
Mesh opened_by_seam(const Mesh& closed);

}  // namespace beltrami::bench
