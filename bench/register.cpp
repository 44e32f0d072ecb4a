// Extremal maps of the sphere with landmarks: errors of k against closed forms, and processor seconds of registrations
// against one harmonic map of the source.
//
//     bench_register                       four and eight landmarks at 2048, 8192 and 32 768 faces
//     bench_register A B PAIRS [...]       seconds of maps A → B with a file of lines `source_vertex target_vertex`
//     bench_register --noisy MESH          a surface with boundary onto its own noisy copy, six landmarks inside (also
//                                          soft) that are off by two edges
//
// harmonic = operators, ordering, analysis, assembly, factorisation and solution, mean of three, of the mesh less one
// face; the maps of both surfaces to the sphere are timed apart.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>

#include "closed_harmonic.h"
#include "problems/noisy_copy.h"
#include "problems/sphere_landmarks.h"

namespace {

using namespace beltrami;

void oracle(const std::string& name, const bench::SphereLandmarks& problem) {
    const Surface surface(problem.mesh);
    const double start = bench::processor_seconds();
    const ExtremalSphereMap map = extremal_sphere_map(surface, problem.mesh.positions, problem.landmarks);
    fmt::print("| {} | {} | {:.5f} | {:.1e} | {:.4f} | {} | {} | {:.2f} |\n", name, problem.mesh.face_count(),
               problem.exact_k, map.k - problem.exact_k, map.weighted_deviation, map.distortion.flipped.size(),
               map.iterations, bench::processor_seconds() - start);
    std::fflush(stdout);
}

void oracles() {
    fmt::print(
        "| landmarks | faces | k | error of k | std | flips | steps | s |\n| --- | --- | --- | --- | --- | --- | --- | "
        "--- |\n");
    const std::vector<std::array<bench::TwoRings, 2>> eights{
        {{{.6, 1.5, .3}, {.7, 1.3, .55}}}, {{{.6, 1.5, .3}, {.8, 1.2, .9}}}, {{{.6, 1.5, .2}, {.9, 1.1, 1.0}}}};
    for (int level = 4; level <= 6; ++level) {
        for (const double amplitude : {1.0, 2.0, 4.0}) oracle("4", bench::four_landmarks(level, amplitude));
        for (const auto& [from, to] : eights) oracle("8", bench::eight_landmarks(level, from, to));
    }
}

Surface surface_of_file(const char* path) {
    return Surface(split_unusable_faces(remove_unreferenced(read_mesh(path).mesh).mesh).mesh);
}

void pair(const char* a, const char* b, const char* pairs) {
    const Surface source = surface_of_file(a), target = surface_of_file(b);
    std::vector<SurfaceLandmark> landmarks;
    for (const auto& row : read_rows(pairs, 2, "a landmark"))
        landmarks.push_back({static_cast<int>(row[0]), place_of_vertex(target.mesh, static_cast<int>(row[1]))});
    const double of_harmonic = bench::closed_harmonic_processor_seconds(source.mesh),
                 begun = bench::processor_seconds();
    (void)sphere_map(source);
    (void)sphere_map(target);
    const double middle = bench::processor_seconds();
    const SphereRegistration found = register_spheres(source, target, landmarks);
    const double whole = bench::processor_seconds() - middle, beyond = whole - (middle - begun);
    fmt::print(
        "| {} | {} | {} | {} | {:.4f} | {:.4f} | {:.4f} | {:.3f} | {} | {} | {} | {} | {:.3f} | {:.2f} | {:.0f} |\n", a,
        b, landmarks.size(), source.mesh.face_count(), found.map.k, found.inverse_k.value_or(0),
        found.map.weighted_deviation, found.map.distortion.max, found.map.distortion.flipped.size(),
        found.in_space.flipped.size(), found.unresolved.size(), found.map.iterations, of_harmonic, beyond,
        beyond / of_harmonic);
    std::fflush(stdout);
}

/// Landmarks that are met, and softer and softer ones.
void noisy(const char* path) {
    const Surface source = surface_of_file(path);
    fmt::print(
        "| weight | k | inverse's k | K_lower | K | flips | largest distance, edges | s |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const double weight : {std::numeric_limits<double>::infinity(), 1e4, 1e2, 1.0}) {
        const bench::NoisyCopy copy = bench::noisy_copy(source, {.weight = weight});
        const Surface target(copy.mesh);
        const double begun = bench::processor_seconds();
        const OpenRegistration found = register_open(source, target, copy.landmarks);
        fmt::print("| {:.0e} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {} | {:.3f} | {:.2f} |\n", weight, found.map.k,
                   found.inverse_k.value_or(0), found.map.K_lower, found.map.K, found.map.distortion.flipped.size(),
                   found.largest_distance.value_or(0) / copy.edge, bench::processor_seconds() - begun);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 1) {
        oracles();
        return 0;
    }
    if (argc == 3 && std::string(argv[1]) == "--noisy") {
        noisy(argv[2]);
        return 0;
    }
    fmt::print(
        "| from | onto | landmarks | faces | k | inverse's k | std | max | flips | in space | unresolved | steps | "
        "harmonic s | s beyond the spheres | ratio |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    try {
        for (int i = 1; i + 2 < argc; i += 3) pair(argv[i], argv[i + 1], argv[i + 2]);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
