#include <beltrami/registration/nearest_places.h>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/locate/surface_locator.h>

namespace beltrami {

std::vector<NearestPlace> nearest_places(const Mesh& mesh, const Positions& points) {
    if (mesh.face_count() == 0) throw Error(Cause::bad_mesh, "the mesh has no faces");
    std::vector<int> infinite;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        if (!points.row(i).allFinite()) infinite.push_back(static_cast<int>(i));
    if (!infinite.empty())
        throw Error(Cause::bad_option, "point " + std::to_string(infinite[0]) + " is not finite", {},
                    {Things::points, infinite});
    Positions in_space(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) in_space.row(v) = mesh.point(v);
    std::vector<int> faces;
    const std::vector<std::array<int, 3>> triangles = as_triangles(mesh.faces, in_space, faces);
    const SurfaceLocator locator(in_space, triangles);
    std::vector<NearestPlace> result(static_cast<std::size_t>(points.rows()));
    parallel_for(0, static_cast<int>(points.rows()), [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const SurfaceLocator::Place place = locator.nearest(points.row(i).transpose());
            result[i] = {{faces[place.triangle], triangles[place.triangle], place.barycentric}, place.distance};
        }
    });
    return result;
}

}  // namespace beltrami
