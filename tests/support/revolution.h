#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami::test {

/// A closed surface of revolution around z in triangles, its profile running from the north pole to the south pole.
/// @param profile (radius, height) of the rings; the poles are added
inline Mesh revolution(const std::vector<std::array<double, 2>>& profile, int sides, double north, double south) {
    Mesh mesh;
    const int rings = static_cast<int>(profile.size());
    mesh.positions.resize(rings * sides + 2, 3);
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double angle = 2 * std::numbers::pi * (s + 0.5 * (r % 2)) / sides;
            mesh.positions.row(r * sides + s) << profile[r][0] * std::cos(angle), profile[r][0] * std::sin(angle),
                profile[r][1];
        }
    const int top = rings * sides, bottom = top + 1;
    mesh.positions.row(top) << 0, 0, north;
    mesh.positions.row(bottom) << 0, 0, south;
    const auto at = [&](int r, int s) { return r * sides + (s + sides) % sides; };
    for (int s = 0; s < sides; ++s) mesh.faces.add({top, at(0, s), at(0, s + 1)});
    for (int r = 0; r + 1 < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const int shift = r % 2;  // odd rings are turned by half a side
            mesh.faces.add({at(r, s), at(r + 1, s - 1 + shift), at(r + 1, s + shift)});
            mesh.faces.add({at(r, s), at(r + 1, s + shift), at(r, s + 1)});
        }
    for (int s = 0; s < sides; ++s) mesh.faces.add({bottom, at(rings - 1, s + 1), at(rings - 1, s)});
    return mesh;
}

/// A ball of radius 1 on which a rod of that length and radius stands, with a cap.
inline Mesh ball_with_rod(double length, double radius, int sides = 24) {
    std::vector<std::array<double, 2>> profile;
    const double step = 2 * std::numbers::pi * radius / sides, join = std::asin(radius);
    const double end = std::cos(join) + length;
    for (double z = end; z > std::cos(join) + 0.5 * step; z -= step) profile.push_back({radius, z});
    for (double t = join; t < std::numbers::pi - 0.05;) {
        profile.push_back({std::sin(t), std::cos(t)});
        t += std::max(step, 2 * std::numbers::pi * std::sin(t) / sides);
    }
    return revolution(profile, sides, end + 0.5 * radius, -1);
}

}  // namespace beltrami::test
