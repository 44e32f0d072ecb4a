#include <beltrami/mesh/mesh.h>

#include <Eigen/Geometry>

namespace beltrami {

bool is_planar(const Mesh& mesh) {
    return mesh.positions.cols() < 3 || (mesh.positions.col(2).array() == 0.0).all();
}

Eigen::Vector3d face_vector_area(const Mesh& mesh, int face) {
    const std::span<const int> corners = mesh.faces[face];
    // Relative to the first corner, so that a mesh far from the origin loses no digits.
    const Eigen::Vector3d origin = mesh.point(corners[0]);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += (mesh.point(corners[i]) - origin).cross(mesh.point(corners[i + 1]) - origin);
    }
    return 0.5 * sum;
}

Positions vertex_normals(const Mesh& mesh) {
    Positions normals = Positions::Zero(mesh.vertex_count(), 3);
    for (int face = 0; face < mesh.face_count(); ++face) {
        const Eigen::Vector3d area = face_vector_area(mesh, face);
        for (const int vertex : mesh.faces[face]) normals.row(vertex) += area.transpose();
    }
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        const double length = normals.row(vertex).norm();
        if (length > 0.0) normals.row(vertex) /= length;
    }
    return normals;
}

}  // namespace beltrami
