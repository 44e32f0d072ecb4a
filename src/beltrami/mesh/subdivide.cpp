#include <beltrami/mesh/subdivide.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/edge_table.h>

namespace beltrami {
namespace {

void require_usable_indices(const Mesh& mesh) {
    for (int face = 0; face < mesh.face_count(); ++face) {
        bool usable = mesh.faces.degree(face) == 3 || mesh.faces.degree(face) == 4;
        for (const int vertex : mesh.faces[face]) usable = usable && vertex >= 0 && vertex < mesh.vertex_count();
        if (!usable) {
            throw Error(Cause::bad_mesh,
                        "face " + std::to_string(face) + " is neither a triangle nor a quad of existing vertices",
                        "diagnose the mesh and repair it", {Things::faces, {face}});
        }
    }
}

/// A face list split at the midpoints of its edges: new points are numbered on from @p points.
struct Split {
    EdgeTable table;
    FaceList faces;
    std::vector<std::array<int, 4>> parents;
};

Split split_faces(const FaceList& old, int points) {
    Split split;
    split.table = edge_table(old, points);
    for (const auto& [low, high] : split.table.edges) split.parents.push_back({low, high, -1, -1});
    split.faces.reserve(4 * old.size(), 4 * old.corner_count());
    for (int face = 0; face < old.size(); ++face) {
        const std::span<const int> v = old[face];
        std::array<int, 4> m{};
        for (std::size_t i = 0; i < v.size(); ++i) {
            m[i] = points + split.table.corner_edges[old.first_corner(face) + static_cast<int>(i)];
        }
        if (v.size() == 3) {
            for (int i = 0; i < 3; ++i) split.faces.add({v[i], m[i], m[(i + 2) % 3]});
            split.faces.add({m[0], m[1], m[2]});
        } else {
            const int centre = points + static_cast<int>(split.parents.size());
            split.parents.push_back({v[0], v[1], v[2], v[3]});
            for (int i = 0; i < 4; ++i) split.faces.add({v[i], m[i], centre, m[(i + 3) % 4]});
        }
    }
    return split;
}

Positions with_new_points(const Positions& old, const std::vector<std::array<int, 4>>& parents) {
    Positions points(old.rows() + static_cast<Eigen::Index>(parents.size()), old.cols());
    points.topRows(old.rows()) = old;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        const auto& [a, b, c, d] = parents[i];
        auto row = points.row(old.rows() + static_cast<Eigen::Index>(i));
        if (c < 0) {
            row = 0.5 * (old.row(a) + old.row(b));
        } else {
            row = 0.25 * (old.row(a) + old.row(b) + old.row(c) + old.row(d));
        }
    }
    return points;
}

/// The texture is a second mesh with the same faces; corners without a texture point get an extra point that is dropped
/// again, with everything that depends on it.
TextureCoordinates split_texture(const Mesh& mesh) {
    const TextureCoordinates& old = *mesh.texture;
    const int extra = static_cast<int>(old.points.rows());
    FaceList faces;
    faces.reserve(mesh.face_count(), mesh.faces.corner_count());
    for (int face = 0; face < mesh.face_count(); ++face) {
        std::vector<int> corners(mesh.faces.degree(face), extra);
        for (int i = 0; i < mesh.faces.degree(face); ++i) {
            const std::size_t corner = mesh.faces.first_corner(face) + i;
            const int index = corner < old.corners.size() ? old.corners[corner] : -1;
            if (index >= 0 && index < extra) corners[i] = index;
        }
        faces.add(corners);
    }
    const Split split = split_faces(faces, extra + 1);
    Positions points(extra + 1, old.points.cols());
    points << old.points, Positions::Zero(1, old.points.cols());
    points = with_new_points(points, split.parents);

    std::vector<int> renumbered(points.rows(), -1);
    int count = 0;
    for (int i = 0; i < static_cast<int>(points.rows()); ++i) {
        bool real = i != extra;
        if (i > extra) {
            const auto& parents = split.parents[i - extra - 1];
            real = std::find(parents.begin(), parents.end(), extra) == parents.end();
        }
        if (!real) continue;
        points.row(count) = points.row(i).eval();
        renumbered[i] = count++;
    }
    TextureCoordinates texture{points.topRows(count), {}};
    for (const int index : split.faces.vertices()) texture.corners.push_back(renumbered[index]);
    return texture;
}

}  // namespace

SubdividedMesh midpoint_subdivide(const Mesh& mesh) {
    require_usable_indices(mesh);
    Split split = split_faces(mesh.faces, mesh.vertex_count());
    SubdividedMesh result;
    result.mesh.positions = with_new_points(mesh.positions, split.parents);
    result.mesh.faces = std::move(split.faces);
    result.parents = std::move(split.parents);
    for (int face = 0; face < mesh.face_count(); ++face) result.face_parents.insert(result.face_parents.end(), 4, face);

    if (mesh.texture) result.mesh.texture = split_texture(mesh);
    return result;
}

Eigen::VectorXcd with_parents_means(const Eigen::VectorXcd& values, std::span<const std::array<int, 4>> parents) {
    Eigen::VectorXcd result(values.size() + static_cast<Eigen::Index>(parents.size()));
    result.head(values.size()) = values;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        Complex sum = 0;
        int count = 0;
        for (const int parent : parents[i])
            if (parent >= 0) sum += values[parent], ++count;
        result[values.size() + static_cast<Eigen::Index>(i)] = sum / static_cast<double>(count);
    }
    return result;
}

}  // namespace beltrami
