#include <beltrami/io/mesh_builder.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

Positions rows_of(const std::vector<double>& values, int columns) {
    return Eigen::Map<const Positions>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

}  // namespace

// Meshes count vertices and corners with int.
void MeshBuilder::check_room(std::size_t count, const char* things) const {
    constexpr int most = std::numeric_limits<int>::max();
    if (count >= static_cast<std::size_t>(most)) fail_to_read(name_, fmt::format("more than {} {}", most, things));
}

void MeshBuilder::add_vertex(std::span<const double> coordinates) {
    check_room(vertex_count(), "vertices");
    coordinates_.insert(coordinates_.end(), coordinates.begin(), coordinates.end());
}

void MeshBuilder::add_texture_point(double u, double v) {
    check_room(texture_point_count(), "texture points");
    texture_points_.insert(texture_points_.end(), {u, v});
}

void MeshBuilder::add_face(std::span<const int> vertices, std::span<const int> texture) {
    check_room(faces_.vertices().size() + vertices.size(), "face corners");
    faces_.add(vertices);
    if (std::ranges::any_of(texture, [](int point) { return point >= 0; })) {
        texture_used_ = true;
        texture_corners_.resize(faces_.vertices().size() - vertices.size(), -1);
        texture_corners_.insert(texture_corners_.end(), texture.begin(), texture.end());
    }
}

void MeshBuilder::keep_out(std::size_t corners, const std::string& place) {
    if (++kept_out_ > most_named) return;
    warnings_.push_back(
        fmt::format("{}: a face with {} corners was kept out, only triangles and quads are used", place, corners));
}

LoadedMesh MeshBuilder::finish() {
    if (coordinates_.empty()) fail_to_read(name_, "the file holds no vertex");
    LoadedMesh result;
    result.mesh.positions = rows_of(coordinates_, dimension_);
    if (texture_per_vertex_) texture_corners_ = faces_.vertices();
    if (texture_used_ || texture_per_vertex_) {
        texture_corners_.resize(faces_.vertices().size(), -1);
        result.mesh.texture = TextureCoordinates{rows_of(texture_points_, 2), std::move(texture_corners_)};
    }
    result.mesh.faces = std::move(faces_);
    if (!face_mu_.empty())
        result.face_mu =
            Eigen::Map<const Eigen::VectorXcd>(face_mu_.data(), static_cast<Eigen::Index>(face_mu_.size()));
    result.warnings = std::move(warnings_);
    if (kept_out_ > most_named) {
        result.warnings.push_back(
            fmt::format("{}: {} further faces with more than 4 corners were kept out", name_, kept_out_ - most_named));
    }
    return result;
}

}  // namespace beltrami
