#include <beltrami/mesh/topology.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/edge_table.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {
namespace {

/// Throws the first finding that concerns the combinatorics, in the words of diagnose().
[[noreturn]] void refuse(const Mesh& mesh) {
    for (const Finding& finding : diagnose(mesh)) {
        switch (finding.defect) {
            case Defect::index_out_of_range:
            case Defect::too_many_corners:
            case Defect::degenerate_face:
            case Defect::non_manifold_edge:
            case Defect::non_manifold_vertex:
            case Defect::inconsistent_orientation:
            case Defect::not_orientable:
                throw Error(Cause::bad_mesh, finding.sentence, finding.next_step, finding.where());
            default:
                break;
        }
    }
    throw Error(Cause::bad_mesh, "the mesh is not an oriented manifold", "repair it in a mesh editor");
}

bool names_a_vertex_twice(std::span<const int> corners) {
    if (corners.size() <= 4) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (corners[i] == corners[j]) return true;
        return false;
    }
    std::vector<int> sorted(corners.begin(), corners.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

bool indices_are_usable(const Mesh& mesh) {
    for (int face = 0; face < mesh.face_count(); ++face) {
        const std::span<const int> corners = mesh.faces[face];
        if (corners.size() < 3) return false;
        for (const int vertex : corners)
            if (vertex < 0 || vertex >= mesh.vertex_count()) return false;
        if (names_a_vertex_twice(corners)) return false;
    }
    return true;
}

/// Signed area that a loop encloses in the xy-plane.
double enclosed_area(const Mesh& mesh, const std::vector<int>& loop) {
    std::vector<Complex> polygon;
    polygon.reserve(loop.size());
    for (const int vertex : loop) polygon.emplace_back(mesh.positions(vertex, 0), mesh.positions(vertex, 1));
    return signed_area(polygon);
}

/// Follows the boundary half-edges; loops come out by their smallest vertex, then the outer one moves to the front.
void collect_loops(const Mesh& mesh, const EdgeTable& table, Topology& result) {
    std::vector<int> successor(mesh.vertex_count(), -1);
    result.on_boundary.assign(mesh.vertex_count(), 0);
    for (int edge = 0; edge < table.edge_count(); ++edge) {
        if (result.edge_faces[edge][0] >= 0 && result.edge_faces[edge][1] >= 0) continue;
        const int corner = table.corners_of(edge)[0];
        const int from = mesh.faces.vertices()[corner];
        const auto [low, high] = table.edges[edge];
        successor[from] = from == low ? high : low;
        result.on_boundary[low] = result.on_boundary[high] = 1;
    }
    std::vector<double> sizes;
    const bool planar = is_planar(mesh);
    for (int start = 0; start < mesh.vertex_count(); ++start) {
        if (successor[start] < 0) continue;
        std::vector<int> loop;
        double length = 0.0;
        for (int vertex = start; successor[vertex] >= 0;) {
            loop.push_back(vertex);
            const int next = std::exchange(successor[vertex], -1);
            length += (mesh.point(next) - mesh.point(vertex)).norm();
            vertex = next;
        }
        sizes.push_back(planar ? std::abs(enclosed_area(mesh, loop)) : length);
        result.boundary_loops.push_back(std::move(loop));
        result.loop_lengths.push_back(length);
    }
    if (sizes.empty()) return;
    const auto outer = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
    std::rotate(result.boundary_loops.begin(), result.boundary_loops.begin() + outer,
                result.boundary_loops.begin() + outer + 1);
    std::rotate(result.loop_lengths.begin(), result.loop_lengths.begin() + outer,
                result.loop_lengths.begin() + outer + 1);
}

}  // namespace

Topology topology(const Mesh& mesh) {
    if (!indices_are_usable(mesh)) refuse(mesh);
    const std::vector<int>& vertices = mesh.faces.vertices();
    EdgeTable table = edge_table(mesh.faces, mesh.vertex_count());
    Topology result;
    result.edge_faces.assign(table.edges.size(), {-1, -1});
    for (int edge = 0; edge < table.edge_count(); ++edge) {
        for (const int corner : table.corners_of(edge)) {
            int& face = result.edge_faces[edge][vertices[corner] == table.edges[edge][0] ? 0 : 1];
            if (face >= 0) refuse(mesh);
            face = table.corner_faces[corner];
        }
    }
    if (!non_manifold_vertices(mesh.faces, table, mesh.vertex_count()).empty()) refuse(mesh);
    collect_loops(mesh, table, result);
    result.edges = std::move(table.edges);
    result.corner_edges = std::move(table.corner_edges);

    std::vector<char> referenced(mesh.vertex_count(), 0);
    for (const int vertex : vertices) referenced[vertex] = 1;
    DisjointSets sets(mesh.vertex_count());
    for (const auto& [low, high] : result.edges) sets.join(low, high);
    int referenced_count = 0;
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        if (!referenced[vertex]) continue;
        ++referenced_count;
        if (sets.find(vertex) == vertex) ++result.components;
    }
    result.euler_characteristic = referenced_count - result.edge_count() + mesh.face_count();
    // χ = Σ (2 − 2 g_i − b_i) over the components.
    const int loops = static_cast<int>(result.boundary_loops.size());
    result.genus = (2 * result.components - loops - result.euler_characteristic) / 2;
    return result;
}

}  // namespace beltrami
