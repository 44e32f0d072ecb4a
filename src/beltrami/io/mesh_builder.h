#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <beltrami/io/read_mesh.h>

namespace beltrami {

/// What becomes of faces with more than four corners.
enum class LargeFaces { cut, keep };

/// Gathers vertices, faces and texture coordinates one by one, as every reader meets them, and keeps their order.
class MeshBuilder {
  public:
    /// @param name      what errors and warnings call the file
    /// @param dimension coordinates a vertex: 3 or 2
    explicit MeshBuilder(std::string name, int dimension = 3, LargeFaces large_faces = LargeFaces::cut)
        : name_(std::move(name)), dimension_(dimension), large_faces_(large_faces) {}

    std::size_t vertex_count() const { return coordinates_.size() / static_cast<std::size_t>(dimension_); }
    std::size_t texture_point_count() const { return texture_points_.size() / 2; }

    void reserve_vertices(std::size_t vertices) {
        coordinates_.reserve(vertices * static_cast<std::size_t>(dimension_));
    }
    /// @param coordinates as many as the dimension
    void add_vertex(std::span<const double> coordinates);
    void add_texture_point(double u, double v);
    /// The coefficient of the next face to be added. If one face has one, all must.
    void add_face_mu(Complex mu) { face_mu_.push_back(mu); }
    /// Adds a face; one with more than four corners is triangulated by finish(), in its place,
    /// unless such faces are kept.
    /// @param vertices indices of its corners, 3 at least
    /// @param texture  as many indices of texture points, -1 for none; or nothing at all
    void add_face(std::span<const int> vertices, std::span<const int> texture = {});
    /// As add_face(), and a face with more than four corners is remembered for a warning.
    /// @param source the text or binary source, asked with here() for the face's place in the file
    template <class Source>
    void add_face(std::span<const int> vertices, std::span<const int> texture, const Source& source) {
        if (vertices.size() > 4 && large_faces_ == LargeFaces::cut)
            note_large(vertices.size(), large_ < kMostNamed ? source.here() : std::string());
        add_face(vertices, texture);
    }
    std::size_t face_count() const { return static_cast<std::size_t>(faces_.size()); }
    /// Gives each vertex its texture point of the same index.
    void use_texture_per_vertex() { texture_per_vertex_ = true; }
    /// What else the file says; rows of vertices and faces as they were added.
    FileAttributes& attributes() { return attributes_; }

    /// The mesh; the builder is empty afterwards. @throw Error unreadable if there is no vertex
    LoadedMesh finish();

  private:
    static constexpr std::int64_t kMostNamed = 10;  ///< large faces named one by one before they are only counted

    void note_large(std::size_t corners, const std::string& place);
    void split_large_faces(Mesh& mesh);
    void check_room(std::size_t count, const char* things) const;

    std::string name_;
    int dimension_;
    LargeFaces large_faces_;
    std::vector<double> coordinates_;
    FaceList faces_;
    std::vector<double> texture_points_;
    std::vector<int> texture_corners_;
    std::vector<Complex> face_mu_;
    bool texture_used_ = false;
    bool texture_per_vertex_ = false;
    std::int64_t large_ = 0;
    FileAttributes attributes_;
    Warnings warnings_;
};

}  // namespace beltrami
