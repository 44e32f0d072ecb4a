#include <beltrami/mesh/planar.h>

namespace beltrami {

bool seen_from_below(const Mesh& mesh) {
    double area = 0.0;
    for (int face = 0; face < mesh.face_count(); ++face) area += face_vector_area(mesh, face).z();
    return area < 0.0;
}

Eigen::VectorXcd planar_coordinates(const Mesh& mesh) {
    Eigen::VectorXcd coordinates(mesh.vertex_count());
    const double side = seen_from_below(mesh) ? -1.0 : 1.0;
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        coordinates[vertex] = {mesh.positions(vertex, 0), side * mesh.positions(vertex, 1)};
    }
    return coordinates;
}

}  // namespace beltrami
