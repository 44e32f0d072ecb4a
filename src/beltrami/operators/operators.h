#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The derivatives ∂ and ∂̄ of a mesh: the only way in which solvers read it.
///
/// Every triangle has one sample, every quad 2×2 Gauss samples of the bilinear element. A sample knows, for each corner
/// of its face, the gradient of that corner's hat function as a complex number in an orthonormal frame of the face:
///
///     ∂f = ½ Σ f_j conj(g_j)        ∂̄f = ½ Σ f_j g_j
///
/// Frames: a planar mesh uses the plane's own x + iy. A face in space, or one laid out from edge lengths, has its real
/// axis along its first edge. μ and φ of a sample are always meant in its frame.
struct Operators {
    int vertex_count = 0;
    int face_count = 0;
    std::vector<int> offsets{0};     ///< #S+1: the stencil of sample s is [offsets[s], offsets[s+1])
    std::vector<int> vertices;       ///< stencil vertices, the face's corners in order
    std::vector<Complex> gradients;  ///< hat gradients g_j, beside vertices; unit 1/length
    std::vector<double> weights;     ///< #S source areas, all positive
    std::vector<int> faces;          ///< #S face of the sample

    int sample_count() const { return static_cast<int>(weights.size()); }
    std::span<const int> stencil(int sample) const {
        return {vertices.data() + offsets[sample], static_cast<std::size_t>(offsets[sample + 1] - offsets[sample])};
    }
    std::span<const Complex> gradient(int sample) const {
        return {gradients.data() + offsets[sample], static_cast<std::size_t>(offsets[sample + 1] - offsets[sample])};
    }
    /// (∂f, ∂̄f) at a sample of f given at the vertices. Taken from differences, so that a constant has derivatives of
    /// exactly 0 and a large offset costs no accuracy.
    std::array<Complex, 2> derivatives(int sample, const Eigen::VectorXcd& f) const {
        Complex dz = 0, dzbar = 0;
        const Complex base = f[vertices[offsets[sample]]];
        for (int j = offsets[sample] + 1; j < offsets[sample + 1]; ++j) {
            const Complex difference = f[vertices[j]] - base;
            dz += difference * std::conj(gradients[j]);
            dzbar += difference * gradients[j];
        }
        return {0.5 * dz, 0.5 * dzbar};
    }
    /// Total source area.
    double area() const;

    using Matrix = Eigen::SparseMatrix<Complex, Eigen::RowMajor, int>;
    Matrix d_z() const;     ///< ∂ as a #S×#V matrix
    Matrix d_zbar() const;  ///< ∂̄ as a #S×#V matrix
};

/// Operators of a mesh: of the plane for a planar mesh (one whose faces are all clockwise is looked at from below),
/// else of its faces in space.
/// @pre diagnose(mesh) has no fatal finding
/// @throw Error bad_mesh naming faces whose area at some sample is not positive (a reflex or folded quad)
Operators operators(const Mesh& mesh);

/// One edge with its length; the vertices in either order.
struct EdgeLength {
    int a, b;
    double length;
};

/// A custom metric by edge lengths, as the shape of every face: one point per face corner (#corners×2), the first edge
/// on the real axis.
/// @throw Error bad_mesh for missing, repeated, unknown or non-positive lengths, for triangles that violate the
/// triangle
///        inequality (named), and for quads, whose shape edge lengths do not determine.
Positions corners_from_lengths(const Mesh& mesh, std::span<const EdgeLength> lengths);

/// Operators of the metric in which every face has the shape of its corners in @p corners, one point per face corner
/// (#corners×2 or ×3): reference shapes, or the texture coordinates of a mesh with seams.
/// A face laid out clockwise is read by its mirror image.
/// @throw Error bad_mesh naming faces without area
Operators operators_from_corners(const Mesh& mesh, const Positions& corners);

/// The same operators read from values given per face corner instead of per vertex (#corners values), so that a map
/// with seams can be measured.
Operators per_corner(const Operators& operators, const FaceList& faces);

/// Each vertex' share of the source's area: equal parts of the samples of its faces.
Eigen::VectorXd vertex_areas(const Operators& operators);

/// Positions of the texture point of every corner (#corners×2).
/// @throw Error bad_mesh if the mesh has no texture coordinates, a corner lacks one or one is not finite
Positions texture_corners(const Mesh& mesh);

}  // namespace beltrami
