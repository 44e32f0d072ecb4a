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

Positions fitted_to_unit_square(const Positions& points) {
    if (points.rows() == 0) return points;
    const Eigen::RowVectorXd low = points.colwise().minCoeff();
    // Halves, since the difference of two doubles may be too large for one.
    const Eigen::RowVectorXd half = 0.5 * points.colwise().maxCoeff() - 0.5 * low;
    const double size = half.maxCoeff();
    Positions fitted = 0.5 * points;
    fitted.rowwise() -= 0.5 * low;
    if (size > 0) fitted /= size;
    return fitted;
}

}  // namespace beltrami
