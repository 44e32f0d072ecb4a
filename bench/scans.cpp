// Real scans as disks, with slack 0, 1/2 and 1: what is known about K, how even |μ| is in the plane of the chart and on
// the surface, and the time as a multiple of one harmonic map of the same mesh.
//
// What is proved is that of the polygons: boundary values linear along the edges of the rim, as slack has left them, so
// that single vertices of a jagged rim count. K_upper is verified on refined meshes (verified_bracket.h) where the mesh
// is not too large for that; else it is what the map attains.
//
//     bench_scans FOLDER [NAME...]        default: every disk of the folder, and every closed mesh of genus 0 in it
//                                         opened by a plane and by a seam; each as it is, and divided at its midpoints
//                                         until it has 10^5 faces, if that is not more than two divisions
//
// Times cover what those of the JSON record do, in processor time, which says the same on a machine that others use:
// harmonic = operators, ordering, analysis, assembly, factorisation and solution, mean of three; total = everything
// between the loaded mesh and the result, median of three.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/base/memory.h>
#include <beltrami/beltrami.h>
#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/certificate/verified_bracket.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/report/timing.h>

#include "openings.h"

namespace {

using namespace beltrami;

/// Of all threads.
double now() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

constexpr int kRounds = 3;
constexpr int kLarge = 100'000, kMostDivisions = 2;
/// Above this part of K a gap has its cause named.
constexpr double kWide = 0.01;

/// Why the bracket is wide.
std::string cause_of(const ExtremalMap& map) {
    if (map.differential.tabulated()) return "values crowd";
    if (map.termination == Termination::below_bound) return "the mesh does not show the map";
    if (map.termination == Termination::unconfirmed) return "the mesh does not resolve φ";
    if (map.K < (1 + kWide) * map.K_lower) return "";
    if (map.noise) return fmt::format("outline: {:.3f} with slack {:g}", map.noise->K, map.noise->slack);
    if (map.termination == Termination::not_teichmuller) return "a corner of the outline";
    return map.in_chart ? "outline jagged over several edges" : "linear elements at the rim";
}

/// What one run gives.
struct Run {
    ExtremalMap map;
    double seconds, harmonic;
};
Run run(const Mesh& mesh, double slack) {
    std::vector<double> seconds;
    Run result;
    for (int round = 0; round < kRounds; ++round) {
        Mesh copy = mesh;
        ExtremalOptions options;
        options.slack = slack;
        const double start = now();
        const Surface source(std::move(copy));
        const BoundaryCondition boundary = boundary_to_disk(source, 0.5);
        result.map = extremal_map(source, boundary, options);
        seconds.push_back(now() - start);
        if (round == kRounds - 1) {
            const double before = now();
            harmonic_seconds(source, boundary);
            result.harmonic = (now() - before) / 3;
        }
    }
    std::sort(seconds.begin(), seconds.end());
    result.seconds = seconds[kRounds / 2];
    return result;
}

/// Meshes of more faces are not refined for a proof.
constexpr int kMostProofFaces = 12'000;

/// What is proved of the polygons' K*.
struct Proof {
    double K_lower, K_upper;
};
Proof proof_of(const Surface& given, const ExtremalMap& map) {
    const Surface source = map.split ? surface_of(map.split->mesh, map.split->metric) : given;
    Proof proof{std::max(bounds_of_map(source, map.map).K(), map.K_lower_proved), map.K_max};
    const bool triangles = source.mesh.faces.corner_count() == 3 * source.mesh.face_count();
    if (!triangles || source.mesh.face_count() > kMostProofFaces || !map.one_to_one()) return proof;
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) boundary.pin(v, map.map[v]);
    VerifiedBracketOptions options;
    options.K_lower = proof.K_lower;
    const VerifiedBracket bracket = verified_bracket(source, boundary, map.map, options);
    return {std::max(proof.K_lower, bracket.K_lower), std::min(proof.K_upper, bracket.K_upper)};
}

void measure(const std::string& name, const Mesh& mesh) {
    const std::size_t rim = topology(mesh).boundary_loops.at(0).size();
    for (const double slack : {0.0, 0.5, 1.0}) {
        try {
            const auto [map, seconds, harmonic] = run(mesh, slack);
            const Proof proof = proof_of(Surface(mesh), map);
            fmt::print("| {} | {} | {} | {:g} | {:.4f} | {:.4f} | {:.2f} % | {:.4f} | {:.4f} | {:.2f} | ", name,
                       mesh.face_count(), rim, slack, map.K_lower, map.K, 100 * (map.K / map.K_lower - 1),
                       proof.K_lower, proof.K_upper, map.K_max);
            fmt::print("{} | {:.4f} | {:.4f} | {} | {} | {} | {:.1f} | {} |\n",
                       map.in_chart ? fmt::format("{:.4f}", map.in_chart->standard_deviation) : "–",
                       map.distortion.mean, map.distortion.standard_deviation, map.distortion.flipped.size(),
                       map.iterations, to_string(map.termination), seconds / harmonic, cause_of(map));
        } catch (const Error& error) {
            fmt::print("| {} | {} | {} | {:g} | {} |\n", name, mesh.face_count(), rim, slack, error.what());
        }
        std::fflush(stdout);
    }
}

/// The mesh as it is, and divided until it is large.
void measure_sizes(const std::string& name, Mesh mesh) {
    try {
        if (topology(mesh).boundary_loops.size() != 1) {
            fmt::print("| {} | no plane cuts one opening |\n", name);
            return;
        }
    } catch (const Error& error) {
        fmt::print("| {} | {} |\n", name, error.what());
        return;
    }
    measure(name, mesh);
    for (int divisions = 1; divisions <= kMostDivisions && mesh.face_count() < kLarge; ++divisions) {
        mesh = midpoint_subdivide(mesh).mesh;
        if (mesh.face_count() >= kLarge) measure(name + ", divided", mesh);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || !std::filesystem::is_directory(argv[1])) {
        std::fprintf(stderr, "usage: bench_scans FOLDER [NAME...]\n");
        return 2;
    }
    ready_memory(0);
    const std::vector<std::string> wanted(argv + 2, argv + argc);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        if (const auto ending = entry.path().extension(); ending == ".obj" || ending == ".off")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    fmt::print(
        "| scan | faces | rim | slack | K_lower | K | gap | polygons: K_lower_proved | K_upper | attained | std in the "
        "chart | "
        "mean "
        "| std | flips | iterations | termination | ratio | cause |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "|\n");
    for (const auto& file : files) {
        const std::string name = file.stem().string();
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
        try {
            const Mesh mesh = read_mesh(file).mesh;
            const Topology shape = topology(mesh);
            if (shape.components != 1 || shape.genus != 0 || is_planar(mesh)) continue;
            if (shape.boundary_loops.size() == 1) {
                measure_sizes(name, mesh);
            } else if (shape.boundary_loops.empty()) {
                measure_sizes(name + ", plane", bench::opened_by_plane(mesh));
                if (mesh.faces.corner_count() == 3 * mesh.face_count())
                    measure_sizes(name + ", seam", bench::opened_by_seam(mesh));
            }
        } catch (const Error& error) {
            fmt::print("| {} | {} |\n", name, error.what());
        }
    }
}
