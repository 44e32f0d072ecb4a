// Processor seconds of the conformal map of closed surfaces to the sphere against one harmonic map of the same mesh.
//
//     bench_sphere [MESH...]        default: spheres with bumps, 20 480 and 81 920 triangles, and a ball with limbs
//
// harmonic = operators, ordering, analysis, assembly, factorisation and solution, mean of three, of the mesh less one
// face; sphere = sphere_map() of the surface, median of three.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>

#include "closed_harmonic.h"

namespace {

using namespace beltrami;

/// A sphere with bumps of two sizes.
Mesh bumps(int levels) {
    Mesh mesh = icosahedral_sphere(levels);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        mesh.positions.row(v) *=
            1 + 0.3 * std::cos(4 * p.z() - p.x()) + 0.05 * std::sin(20 * p.x()) * std::cos(17 * p.y());
    }
    return mesh;
}

/// A ball with a dozen limbs that reach out to four times its radius.
Mesh limbs(int levels) {
    Mesh mesh = icosahedral_sphere(levels);
    const Positions tips = icosahedral_sphere(0).positions;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double nearest = (tips * mesh.positions.row(v).transpose()).maxCoeff();
        mesh.positions.row(v) *= 1 + 3 * std::exp(-60 * (1 - nearest));
    }
    return mesh;
}

void measure(const std::string& name, Mesh mesh) {
    const double of_harmonic = bench::closed_harmonic_processor_seconds(mesh);
    const Surface surface(std::move(mesh));
    std::vector<double> seconds;
    SphereMap map;
    for (int round = 0; round < 3; ++round) {
        const double start = bench::processor_seconds();
        map = sphere_map(surface);
        seconds.push_back(bench::processor_seconds() - start);
    }
    std::sort(seconds.begin(), seconds.end());
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.1f} | {} | {} | {} | {:.4f} / {:.4f} / {:.4f} |\n", name,
               surface.mesh.face_count(), of_harmonic, seconds[1], seconds[1] / of_harmonic, map.iterations,
               to_string(map.route), map.distortion.flipped.size(), map.distortion.mean,
               map.distortion.standard_deviation, map.distortion.max);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| mesh | faces | harmonic s | sphere s | ratio | Newton steps | route | flips | mean / std / max |mu| |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    try {
        for (int i = 1; i < argc; ++i)
            measure(argv[i], split_unusable_faces(remove_unreferenced(read_mesh(argv[i]).mesh).mesh).mesh);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    if (argc > 1) return 0;
    measure("bumps", bumps(5));
    measure("bumps", bumps(6));
    measure("limbs", limbs(6));
    return 0;
}
