// Distances of many scans with holes: variants of one scan, each with a smooth deformation of its own, and the time of
// all their distances against that of their charts and of one map for every pair, one after the other.
//
//     bench_distance FOLDER [COUNT]        default: 20 variants of each scan
//
// The scans are peaks_7.obj and alex_3.obj, which have holes, and human_face.obj with two holes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/beltrami.h>
#include <beltrami/charts/shape.h>
#include <beltrami/mesh/submesh.h>

namespace {

using namespace beltrami;

constexpr int kVariants = 20, kHoles = 2;
/// Part of the faces that a hole takes.
constexpr double kHolePart = 0.015;
/// Waves of a deformation, and the height of each as part of the scan's size.
constexpr int kWaves = 6;
constexpr double kHeight = 0.004;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Eigen::RowVector3d centre_of(const Mesh& mesh, int face) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int v : mesh.faces[face]) sum += mesh.positions.row(v);
    return sum / static_cast<double>(mesh.faces[face].size());
}

/// Without the faces nearest to a few places that lie far from each other and from the boundary.
Mesh with_holes(Mesh mesh) {
    for (int hole = 0; hole < kHoles; ++hole) {
        const Topology shape = topology(mesh);
        std::vector<int> rim;
        for (const auto& loop : shape.boundary_loops) rim.insert(rim.end(), loop.begin(), loop.end());
        int place = 0;
        double farthest = -1;
        for (int f = 0; f < mesh.face_count(); ++f) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const int v : rim) nearest = std::min(nearest, (mesh.positions.row(v) - centre_of(mesh, f)).norm());
            if (nearest > farthest) farthest = nearest, place = f;
        }
        // Faces around it, ring by ring, so that what is taken is a disk.
        const auto wanted = static_cast<std::size_t>(std::max(6.0, kHolePart * mesh.face_count()));
        std::vector<char> taken(static_cast<std::size_t>(mesh.face_count()), 0);
        std::vector<int> ring{place};
        taken[place] = 1;
        std::size_t count = 1;
        while (count < wanted) {
            std::vector<char> at(static_cast<std::size_t>(mesh.vertex_count()), 0);
            for (int f = 0; f < mesh.face_count(); ++f)
                if (taken[f])
                    for (const int v : mesh.faces[f]) at[v] = 1;
            for (int f = 0; f < mesh.face_count(); ++f)
                if (!taken[f] &&
                    std::any_of(mesh.faces[f].begin(), mesh.faces[f].end(), [&](int v) { return at[v]; })) {
                    taken[f] = 1;
                    ++count;
                }
        }
        std::vector<int> kept;
        for (int f = 0; f < mesh.face_count(); ++f)
            if (!taken[f]) kept.push_back(f);
        mesh = keep_faces(mesh, kept).mesh;
    }
    return mesh;
}

Mesh deformed(const Mesh& mesh, int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto uniform = [&] { return 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1; };
    const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff(), high = mesh.positions.colwise().maxCoeff();
    const double size = (high - low).norm();
    Mesh result = mesh;
    for (int wave = 0; wave < kWaves; ++wave) {
        const Eigen::RowVector3d along(uniform(), uniform(), uniform()), to(uniform(), uniform(), uniform());
        const double phase = std::numbers::pi * uniform(), length = 0.4 * size;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const double at = 2 * std::numbers::pi * (mesh.positions.row(v) - low).dot(along) / length;
            result.positions.row(v) += kHeight * size * std::sin(at + phase) * to;
        }
    }
    return result;
}

void measure(const std::string& name, const Mesh& scan, int variants) {
    std::vector<Surface> surfaces;
    for (int i = 0; i < variants; ++i) surfaces.emplace_back(deformed(scan, i + 1));
    double start = now();
    std::vector<std::unique_ptr<Shape>> shapes;
    for (const Surface& surface : surfaces) {
        shapes.push_back(std::make_unique<Shape>(surface));
        shapes.back()->circles(0);
    }
    const double charts = now() - start;
    ExtremalOptions options;
    for (const auto& shape : shapes) options.shapes.push_back(shape.get());
    start = now();
    int maps = 0;
    for (int i = 0; i < variants; ++i)
        for (int j = i + 1; j < variants; ++j, ++maps) extremal_map(surfaces[i], Constraints(surfaces[j]), options);
    const double mapping = now() - start;
    start = now();
    const DistanceMatrix matrix = distance_matrix(surfaces);
    const double all = now() - start;
    double width = 0;
    for (int i = 0; i < variants; ++i)
        for (int j = 0; j < i; ++j) width = std::max(width, matrix.upper(i, j) - matrix.lower(i, j));
    fmt::print("| {} | {} | {} | {:.2f} | {} | {:.2f} | {:.2f} | {:.2f} | {:.4f} | {:.4f} | {} |\n", name,
               scan.face_count(), variants, charts, maps, mapping, all, all / (charts + mapping),
               matrix.distance.maxCoeff(), width, matrix.unsettled.size());
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const int variants = argc > 2 ? std::atoi(argv[2]) : kVariants;
    if (argc < 2 || !std::filesystem::is_directory(argv[1]) || variants < 2) {
        std::fprintf(stderr, "usage: bench_distance FOLDER [COUNT]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    fmt::print(
        "| scan | faces | variants | charts, s | maps | maps, s | distances, s | ratio | largest distance | widest "
        "bracket | unsettled |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const auto row = [&](const std::string& name, const auto& scan) {
        try {
            measure(name, scan(), variants);
        } catch (const Error& error) {
            fmt::print("| {} | {} |\n", name, error.what());
        }
    };
    row("peaks_7", [&] { return read_mesh(folder / "peaks_7.obj").mesh; });
    row("alex_3", [&] { return read_mesh(folder / "alex_3.obj").mesh; });
    row("human_face, two holes", [&] { return with_holes(read_mesh(folder / "human_face.obj").mesh); });
}
