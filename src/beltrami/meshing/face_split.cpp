#include <beltrami/meshing/face_split.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <beltrami/mesh/quad_split.h>
#include <beltrami/meshing/polygon_split.h>
#include <beltrami/operators/face_areas.h>

namespace beltrami {

namespace {

/// Cuts the faces into what triangles_of(face) says in corners; nothing: the face stays.
template <class TrianglesOf>
SplitMesh cut_faces(const Mesh& mesh, TrianglesOf&& triangles_of) {
    SplitMesh result;
    result.mesh.positions = mesh.positions;
    std::vector<int> texture;
    std::vector<int> vertices, corners;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.faces[f];
        const auto add = [&](std::span<const int> chosen) {
            vertices.clear();
            for (const int c : chosen) {
                vertices.push_back(face[c]);
                if (mesh.texture) texture.push_back(mesh.texture->corners[mesh.faces.first_corner(f) + c]);
            }
            result.mesh.faces.add(vertices);
            result.faces.push_back(f);
        };
        const std::vector<std::array<int, 3>> triangles = triangles_of(f);
        if (triangles.empty()) {
            corners.resize(face.size());
            for (std::size_t c = 0; c < face.size(); ++c) corners[c] = static_cast<int>(c);
            add(corners);
        } else {
            for (const auto& triangle : triangles) add(triangle);
            result.cut.push_back(f);
        }
    }
    if (mesh.texture) result.mesh.texture = TextureCoordinates{mesh.texture->points, std::move(texture)};
    return result;
}

std::vector<std::array<int, 3>> triangles_of_polygon(const Mesh& mesh, int face) {
    const auto v = mesh.faces[face];
    Positions polygon(static_cast<Eigen::Index>(v.size()), mesh.positions.cols());
    for (std::size_t c = 0; c < v.size(); ++c) polygon.row(static_cast<Eigen::Index>(c)) = mesh.positions.row(v[c]);
    return split_polygon(polygon);
}

std::vector<std::array<int, 3>> triangles_of_quad(const Mesh& mesh, int face) {
    const auto v = mesh.faces[face];
    const auto halves = split_quad({mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])});
    return {halves.begin(), halves.end()};
}

}  // namespace

SplitMesh split_large_faces(const Mesh& mesh) {
    return cut_faces(mesh, [&](int f) -> std::vector<std::array<int, 3>> {
        if (mesh.faces.degree(f) <= 4) return {};
        return triangles_of_polygon(mesh, f);
    });
}

SplitMesh split_faces(const Mesh& mesh, const std::vector<int>& faces) {
    return cut_faces(mesh, [&](int f) -> std::vector<std::array<int, 3>> {
        if (mesh.faces.degree(f) < 4 || !std::ranges::binary_search(faces, f)) return {};
        return mesh.faces.degree(f) == 4 ? triangles_of_quad(mesh, f) : triangles_of_polygon(mesh, f);
    });
}

namespace {

/// Cuts large faces, and of the quads then there are those that are wanted.
template <class Wanted>
SplitMesh split_quads(SplitMesh first, Wanted&& wanted) {
    SplitMesh second = cut_faces(first.mesh, [&](int f) -> std::vector<std::array<int, 3>> {
        if (first.mesh.faces.degree(f) != 4 || !wanted(f)) return {};
        return triangles_of_quad(first.mesh, f);
    });
    for (int& f : second.faces) f = first.faces[f];
    for (int& f : second.cut) f = first.faces[f];
    second.cut.insert(second.cut.end(), first.cut.begin(), first.cut.end());
    std::ranges::sort(second.cut);
    second.cut.erase(std::unique(second.cut.begin(), second.cut.end()), second.cut.end());
    return second;
}

}  // namespace

SplitMesh split_unusable_faces(const Mesh& mesh) {
    SplitMesh first = split_large_faces(mesh);
    const std::vector<int> folded = faces_without_area(first.mesh);
    return split_quads(std::move(first), [&](int f) { return std::ranges::binary_search(folded, f); });
}

SplitMesh split_into_triangles(const Mesh& mesh) {
    return split_quads(split_large_faces(mesh), [](int) { return true; });
}

}  // namespace beltrami
