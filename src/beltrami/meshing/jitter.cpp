#include <beltrami/meshing/jitter.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {

void JitterOptions::validate() const {
    if (amplitude >= 0.0 && amplitude <= 0.5) return;
    throw Error(Cause::bad_option, "the jitter amplitude is " + std::to_string(amplitude),
                "give a value from 0 to 0.5");
}

Mesh jittered(Mesh mesh, const JitterOptions& options,
              const std::function<Eigen::Vector2d(int, const Eigen::Vector2d&)>& project,
              const std::vector<char>& keep) {
    options.validate();
    if (options.amplitude == 0.0) return mesh;
    const Topology topo = topology(mesh);
    const Positions regular = mesh.positions;
    std::vector<double> length(mesh.vertex_count(), 0.0);
    std::vector<int> degree(mesh.vertex_count(), 0);
    for (const auto& edge : topo.edges) {
        for (const int v : edge) {
            length[v] += (regular.row(edge[0]) - regular.row(edge[1])).norm();
            ++degree[v];
        }
    }
    Random random(options.seed);
    Positions shift = Positions::Zero(mesh.vertex_count(), 2);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        // Rejection keeps the direction uniform without trigonometry, whose last bit differs between platforms.
        double x = 0.0, y = 0.0;
        do {
            x = random.uniform(-1.0, 1.0);
            y = random.uniform(-1.0, 1.0);
        } while (x * x + y * y > 1.0);
        if ((topo.on_boundary[v] && !project) || (!keep.empty() && keep[v])) continue;
        const double reach = degree[v] > 0 ? options.amplitude * length[v] / degree[v] : 0.0;
        shift.row(v) << reach * x, reach * y;
    }
    std::vector<double> area(mesh.face_count());
    for (int face = 0; face < mesh.face_count(); ++face) area[face] = face_vector_area(mesh, face).z();

    const auto place = [&](int v) {
        const Eigen::Vector2d p = regular.row(v).head<2>() + shift.row(v);
        const bool moved = shift.row(v).squaredNorm() > 0.0;
        mesh.positions.row(v).head<2>() = !moved                ? regular.row(v).head<2>().eval()
                                          : topo.on_boundary[v] ? project(v, p).transpose().eval()
                                                                : p.transpose().eval();
    };
    for (int v = 0; v < mesh.vertex_count(); ++v) place(v);
    for (int round = 0;; ++round) {
        std::vector<char> retreat(mesh.vertex_count(), 0);
        bool any = false;
        for (int face = 0; face < mesh.face_count(); ++face) {
            bool good = face_vector_area(mesh, face).z() >= 0.1 * area[face];
            const std::span<const int> corners = mesh.faces[face];
            for (std::size_t i = 0; good && corners.size() == 4 && i < 4; ++i) {  // a quad stays convex
                const Eigen::Vector3d a = mesh.point(corners[i]), b = mesh.point(corners[(i + 1) % 4]),
                                      c = mesh.point(corners[(i + 2) % 4]);
                good = (b - a).cross(c - b).z() >= 0.1 * area[face];
            }
            if (good) continue;
            any = true;
            for (const int v : corners) retreat[v] = 1;
        }
        if (!any) return mesh;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            if (!retreat[v]) continue;
            shift.row(v) *= round < 20 ? 0.5 : 0.0;
            place(v);
        }
        if (round > 40) return mesh;  // the given mesh itself has faces without area
    }
}

}  // namespace beltrami
