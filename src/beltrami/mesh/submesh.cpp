#include <beltrami/mesh/submesh.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/mesh/edge_table.h>

namespace beltrami {
namespace {

/// Rewrites indices so that only the rows they name remain, in order; -1 stays.
/// @return the old rows that remain
std::vector<int> compact(std::vector<int>& indices, Eigen::Index rows) {
    std::vector<int> renumbered(rows, -1);
    for (const int index : indices) {
        if (index >= 0) renumbered[index] = 0;
    }
    std::vector<int> kept;
    for (int row = 0; row < static_cast<int>(rows); ++row) {
        if (renumbered[row] < 0) continue;
        renumbered[row] = static_cast<int>(kept.size());
        kept.push_back(row);
    }
    for (int& index : indices) index = index >= 0 ? renumbered[index] : -1;
    return kept;
}

Positions rows_of(const Positions& all, const std::vector<int>& rows) {
    Positions some(static_cast<Eigen::Index>(rows.size()), all.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) some.row(static_cast<Eigen::Index>(i)) = all.row(rows[i]);
    return some;
}

}  // namespace

Submesh keep_faces(const Mesh& mesh, const std::vector<int>& faces) {
    Submesh part;
    part.faces = faces;
    std::vector<int> indices, texture_indices;
    for (const int face : faces) {
        const int first = mesh.faces.first_corner(face), last = first + mesh.faces.degree(face);
        for (int corner = first; corner < last; ++corner) {
            indices.push_back(mesh.faces.vertices()[corner]);
            if (mesh.texture) texture_indices.push_back(mesh.texture->corners[corner]);
        }
    }
    part.vertices = compact(indices, mesh.positions.rows());
    part.mesh.positions = rows_of(mesh.positions, part.vertices);
    part.mesh.faces.reserve(static_cast<int>(faces.size()), static_cast<int>(indices.size()));
    std::size_t first = 0;
    for (const int face : faces) {
        const std::size_t degree = mesh.faces.degree(face);
        part.mesh.faces.add(std::span<const int>(indices).subspan(first, degree));
        first += degree;
    }
    if (mesh.texture) {
        const std::vector<int> kept = compact(texture_indices, mesh.texture->points.rows());
        part.mesh.texture = TextureCoordinates{rows_of(mesh.texture->points, kept), std::move(texture_indices)};
    }
    return part;
}

std::vector<std::vector<int>> component_faces(const Mesh& mesh) {
    const EdgeTable table = edge_table(mesh.faces, mesh.vertex_count());
    DisjointSets sets(mesh.face_count());
    for (int edge = 0; edge < table.edge_count(); ++edge) {
        for (const int corner : table.corners_of(edge)) {
            sets.join(table.corner_faces[table.corners_of(edge)[0]], table.corner_faces[corner]);
        }
    }
    std::vector<std::vector<int>> components;
    std::vector<int> index(mesh.face_count(), -1);
    for (int face = 0; face < mesh.face_count(); ++face) {
        int& component = index[sets.find(face)];  // of the component's first face
        if (component < 0) {
            component = static_cast<int>(components.size());
            components.emplace_back();
        }
        components[component].push_back(face);
    }
    return components;
}

Submesh largest_component(const Mesh& mesh) {
    const std::vector<std::vector<int>> components = component_faces(mesh);
    const auto fewer = [](const std::vector<int>& a, const std::vector<int>& b) { return a.size() < b.size(); };
    const auto largest = std::max_element(components.begin(), components.end(), fewer);
    return keep_faces(mesh, largest == components.end() ? std::vector<int>() : *largest);
}

Submesh remove_unreferenced(const Mesh& mesh) {
    std::vector<int> all(mesh.face_count());
    std::iota(all.begin(), all.end(), 0);
    return keep_faces(mesh, all);
}

}  // namespace beltrami
