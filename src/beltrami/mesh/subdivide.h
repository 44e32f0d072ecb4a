#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh with vertices added, and what each new vertex lies between.
struct SubdividedMesh {
    Mesh mesh;  ///< the old vertices first, unchanged and in order; then the new ones
    /// For each new vertex (vertex #V_old + i) the 2 (edge midpoint, then -1, -1) or 4 (quad centre) old vertices whose
    /// mean it is.
    std::vector<std::array<int, 4>> parents;
    std::vector<int> face_parents;  ///< old face of each new face (four in a row have the same)
};

/// Splits every triangle and every quad into four at the midpoints. New vertices: edge midpoints in the order of
/// topology's edges, then quad centres in face order. Texture coordinates are split along.
/// @throw Error bad_mesh if a face names a vertex that does not exist or has neither 3 nor 4 corners
SubdividedMesh midpoint_subdivide(const Mesh& mesh);

/// Values at the old vertices (#V_old), followed by those of the new ones: the means over their parents.
Eigen::VectorXcd with_parents_means(const Eigen::VectorXcd& values, std::span<const std::array<int, 4>> parents);

}  // namespace beltrami
