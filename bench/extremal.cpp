// Seconds of one harmonic map and of the extremal map of the same mesh, their ratio, that of their processor times,
// which says the same on a machine that others use, and the peak memory of both.
//
//     bench_extremal [TRIANGLES...]        default: 10000 100000 1000000 2000000
//
// Every measurement runs in a process of its own, so that peak memory is its own. Times are those of the JSON record:
// harmonic = operators, ordering, analysis, assembly, factorisation and solution, median of three; extremal =
// everything between the loaded mesh and the result: diagnosis, topology, flattening, iteration, distortion and bounds.
// A second table is for the real mesh with holes and pins, where the folder BELTRAMI_MESHES has it: harmonic and
// extremal maps in turn, medians of wall and of processor seconds; there also with a harmonic map that begins at the
// loaded mesh as the extremal one does.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/base/memory.h>
#include <beltrami/base/parallel.h>
#include <beltrami/beltrami.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/linear/linear_backend.h>
#include <beltrami/report/timing.h>
#include <beltrami/solve/beltrami_solver.h>

#include "arguments.h"

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Of all threads.
double processor_now() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The cases: a planar disk sent to three lobes, and a bump in space whose boundary runs unevenly around the disk.
Mesh mesh_of(const std::string& name, int triangles) {
    Mesh mesh = disk(disk_rings_for_triangles(triangles));
    if (name == "lobes") return mesh;
    Mesh bump;
    bump.faces = std::move(mesh.faces);
    bump.positions.resize(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        bump.positions.row(v) << x, y,
            0.6 * std::exp(-4 * ((x - 0.2) * (x - 0.2) + y * y)) + 0.1 * std::sin(5 * x + 3 * y);
    }
    return bump;
}

BoundaryCondition boundary_of(const std::string& name, const Surface& surface) {
    if (name != "lobes") return boundary_to_disk(surface, 0.7);
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) {
        const double t = std::atan2(surface.mesh.positions(v, 1), surface.mesh.positions(v, 0));
        boundary.pin(v, std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t)));
    }
    return boundary;
}

struct Measurement {
    double seconds = 0, processor = 0, k = 0, std = 0;
    int faces = 0, flipped = 0, iterations = 0, factorizations = 0;
    long peak_kib = 0;
};

