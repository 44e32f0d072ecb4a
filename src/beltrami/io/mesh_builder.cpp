#include <beltrami/io/mesh_builder.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <beltrami/io/text_scanner.h>
#include <beltrami/meshing/face_split.h>

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

void MeshBuilder::note_large(std::size_t corners, const std::string& place) {
    if (++large_ > kMostNamed) return;
    warnings_.push_back({WarningKind::file, fmt::format("{}: a face with {} corners was cut into {} triangles", place,
                                                        corners, corners - 2)});
}

void MeshBuilder::split_large_faces(Mesh& mesh) {
    std::size_t corners = 0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto degree = static_cast<std::size_t>(mesh.faces.degree(f));
        corners += degree > 4 ? 3 * (degree - 2) : degree;
    }
    check_room(corners, "face corners");
    SplitMesh split = beltrami::split_large_faces(mesh);
    mesh = std::move(split.mesh);
    if (attributes_.face_columns.empty() && attributes_.face_states.empty()) return;
    std::vector<std::vector<int>> same(static_cast<std::size_t>(mesh.vertex_count()));
    for (int v = 0; v < mesh.vertex_count(); ++v) same[v] = {v};
    attributes_ = carried(attributes_, same, split.faces);
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
    if (large_ > 0) split_large_faces(result.mesh);
    result.attributes = std::move(attributes_);
    if (!face_mu_.empty() && large_ == 0) {
        result.face_mu =
            Eigen::Map<const Eigen::VectorXcd>(face_mu_.data(), static_cast<Eigen::Index>(face_mu_.size()));
    } else if (!face_mu_.empty()) {
        warnings_.push_back(
            {WarningKind::file,
             name_ + ": the coefficients of the faces go, as those of faces that are cut mean nothing"});
    }
    result.warnings = std::move(warnings_);
    if (large_ > kMostNamed) {
        result.warnings.push_back(
            {WarningKind::file, fmt::format("{}: {} further faces with more than 4 corners were cut into triangles",
                                            name_, large_ - kMostNamed)});
    }
    return result;
}

}  // namespace beltrami
