#pragma once

#include <optional>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Tutte's map of a closed surface of genus 0 to the sphere: without one face, the root, every vertex is the mean of
/// its neighbours in the plane, the root's own shape, mirrored, around them; inverse stereographic projection then, and
/// the Möbius map that centres it. In the plane no face folds (Tutte 1963); as geodesic triangles few may, on coarse
/// meshes.
/// @param weights #V of the centre of mass
/// @return #V×3 unit vectors, north for vertices without faces; nothing if the system is singular to rounding
std::optional<Positions> sphere_tutte(const Surface& source, int root, const Eigen::VectorXd& weights);

/// Faces in the order in which they are to be tried as a root: roundish ones near the centroid first.
/// @return up to @p count
std::vector<int> tutte_roots(const Surface& source, int count);

}  // namespace beltrami
