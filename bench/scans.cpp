// Real scans as disks, with slack 0, 1/2 and 1: what is known about K, how even |μ| is in the plane of the chart and on
// the surface, and the time as a multiple of one harmonic map of the same mesh.
//
//     bench_scans FOLDER [NAME...]        default: every disk of the folder, and every closed mesh of genus 0 in it
//                                         opened by a plane and by a seam
//
// Times are those of the JSON record: harmonic = operators, ordering, analysis, assembly, factorisation and solution,
// median of three; total = everything between the loaded mesh and the result.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/beltrami.h>
#include <beltrami/report/timing.h>

#include "openings.h"

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void measure(const std::string& name, const Mesh& mesh) {
    for (const double slack : {0.0, 0.5, 1.0}) {
        try {
            Mesh copy = mesh;
            ExtremalOptions options;
            options.slack = slack;
            const double start = now();
            const Surface source(std::move(copy));
            const BoundaryCondition boundary = boundary_to_disk(source, 0.5);
            const ExtremalMap map = extremal_map(source, boundary, options);
            const double seconds = now() - start, harmonic = harmonic_seconds(source, boundary);
            const double in_chart = map.in_chart ? map.in_chart->standard_deviation : 0;
            fmt::print(
                "| {} | {} | {} | {:g} | {:.4f} | {:.4f} | {:.2f} % | {} | {:.4f} | {:.4f} | {} | {} | {} | {:.1f} |\n",
                name, mesh.face_count(), source.topology.boundary_loops[0].size(), slack, map.K_lower, map.K,
                100 * (map.K / map.K_lower - 1), map.in_chart ? fmt::format("{:.4f}", in_chart) : "–",
                map.distortion.mean, map.distortion.standard_deviation, map.distortion.flipped.size(), map.iterations,
                to_string(map.termination), seconds / harmonic);
        } catch (const Error& error) {
            fmt::print("| {} | {} | | {:g} | {} |\n", name, mesh.face_count(), slack, error.what());
        }
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || !std::filesystem::is_directory(argv[1])) {
        std::fprintf(stderr, "usage: bench_scans FOLDER [NAME...]\n");
        return 2;
    }
    const std::vector<std::string> wanted(argv + 2, argv + argc);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        if (const auto ending = entry.path().extension(); ending == ".obj" || ending == ".off")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    fmt::print(
        "| scan | faces | rim | slack | K_lower | K | gap | std in the chart | mean | std | flips | iterations | "
        "termination | ratio |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n");
    for (const auto& file : files) {
        const std::string name = file.stem().string();
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
        const Mesh mesh = read_mesh(file).mesh;
        const Topology shape = topology(mesh);
        if (shape.components != 1 || shape.genus != 0 || is_planar(mesh)) continue;
        if (shape.boundary_loops.size() == 1) {
            measure(name, mesh);
        } else if (shape.boundary_loops.empty()) {
            measure(name + ", plane", bench::opened_by_plane(mesh));
            if (mesh.faces.corner_count() == 3 * mesh.face_count())
                measure(name + ", seam", bench::opened_by_seam(mesh));
        }
    }
}
