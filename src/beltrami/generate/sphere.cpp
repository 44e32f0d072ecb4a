#include <beltrami/generate/sphere.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/subdivide.h>

namespace beltrami {
namespace {

Mesh subdivided_sphere(Mesh mesh, int levels, double radius) {
    if (levels < 0 || levels > 11 || !(radius > 0.0) || !std::isfinite(radius)) {
        throw Error(Cause::bad_option,
                    "a sphere of radius " + std::to_string(radius) + " with " + std::to_string(levels) +
                        " levels is impossible",
                    "give 0 to 11 levels and a positive radius");
    }
    for (int level = 0; level < levels; ++level) {
        mesh = midpoint_subdivide(mesh).mesh;
        mesh.positions.rowwise().normalize();
    }
    mesh.positions *= radius;
    return mesh;
}

}  // namespace

Mesh icosahedral_sphere(int levels, double radius) {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    Mesh mesh;
    mesh.positions.resize(12, 3);
    // Cyclic permutations of (0, ±1, ±golden).
    mesh.positions << 0, 1, golden, 0, -1, golden, 0, 1, -golden, 0, -1, -golden,  //
        1, golden, 0, -1, golden, 0, 1, -golden, 0, -1, -golden, 0,                //
        golden, 0, 1, -golden, 0, 1, golden, 0, -1, -golden, 0, -1;
    mesh.positions.rowwise().normalize();
    // Its faces are the triples of vertices at the smallest distance; turned outwards.
    const auto near = [&](int a, int b) { return mesh.positions.row(a).dot(mesh.positions.row(b)) > 0.4; };
    for (int a = 0; a < 12; ++a) {
        for (int b = a + 1; b < 12; ++b) {
            for (int c = b + 1; c < 12; ++c) {
                if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
                Eigen::Matrix3d corners;
                corners << mesh.point(a), mesh.point(b), mesh.point(c);
                mesh.faces.add(corners.determinant() > 0.0 ? std::array{a, b, c} : std::array{a, c, b});
            }
        }
    }
    return subdivided_sphere(std::move(mesh), levels, radius);
}

Mesh octahedral_sphere(int levels, double radius) {
    Mesh mesh;
    mesh.positions.resize(6, 3);
    mesh.positions << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    for (const int x : {0, 1}) {
        for (const int y : {0, 1}) {
            for (const int z : {0, 1}) {
                // An even number of negative axes keeps the order x, y, z counter-clockwise seen from outside.
                if ((x + y + z) % 2 == 0) {
                    mesh.faces.add({x, 2 + y, 4 + z});
                } else {
                    mesh.faces.add({x, 4 + z, 2 + y});
                }
            }
        }
    }
    return subdivided_sphere(std::move(mesh), levels, radius);
}

}  // namespace beltrami
