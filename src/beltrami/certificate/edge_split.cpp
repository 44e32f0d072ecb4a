#include <beltrami/certificate/edge_split.h>

#include <beltrami/constraints/inner_constraints.h>

namespace beltrami {

SplitEdges split_edges(const Surface& source, const BoundaryCondition& boundary, const std::vector<char>& marked) {
    const Topology& topology = source.topology;
    const Mesh& mesh = source.mesh;
    const int vertices = mesh.vertex_count();
    std::vector<int> middle(static_cast<std::size_t>(topology.edge_count()), -1);
    int count = vertices;
    for (int e = 0; e < topology.edge_count(); ++e)
        if (marked[e]) middle[e] = count++;

    Mesh finer;
    finer.positions.resize(count, mesh.positions.cols());
    finer.positions.topRows(vertices) = mesh.positions;
    const Eigen::VectorXcd values = prescribed_values(boundary, source);
    const std::vector<EdgeConstraint> inner = edge_constraints(boundary, source);
    BoundaryCondition finer_boundary = boundary;
    std::vector<std::array<int, 4>> ends;
    for (int e = 0; e < topology.edge_count(); ++e) {
        if (middle[e] < 0) continue;
        const auto [a, b] = topology.edges[e];
        ends.push_back({a, b, -1, -1});
        finer.positions.row(middle[e]) = 0.5 * (mesh.positions.row(a) + mesh.positions.row(b));
        const bool rim = topology.edge_faces[e][0] < 0 || topology.edge_faces[e][1] < 0;
        if (rim || inner[e] == EdgeConstraint::pinned) finer_boundary.pin(middle[e], 0.5 * (values[a] + values[b]));
    }

    std::vector<int> parents;
    std::vector<std::array<double, 3>> places;
    struct Corner {
        int vertex;
        std::array<double, 3> place;
    };
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::array<Corner, 3> v, m;  // m[i]: middle of the edge from corner i to the next
        int split = 0, kept = 0, halved = 0;
        for (int i = 0; i < 3; ++i) {
            const int e = topology.corner_edges[3 * f + i];
            v[i] = {mesh.faces[f][i], {0, 0, 0}};
            v[i].place[i] = 1;
            m[i] = {middle[e], {0, 0, 0}};
            m[i].place[i] = m[i].place[(i + 1) % 3] = 0.5;
            if (middle[e] >= 0) {
                ++split;
                halved = i;
            } else {
                kept = i;
            }
        }
        const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
            finer.faces.add({a.vertex, b.vertex, c.vertex});
            parents.push_back(f);
            for (const Corner* corner : {&a, &b, &c}) places.push_back(corner->place);
        };
        if (split == 0) {
            add(v[0], v[1], v[2]);
        } else if (split == 1) {
            const int i = halved, j = (i + 1) % 3, k = (i + 2) % 3;
            add(v[k], v[i], m[i]);
            add(v[k], m[i], v[j]);
        } else if (split == 2) {
            // Corner k opposite the kept edge is cut off; the rest is cut along its shorter diagonal.
            const int i = kept, j = (i + 1) % 3, k = (i + 2) % 3;
            add(v[k], m[k], m[j]);
            const auto length = [&](const Corner& a, const Corner& b) {
                return (finer.positions.row(a.vertex) - finer.positions.row(b.vertex)).squaredNorm();
            };
            if (length(m[k], v[j]) <= length(m[j], v[i])) {
                add(m[k], v[i], v[j]);
                add(m[k], v[j], m[j]);
            } else {
                add(m[k], v[i], m[j]);
                add(v[i], v[j], m[j]);
            }
        } else {
            for (int i = 0; i < 3; ++i) add(v[i], m[i], m[(i + 2) % 3]);
            add(m[0], m[1], m[2]);
        }
    }
    std::optional<Positions> metric;
    if (source.metric) {
        metric.emplace(static_cast<Eigen::Index>(places.size()), source.metric->cols());
        for (std::size_t c = 0; c < places.size(); ++c) {
            metric->row(static_cast<Eigen::Index>(c)).setZero();
            for (int i = 0; i < 3; ++i)
                metric->row(static_cast<Eigen::Index>(c)) += places[c][i] * source.metric->row(3 * parents[c / 3] + i);
        }
    }
    return {surface_of(std::move(finer), std::move(metric)), std::move(finer_boundary), std::move(parents),
            std::move(places), std::move(ends)};
}

}  // namespace beltrami
