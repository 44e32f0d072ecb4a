#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Vertex positions, one row a vertex: #V×3 in space or #V×2 in the plane. Row-major, so a row is contiguous.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Faces as flat index arrays: triangles and quads mixed, each counter-clockwise seen from the front.
class FaceList {
  public:
    FaceList() = default;

    int size() const { return static_cast<int>(offsets_.size()) - 1; }
    bool empty() const { return size() == 0; }
    /// Number of corners of all faces together.
    int corner_count() const { return static_cast<int>(vertices_.size()); }
    int degree(int face) const { return offsets_[face + 1] - offsets_[face]; }
    /// The vertices of a face, in order.
    std::span<const int> operator[](int face) const {
        return {vertices_.data() + offsets_[face], static_cast<std::size_t>(degree(face))};
    }
    /// Index of the first corner of a face in vertices().
    int first_corner(int face) const { return offsets_[face]; }
    /// Vertex of every corner, face after face.
    const std::vector<int>& vertices() const { return vertices_; }
    /// #F+1 positions in vertices(); face f has the corners offsets[f] … offsets[f+1]-1.
    const std::vector<int>& offsets() const { return offsets_; }

    void add(std::span<const int> face) {
        vertices_.insert(vertices_.end(), face.begin(), face.end());
        offsets_.push_back(static_cast<int>(vertices_.size()));
    }
    void add(std::initializer_list<int> face) { add(std::span<const int>(face.begin(), face.size())); }
    void reserve(int faces, int corners) {
        offsets_.reserve(static_cast<std::size_t>(faces) + 1);
        vertices_.reserve(static_cast<std::size_t>(corners));
    }
    bool operator==(const FaceList&) const = default;

  private:
    std::vector<int> vertices_;
    std::vector<int> offsets_{0};
};

/// Texture coordinates as files have them: their own list of points and one index per face corner, so that
/// seams (one vertex, several texture points) are kept.
struct TextureCoordinates {
    Positions points;          ///< #VT×2
    std::vector<int> corners;  ///< #corners indices into points, -1 where a corner has none
};

/// A polygon mesh of triangles and quads. A plain value: nothing is reordered, merged or dropped behind the user's
/// back.
struct Mesh {
    Positions positions;                        ///< #V×3 or #V×2
    FaceList faces;                             ///< #F faces
    std::optional<TextureCoordinates> texture;  ///< the file's own vt, if any

    int vertex_count() const { return static_cast<int>(positions.rows()); }
    int face_count() const { return faces.size(); }
    /// Position of a vertex in space; z = 0 for a mesh with two coordinates.
    Eigen::Vector3d point(int vertex) const {
        return {positions(vertex, 0), positions(vertex, 1), positions.cols() > 2 ? positions(vertex, 2) : 0.0};
    }
};

/// A mesh from matrices as libigl has them.
/// @param V n×2 or n×3 positions
/// @param F m×3 triangles, or m×4 quads and triangles: -1 in the fourth column marks a triangle. Vertices are counted
///          from 0; whether they exist is diagnose()'s to say.
/// @throw Error bad_mesh for matrices of other shapes
Mesh mesh_from(const Eigen::MatrixXd& V, const Eigen::MatrixXi& F);

/// The faces as libigl has them: m×3 if all are triangles, else m×4 with -1 in the fourth column of triangles. (The
/// positions are a matrix already.)
/// @throw Error bad_mesh naming faces that are neither triangles nor quads
Eigen::MatrixXi face_matrix(const Mesh& mesh);

/// The position of every face corner's vertex, one row a corner, with as many columns as the positions.
/// @pre indices of the faces are in range
Positions corner_positions(const Mesh& mesh);

/// True if the mesh lies in the plane z = 0 (two coordinates, or every z exactly 0).
bool is_planar(const Mesh& mesh);

/// Vector area of a face (½ Σ p_i × p_{i+1}): its length is the area of a planar face, its direction the normal.
Eigen::Vector3d face_vector_area(const Mesh& mesh, int face);

/// Area-weighted vertex normals, #V×3, unit length (zero at a vertex whose faces cancel).
Positions vertex_normals(const Mesh& mesh);

}  // namespace beltrami
