#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// What is prescribed about a map to the plane: vertices with their image points. Boundary vertices that are not named
/// are free (natural condition).
struct BoundaryCondition {
    std::vector<int> vertices;    ///< each at most once
    std::vector<Complex> images;  ///< beside vertices

    void pin(int vertex, Complex image) {
        vertices.push_back(vertex);
        images.push_back(image);
    }
    bool empty() const { return vertices.empty(); }
};

/// @throw Error bad_boundary if a vertex is out of range or named twice, or an image is not finite
void validate(const BoundaryCondition& boundary, const Surface& source);

/// Boundary vertices that @p boundary does not prescribe, loop by loop.
std::vector<int> unprescribed_boundary(const BoundaryCondition& boundary, const Surface& source);

/// @throw Error bad_boundary naming the loops that are not wholly prescribed
void require_whole_boundary(const BoundaryCondition& boundary, const Surface& source);

/// What a vertex may do in a linear solve.
enum class Freedom : unsigned char {
    free,     ///< moves in the plane
    sliding,  ///< moves along a given direction
    fixed,    ///< stays where it is
};

/// Freedoms for a boundary condition: pinned vertices and unreferenced ones are fixed, all others free.
std::vector<Freedom> freedoms(const BoundaryCondition& boundary, const Surface& source);

/// #V values: the prescribed images, 0 elsewhere.
Eigen::VectorXcd prescribed_values(const BoundaryCondition& boundary, const Surface& source);

}  // namespace beltrami
