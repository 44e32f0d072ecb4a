#include <beltrami/mesh/texture_map.h>

#include <cmath>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>

namespace beltrami {

Eigen::VectorXcd texture_map(const Mesh& mesh) {
    if (!mesh.texture) throw Error(Cause::bad_mesh, "the mesh has no texture coordinates", "give a mesh with vt");
    Eigen::VectorXcd map = Eigen::VectorXcd::Zero(mesh.vertex_count());
    std::vector<char> known(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (int c = 0; c < mesh.faces.corner_count(); ++c) {
        const int v = mesh.faces.vertices()[c], t = mesh.texture->corners[c];
        if (t < 0)
            throw Error(Cause::bad_mesh,
                        "vertex " + std::to_string(v) + " has no texture coordinates in one of its faces",
                        "give vt at every corner", {Things::vertices, {v}});
        const Complex place(mesh.texture->points(t, 0), mesh.texture->points(t, 1));
        if (!std::isfinite(place.real()) || !std::isfinite(place.imag()))
            throw Error(Cause::bad_mesh, "the texture coordinates of vertex " + std::to_string(v) + " are not finite",
                        "give two numbers", {Things::vertices, {v}});
        if (known[v] && map[v] != place)
            throw Error(Cause::bad_mesh,
                        "vertex " + std::to_string(v) + " has several texture coordinates: a seam runs through it",
                        "give a map without seams, one vt a vertex", {Things::vertices, {v}});
        known[v] = 1;
        map[v] = place;
    }
    return map;
}

std::vector<std::vector<int>> texture_charts(const Mesh& mesh) {
    const FaceList& faces = mesh.faces;
    DisjointSets charts(faces.size());
    std::map<std::tuple<int, double, double>, int> face_at;  // the first one with a texture point at a vertex
    for (int f = 0; f < faces.size(); ++f)
        for (int c = faces.first_corner(f); c < faces.first_corner(f) + faces.degree(f); ++c) {
            const auto point = mesh.texture->points.row(mesh.texture->corners[c]);
            charts.join(f, face_at.try_emplace({faces.vertices()[c], point[0], point[1]}, f).first->second);
        }
    std::vector<int> number(static_cast<std::size_t>(faces.size()), -1);
    std::vector<std::vector<int>> result;
    for (int f = 0; f < faces.size(); ++f) {
        int& chart = number[charts.find(f)];
        if (chart < 0) {
            chart = static_cast<int>(result.size());
            result.emplace_back();
        }
        result[chart].push_back(f);
    }
    return result;
}

Mesh cut_along_seams(const Mesh& mesh, const TextureCoordinates& texture) {
    Mesh cut;
    cut.positions = Positions::Zero(texture.points.rows(), mesh.positions.cols());
    cut.faces.reserve(mesh.face_count(), mesh.faces.corner_count());
    for (int f = 0; f < mesh.face_count(); ++f) {
        const int first = mesh.faces.first_corner(f), n = mesh.faces.degree(f);
        cut.faces.add(std::span<const int>(texture.corners).subspan(static_cast<std::size_t>(first), n));
        for (int c = first; c < first + n; ++c)
            cut.positions.row(texture.corners[c]) = mesh.positions.row(mesh.faces.vertices()[c]);
    }
    return cut;
}

}  // namespace beltrami
