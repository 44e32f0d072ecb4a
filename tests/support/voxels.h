#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include <beltrami/mesh/mesh.h>

namespace beltrami::test {

/// The boundary of a set of unit cubes as quads, normals outwards.
/// @param size    of the box of cubes
/// @param is_full whether a cube, by its column, row and layer, belongs to the set
/// @pre cubes that meet at all share a face, or are joined by others around the edge or corner
inline Mesh voxel_surface(const std::array<int, 3>& size, const std::function<bool(int, int, int)>& is_full) {
    Mesh mesh;
    std::map<std::array<int, 3>, int> numbers;
    const auto vertex = [&](const std::array<int, 3>& p) {
        return numbers.emplace(p, static_cast<int>(numbers.size())).first->second;
    };
    const auto full = [&](const std::array<int, 3>& c) {
        for (int k = 0; k < 3; ++k)
            if (c[k] < 0 || c[k] >= size[k]) return false;
        return is_full(c[0], c[1], c[2]);
    };
    for (int i = 0; i < size[0]; ++i)
        for (int j = 0; j < size[1]; ++j)
            for (int l = 0; l < size[2]; ++l) {
                const std::array<int, 3> cube{i, j, l};
                if (!full(cube)) continue;
                for (int axis = 0; axis < 3; ++axis)
                    for (const int side : {0, 1}) {
                        std::array<int, 3> beyond = cube;
                        beyond[axis] += side == 1 ? 1 : -1;
                        if (full(beyond)) continue;
                        std::array<int, 3> p = cube;
                        p[axis] += side;
                        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
                        std::array<std::array<int, 3>, 4> corners{p, p, p, p};
                        ++corners[1][a], ++corners[2][a], ++corners[2][b], ++corners[3][b];
                        if (side == 0) std::swap(corners[1], corners[3]);
                        mesh.faces.add(
                            {vertex(corners[0]), vertex(corners[1]), vertex(corners[2]), vertex(corners[3])});
                    }
            }
    mesh.positions.resize(static_cast<Eigen::Index>(numbers.size()), 3);
    for (const auto& [p, v] : numbers) mesh.positions.row(v) << p[0], p[1], p[2];
    return mesh;
}

/// A bar of cubes with square holes through it: a closed surface whose genus is their number.
inline Mesh bar_with_holes(int holes) {
    return voxel_surface({2 * holes + 1, 3, 1}, [](int i, int j, int) { return i % 2 == 0 || j != 1; });
}

}  // namespace beltrami::test
