#include <beltrami/hyperbolic/equivariant_map.h>

#include <algorithm>
#include <array>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

int edge_between(const Topology& topology, int a, int b) {
    const std::array<int, 2> ends{std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(topology.edges.begin(), topology.edges.end(), ends);
    return found == topology.edges.end() || *found != ends ? -1 : static_cast<int>(found - topology.edges.begin());
}

DiskIsometry step_at_corner(const Surface& source, const EquivariantMap& map, int corner) {
    const auto edge = static_cast<std::size_t>(source.topology.corner_edges[corner]);
    const bool along = source.topology.edges[edge][0] == source.mesh.faces.vertices()[corner];
    return along ? map.steps[edge] : map.steps[edge].inverse();
}

Eigen::VectorXd flatness(const Surface& source, const EquivariantMap& map) {
    const FaceList& faces = source.mesh.faces;
    Eigen::VectorXd result(faces.size());
    for (int f = 0; f < faces.size(); ++f) {
        DiskIsometry around;
        for (int i = 0; i < faces.degree(f); ++i)
            around = around * step_at_corner(source, map, faces.first_corner(f) + i);
        result[f] = around.from_identity();
    }
    return result;
}

Eigen::MatrixXi periods_of_images(const Topology& source, const EquivariantMap& map,
                                  const std::vector<std::vector<int>>& loops) {
    Eigen::MatrixXi result = Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(loops.size()), map.classes.cols());
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const int a = loops[l][i], b = loops[l][(i + 1) % loops[l].size()];
            const int edge = edge_between(source, a, b);
            if (edge < 0)
                throw Error(Cause::bad_option,
                            "no edge joins vertices " + std::to_string(a) + " and " + std::to_string(b),
                            "paths go along edges", {Things::vertices, {a, b}});
            result.row(static_cast<Eigen::Index>(l)) += (a < b ? 1 : -1) * map.classes.row(edge);
        }
    return result;
}

}  // namespace beltrami
