#include <beltrami/curves/cut_along.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <beltrami/base/disjoint_sets.h>

namespace beltrami {

namespace {

using Edge = std::array<int, 2>;

Edge ordered(int a, int b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Segments of a chain, its closing one included.
std::size_t segments(const MeshWithCurves::Chain& chain) {
    return chain.vertices.size() - (chain.closed ? 0 : 1);
}

}  // namespace

MeshCutOpen cut_along(const Mesh& mesh, std::span<const MeshWithCurves::Chain> curves) {
    std::set<Edge> cut;
    for (const MeshWithCurves::Chain& chain : curves)
        for (std::size_t i = 0; i < segments(chain); ++i)
            cut.insert(ordered(chain.vertices[i], chain.vertices[(i + 1) % chain.vertices.size()]));
    // Corners of a vertex that are connected across edges which are not cut are one vertex.
    const FaceList& faces = mesh.faces;
    std::map<Edge, std::array<int, 2>> corner_of_side;  // directed edge -> corners at its beginning and end
    for (int f = 0; f < faces.size(); ++f)
        for (int i = 0; i < faces.degree(f); ++i) {
            const int next = (i + 1) % faces.degree(f);
            corner_of_side[{faces[f][i], faces[f][next]}] = {faces.first_corner(f) + i, faces.first_corner(f) + next};
        }
    DisjointSets sets(faces.corner_count());
    for (const auto& [side, corners] : corner_of_side) {
        if (cut.count(ordered(side[0], side[1])) > 0) continue;
        const auto beyond = corner_of_side.find({side[1], side[0]});
        if (beyond == corner_of_side.end()) continue;
        sets.join(corners[0], beyond->second[1]);
        sets.join(corners[1], beyond->second[0]);
    }
    MeshCutOpen result;
    std::map<int, int> number;
    std::vector<int> of_corner(static_cast<std::size_t>(faces.corner_count()));
    for (int corner = 0; corner < faces.corner_count(); ++corner) {
        const auto [it, is_new] = number.emplace(sets.find(corner), static_cast<int>(number.size()));
        if (is_new) result.vertices.push_back(faces.vertices()[corner]);
        of_corner[corner] = it->second;
    }
    for (int f = 0; f < faces.size(); ++f)
        result.mesh.faces.add(
            std::span<const int>(of_corner.data() + faces.first_corner(f), static_cast<std::size_t>(faces.degree(f))));
    result.mesh.positions = mesh.positions(result.vertices, Eigen::all);
    std::vector<int> face_of_corner;
    for (int f = 0; f < faces.size(); ++f)
        face_of_corner.insert(face_of_corner.end(), static_cast<std::size_t>(faces.degree(f)), f);
    for (const MeshWithCurves::Chain& chain : curves) {
        const std::size_t n = chain.vertices.size();
        std::array<std::vector<int>, 2> copies{std::vector<int>(n, -1), std::vector<int>(n, -1)};
        std::array<int, 2> face{-1, -1};
        for (std::size_t i = 0; i < segments(chain); ++i)
            for (const int side : {0, 1}) {
                const std::size_t j = (i + 1) % n;
                const int a = chain.vertices[side == 0 ? i : j], b = chain.vertices[side == 0 ? j : i];
                const auto at = corner_of_side.find({a, b});
                if (at == corner_of_side.end()) continue;
                copies[side][side == 0 ? i : j] = of_corner[at->second[0]];
                copies[side][side == 0 ? j : i] = of_corner[at->second[1]];
                if (face[side] < 0) face[side] = face_of_corner[at->second[0]];
            }
        result.left.push_back(std::move(copies[0]));
        result.right.push_back(std::move(copies[1]));
        result.left_face.push_back(face[0]);
        result.right_face.push_back(face[1]);
    }
    return result;
}

}  // namespace beltrami
