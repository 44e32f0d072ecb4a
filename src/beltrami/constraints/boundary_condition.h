#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What is prescribed about a map to the plane: vertices with their image points, and vertices whose images are to lie
/// on lines. Boundary vertices that are not named are free (natural condition).
struct BoundaryCondition {
    std::vector<int> vertices;    ///< each at most once
    std::vector<Complex> images;  ///< beside vertices

    /// A vertex whose image lies anywhere on the line through a point. Not on the boundary and not among vertices.
    struct Line {
        int vertex;
        Complex point, direction;
    };
    std::vector<Line> lines;

    void pin(int vertex, Complex image) {
        vertices.push_back(vertex);
        images.push_back(image);
    }
    void pin_to_line(int vertex, Complex point, Complex direction) { lines.push_back({vertex, point, direction}); }
    bool empty() const { return vertices.empty() && lines.empty(); }
};

/// @throw Error bad_boundary if a vertex is out of range or named twice, an image is not finite, a line has no
/// direction or belongs to a boundary vertex
void validate(const BoundaryCondition& boundary, const Surface& source);

/// Boundary vertices that @p boundary does not prescribe, loop by loop.
/// @throw Error bad_boundary if a vertex is out of range
std::vector<int> unprescribed_boundary(const BoundaryCondition& boundary, const Surface& source);

/// @throw Error bad_boundary naming the loops that are not wholly prescribed
void require_whole_boundary(const BoundaryCondition& boundary, const Surface& source);

/// What a vertex may do in a linear solve.
enum class Freedom : unsigned char {
    free,     ///< moves in the plane
    sliding,  ///< moves along a given direction
    fixed,    ///< stays where it is
};

/// Freedoms for a boundary condition: pinned vertices and unreferenced ones are fixed, those of lines slide, all others
/// are free.
std::vector<Freedom> freedoms(const BoundaryCondition& boundary, const Surface& source);

/// #V values: the prescribed images, a point of their line for vertices of lines, 0 elsewhere.
Eigen::VectorXcd prescribed_values(const BoundaryCondition& boundary, const Surface& source);

/// #V unit directions of the lines, 0 elsewhere; empty if there are none.
Eigen::VectorXcd line_directions(const BoundaryCondition& boundary, const Surface& source);

}  // namespace beltrami
