#include <beltrami/report/remesh_record.h>

#include <cmath>

#include <beltrami/remeshing/remesh.h>

namespace beltrami {

RemeshRecord remesh_record(const Mesh& mesh, const Mesh& image, const RemeshedSurface& result) {
    RemeshRecord record;
    record.before = angle_statistics(mesh);
    record.after = angle_statistics(image);
    record.distance = surface_distance(MeshTarget(mesh), MeshTarget(image));
    const double diagonal = (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
    record.distance.largest /= diagonal;
    record.distance.mean /= diagonal;
    record.area_ratio = surface_area(image) / surface_area(mesh);
    Eigen::VectorXd growth(mesh.face_count());
    for (int f = 0; f < mesh.face_count(); ++f)
        growth[f] = std::log(face_vector_area(image, f).norm() / face_vector_area(mesh, f).norm());
    record.size_deviation = std::sqrt((growth.array() - growth.mean()).square().mean());
    record.opposed_before = static_cast<int>(result.opposed_before.size());
    record.opposed_after = static_cast<int>(result.unresolved.size());
    record.steps = result.steps;
    record.settled = result.settled;
    return record;
}

}  // namespace beltrami
