#include <beltrami/mesh/mesh.h>

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <utility>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

std::string shape_of(Eigen::Index rows, Eigen::Index columns) {
    return std::to_string(rows) + "×" + std::to_string(columns);
}

}  // namespace

Mesh mesh_from(const Eigen::MatrixXd& V, const Eigen::MatrixXi& F) {
    if (V.cols() != 2 && V.cols() != 3) {
        throw Error(Cause::bad_mesh, "the matrix of positions is " + shape_of(V.rows(), V.cols()),
                    "give one row a vertex, of two or three coordinates");
    }
    if (F.cols() != 3 && F.cols() != 4) {
        throw Error(Cause::bad_mesh, "the matrix of faces is " + shape_of(F.rows(), F.cols()),
                    "give one row a face, of three or four vertices");
    }
    Mesh mesh;
    mesh.positions = V;
    mesh.faces.reserve(static_cast<int>(F.rows()), static_cast<int>(F.size()));
    for (Eigen::Index face = 0; face < F.rows(); ++face) {
        std::array<int, 4> corners{};
        for (Eigen::Index i = 0; i < F.cols(); ++i) corners[i] = F(face, i);
        const bool quad = F.cols() == 4 && corners[3] != -1;
        mesh.faces.add(std::span<const int>(corners).first(quad ? 4 : 3));
    }
    return mesh;
}

Eigen::MatrixXi face_matrix(const Mesh& mesh) {
    std::vector<int> others;
    bool quads = false;
    for (int face = 0; face < mesh.face_count(); ++face) {
        const int degree = mesh.faces.degree(face);
        quads = quads || degree == 4;
        if (degree != 3 && degree != 4) others.push_back(face);
    }
    if (!others.empty()) {
        const std::string sentence =
            "face " + std::to_string(others[0]) + " has " + std::to_string(mesh.faces.degree(others[0])) + " corners";
        throw Error(Cause::bad_mesh, sentence, "triangulate the mesh", {Things::faces, std::move(others)});
    }
    Eigen::MatrixXi F = Eigen::MatrixXi::Constant(mesh.face_count(), quads ? 4 : 3, -1);
    for (int face = 0; face < mesh.face_count(); ++face) {
        for (int i = 0; i < mesh.faces.degree(face); ++i) F(face, i) = mesh.faces[face][i];
    }
    return F;
}

Positions corner_positions(const Mesh& mesh) {
    Positions corners(mesh.faces.corner_count(), mesh.positions.cols());
    for (int corner = 0; corner < mesh.faces.corner_count(); ++corner) {
        corners.row(corner) = mesh.positions.row(mesh.faces.vertices()[corner]);
    }
    return corners;
}

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