/// Runs a measurement in a child process.
template <class Work>
Measurement in_child(Work&& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child == 0) {
        const Measurement m = work();
        const bool written = write(ends[1], &m, sizeof m) == sizeof m;
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    Measurement m;
    const bool read_all = read(ends[0], &m, sizeof m) == sizeof m;
    close(ends[0]);
    rusage usage{};
    int status = 0;
    wait4(child, &status, 0, &usage);
    if (!read_all || status != 0) throw std::runtime_error("a measurement failed");
    m.peak_kib = usage.ru_maxrss;
    return m;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure_pinned(const std::filesystem::path& folder) {
    constexpr int rounds = 7;
    ready_memory(0);
    const Mesh mesh = read_mesh(folder / "mcqc3d_planar_src.obj").mesh;
    const IndexedRows pins = read_indexed_rows(folder / "mcqc3d_pins.txt", 1, mesh.vertex_count(), 2, "a pin");
    BoundaryCondition boundary;
    for (Eigen::Index i = 0; i < pins.indices.rows(); ++i)
        boundary.pin(pins.indices(i, 0), {pins.values(i, 0), pins.values(i, 1)});
    std::vector<double> harmonic, harmonic_processor, from_mesh, extremal, extremal_processor;
    ExtremalMap result;
    const Surface before(mesh);
    for (int round = 0; round < rounds; ++round) {
        double processor = processor_now();
        harmonic.push_back(harmonic_seconds(before, boundary));
        harmonic_processor.push_back((processor_now() - processor) / 3);
        Mesh copy = mesh;
        double start = now();
        harmonic_map(Surface(std::move(copy)), boundary);
        from_mesh.push_back(now() - start);
        copy = mesh;
        processor = processor_now();
        start = now();
        const Surface surface(std::move(copy));
        result = extremal_map(surface, boundary);
        extremal.push_back(now() - start);
        extremal_processor.push_back(processor_now() - processor);
    }
    const auto row = [](const char* what, double of_harmonic, double of_extremal) {
        fmt::print("| {} | {:.4f} | {:.3f} | {:.1f} |\n", what, of_harmonic, of_extremal, of_extremal / of_harmonic);
    };
    fmt::print(
        "\nThree holes and pins, {} triangles: k {:.5f}, std {:.4f}, max {:.4f}, gap {:.2f} %, {} flips, {} "
        "iterations, {} factorisations.\n\n| seconds | harmonic | extremal | ratio |\n| --- | --- | --- | --- |\n",
        mesh.face_count(), result.k, result.distortion.standard_deviation, result.distortion.max,
        100 * (result.K / result.K_lower - 1), result.distortion.flipped.size(), result.iterations,
        result.factorizations);
    row("wall, both from the loaded mesh", median(from_mesh), median(extremal));
    row("wall, harmonic without diagnosis and topology", median(harmonic), median(extremal));
    row("processor", median(harmonic_processor), median(extremal_processor));
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<int> sizes =
        bench::numbers_of(argc, argv, 100, {10'000, 100'000, 1'000'000, 2'000'000}, "bench_extremal [TRIANGLES...]");
    std::string growth;
    fmt::print(
        "{}\n\n| case | triangles | harmonic s | extremal s | ratio | of processor times | iterations | factorisations "
        "| k | flips | "
        "harmonic MiB | extremal MiB | ratio |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        linear_backend());
    for (const std::string name : {"lobes", "bump"}) {
        std::vector<Measurement> all;
        for (const int size : sizes) {
            const Measurement harmonic = in_child([&] {
                ready_memory(0);
                const Surface surface(mesh_of(name, size));
                Measurement m;
                const BoundaryCondition boundary = boundary_of(name, surface);
                const double processor = processor_now();
                m.seconds = harmonic_seconds(surface, boundary);
                m.processor = (processor_now() - processor) / 3;
                return m;
            });
            const Measurement extremal = in_child([&] {
                Mesh mesh = mesh_of(name, size);
                Measurement m;
                const double start = now(), processor = processor_now();
                ready_memory_beside(memory_of_map(mesh.face_count()));
                const Surface surface(std::move(mesh));
                const ExtremalMap result = extremal_map(surface, boundary_of(name, surface));
                m.seconds = now() - start;
                m.processor = processor_now() - processor;
                m.k = result.k;
                m.faces = surface.mesh.face_count();
                m.flipped = static_cast<int>(result.distortion.flipped.size());
                m.iterations = result.iterations;
                m.factorizations = result.factorizations;
                return m;
            });
            fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {} | {} | {:.5f} | {} | {} | {} | {:.2f} |\n",
                       name, extremal.faces, harmonic.seconds, extremal.seconds, extremal.seconds / harmonic.seconds,
                       extremal.processor / harmonic.processor, extremal.iterations, extremal.factorizations,
                       extremal.k, extremal.flipped, harmonic.peak_kib / 1024, extremal.peak_kib / 1024,
                       static_cast<double>(extremal.peak_kib) / static_cast<double>(harmonic.peak_kib));
            std::fflush(stdout);
            all.push_back(extremal);
        }
        if (all.size() > 1)
            growth += fmt::format("{}: time grows like n^{:.2f} from the first mesh to the last\n", name,
                                  std::log(all.back().seconds / all.front().seconds) /
                                      std::log(static_cast<double>(all.back().faces) / all.front().faces));
    }
    fmt::print("\n{}", growth);
    const char* folder = std::getenv("BELTRAMI_MESHES");
    if (folder && std::filesystem::exists(std::filesystem::path(folder) / "mcqc3d_planar_src.obj"))
        measure_pinned(folder);
}
