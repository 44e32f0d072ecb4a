#include <beltrami/mesh/edge_table.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/disjoint_sets.h>

namespace beltrami {

EdgeTable edge_table(const FaceList& faces, int vertex_count) {
    const std::vector<int>& vertices = faces.vertices();
    const int corner_count = faces.corner_count();
    EdgeTable table;
    table.corner_faces.resize(corner_count);
    for (int face = 0; face < faces.size(); ++face) {
        std::fill_n(table.corner_faces.begin() + faces.first_corner(face), faces.degree(face), face);
    }

    // One bucket per smaller vertex (counting sort); inside a bucket (larger vertex, corner) are sorted: a handful
    // each.
    std::vector<int> bucket(static_cast<std::size_t>(vertex_count) + 1, 0);
    const auto ends = [&](int corner) {
        const int a = vertices[corner];
        const int b = vertices[next_corner(faces, table, corner)];
        return std::pair(std::min(a, b), std::max(a, b));
    };
    for (int corner = 0; corner < corner_count; ++corner) ++bucket[ends(corner).first + 1];
    for (int vertex = 0; vertex < vertex_count; ++vertex) bucket[vertex + 1] += bucket[vertex];
    std::vector<std::pair<int, int>> sorted(corner_count);
    std::vector<int> fill(bucket.begin(), bucket.end() - 1);
    for (int corner = 0; corner < corner_count; ++corner) {
        const auto [low, high] = ends(corner);
        sorted[fill[low]++] = {high, corner};
    }

    table.edges.reserve(corner_count / 2 + 1);
    table.offsets.reserve(corner_count / 2 + 2);
    table.corner_edges.resize(corner_count);
    table.corners.resize(corner_count);
    for (int low = 0; low < vertex_count; ++low) {
        std::sort(sorted.begin() + bucket[low], sorted.begin() + bucket[low + 1]);
        for (int i = bucket[low]; i < bucket[low + 1]; ++i) {
            const auto [high, corner] = sorted[i];
            if (i == bucket[low] || high != sorted[i - 1].first) {
                table.edges.push_back({low, high});
                table.offsets.push_back(i);
            }
            table.corners[i] = corner;
            table.corner_edges[corner] = table.edge_count() - 1;
        }
    }
    table.offsets.push_back(corner_count);
    return table;
}

std::vector<int> non_manifold_vertices(const FaceList& faces, const EdgeTable& table, int vertex_count) {
    const std::vector<int>& vertices = faces.vertices();
    // Join the corners at either end of an edge; afterwards a manifold vertex has all its corners in one set.
    DisjointSets fans(faces.corner_count());
    for (int edge = 0; edge < table.edge_count(); ++edge) {
        const std::span<const int> around = table.corners_of(edge);
        for (std::size_t i = 1; i < around.size(); ++i) {
            int a = around[0], b = next_corner(faces, table, around[0]);
            const int c = around[i], d = next_corner(faces, table, around[i]);
            if (vertices[a] != vertices[c]) std::swap(a, b);
            fans.join(a, c);
            fans.join(b, d);
        }
    }
    std::vector<int> fan_of(vertex_count, -1);
    std::vector<int> bad;
    for (int corner = 0; corner < faces.corner_count(); ++corner) {
        int& fan = fan_of[vertices[corner]];
        const int mine = fans.find(corner);
        if (fan < 0) {
            fan = mine;
        } else if (fan != mine) {
            bad.push_back(vertices[corner]);
        }
    }
    std::sort(bad.begin(), bad.end());
    bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
    return bad;
}

}  // namespace beltrami
