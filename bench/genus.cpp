// Seconds of extremal maps between closed surfaces of genus 2 and more, in harmonic maps of the same mesh.
//
//     bench_genus [SOURCE TARGET]...     default: double tori onto deformed ones of other meshes, about 5 000 and
//                                        20 000 vertices; with `large` in place of files 100 000
//
// All in processor time, of all threads. harmonic = operators, ordering, analysis, assembly, factorisation and solution
// of the source less one face, mean of three. The others are one run each: the metric of curvature −1 of the source,
// its differentials, and all of a map: both metrics, differentials, marking by nearest points, iteration and places.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <string>

#include <beltrami/beltrami.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/registration/register_handles.h>

#include "closed_harmonic.h"

namespace {

using namespace beltrami;

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

Mesh stretched(Mesh mesh) {
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions(v, 1) *= 1.3 + 0.1 * mesh.positions(v, 0);
    return mesh;
}

void measure(const std::string& name, const Mesh& from, const Mesh& to, const Positions& start) {
    const double harmonic = bench::closed_harmonic_processor_seconds(from);
    const Surface source(from), target(to);
    const double t0 = bench::processor_seconds();
    const HyperbolicShape a(source);
    const double t1 = bench::processor_seconds();
    const int solves = a.differentials().solves;
    const double t2 = bench::processor_seconds();
    const HyperbolicShape b(target);
    const Marking marking = marking_by_vertices(source, a.metric().original, b.group(),
                                                nearest_vertices(target.mesh, b.metric().metric.triangles, start));
    const double t3 = bench::processor_seconds();
    const HyperbolicMap map = hyperbolic_map(a, b, marking.map);
    const double t4 = bench::processor_seconds();
    fmt::print(
        "| {} | {} / {} | {:.3f} | {:.2f} ({:.1f}, {} steps) | {:.2f} ({:.1f}, {} solves) | {:.2f} ({:.1f}, {} + {} "
        "steps) "
        "| {:.2f} ({:.1f}) | {:.0f} | {:.6f} | {:.5f} – {:.5f} | {:.5f} | {:.4f} / {:.3f} | {} / {} |\n",
        name, source.mesh.vertex_count(), target.mesh.vertex_count(), harmonic, t1 - t0, (t1 - t0) / harmonic,
        a.metric().iterations, t2 - t1, (t2 - t1) / harmonic, solves, t4 - t3, (t4 - t3) / harmonic, map.start_steps,
        map.history.size() - 1, t4 - t0, (t4 - t0) / harmonic, peak_megabytes(), map.k, map.K_lower, map.K_upper,
        map.K_homology, map.weighted_deviation, map.distortion.max, map.distortion.flipped.size(),
        map.in_space.flipped.size());
    std::fflush(stdout);
}

void measure(const std::string& name, double edge) {
    const Mesh source = double_torus(edge), target = stretched(double_torus(0.93 * edge));
    measure(name, source, target, stretched(source).positions);
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| source | vertices | harmonic s | metric s (harmonic maps) | differentials | iteration | all | peak MB | k | "
        "K_lower – K_upper | homology | std / max | flips, hyperbolic / in space |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    try {
        if (argc == 2 && std::string(argv[1]) == "large") {
            measure("double torus", 0.0145);
            return 0;
        }
        for (int i = 1; i + 1 < argc; i += 2) {
            const Mesh source = read_mesh(argv[i]).mesh;
            measure(argv[i], source, read_mesh(argv[i + 1]).mesh, source.positions);
        }
        if (argc > 1) return 0;
        for (const double edge : {0.065, 0.0325}) measure("double torus", edge);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
