#include "cad_part.h"

#include <algorithm>
#include <cmath>

#include <beltrami/mesh/topology.h>
#include <beltrami/targets/target_mesh.h>

namespace {

constexpr double kThickness = 0.6;

}  // namespace

beltrami::Mesh cad_part(double edge) {
    using namespace beltrami;
    const TargetDomain outline =
        target_domain(TargetCurve::polygon({{0, 0}, {3, 0}, {3, 1}, {1.2, 1}, {1.2, 2.5}, {0, 2.5}}),
                      {TargetCurve::circle({0.6, 1.8}, 0.32), TargetCurve::circle({2.3, 0.5}, 0.25)});
    TargetMeshOptions options;
    options.edge_length = edge;
    const TargetMesh plate = target_mesh(outline, options);
    const int n = plate.mesh.vertex_count(), layers = std::max(1, static_cast<int>(std::lround(kThickness / edge)));
    Mesh part;
    // The lower side, the upper side, then the rims of the layers between.
    std::vector<Eigen::Vector3d> points;
    for (const double z : {0.0, kThickness})
        for (int v = 0; v < n; ++v) points.emplace_back(plate.mesh.positions(v, 0), plate.mesh.positions(v, 1), z);
    for (int f = 0; f < plate.mesh.face_count(); ++f) {
        const auto v = plate.mesh.faces[f];
        part.faces.add({v[0], v[2], v[1]});
        part.faces.add({n + v[0], n + v[1], n + v[2]});
    }
    for (const auto& loop : topology(plate.mesh).boundary_loops) {
        const int count = static_cast<int>(loop.size());
        std::vector<std::vector<int>> rims(static_cast<std::size_t>(layers) + 1);
        for (int l = 0; l <= layers; ++l)
            for (const int v : loop) {
                if (l == 0 || l == layers) {
                    rims[l].push_back(l == 0 ? v : n + v);
                    continue;
                }
                rims[l].push_back(static_cast<int>(points.size()));
                points.emplace_back(plate.mesh.positions(v, 0), plate.mesh.positions(v, 1), kThickness * l / layers);
            }
        for (int l = 0; l < layers; ++l)
            for (int i = 0; i < count; ++i) {
                const int j = (i + 1) % count;
                const int a = rims[l][i], b = rims[l][j], c = rims[l + 1][j], d = rims[l + 1][i];
                part.faces.add({a, b, c});
                part.faces.add({a, c, d});
            }
    }
    part.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v) part.positions.row(static_cast<Eigen::Index>(v)) = points[v];
    return part;
}
