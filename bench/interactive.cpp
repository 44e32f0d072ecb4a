// Updates a second of ExtremalSolver while a pin, or the whole boundary, is moved.
//
//     bench_interactive [TRIANGLES...]        default: 5000 20000
//
// Two drags of 60 steps each: the circle's image turns into three lobes while a pin inside is pulled across, and
// the boundary alone. Each update takes up to three iterations from where the solver stands; the last column compares k
// with that of a solve from nothing for the final position.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>

#include "arguments.h"

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Images at time t of the prescribed vertices: the boundary, then perhaps a pin.
std::vector<Complex> images_at(const Surface& surface, bool with_pin, double t) {
    std::vector<Complex> images;
    for (const int v : surface.topology.boundary_loops[0]) {
        const double angle = std::atan2(surface.mesh.positions(v, 1), surface.mesh.positions(v, 0));
        images.push_back(std::polar(1 + 0.25 * t * std::cos(3 * angle), angle + 0.3 * t * std::sin(angle)));
    }
    if (with_pin) images.emplace_back(0.25 * t, 0.15 * t);
    return images;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<int> sizes =
        bench::numbers_of(argc, argv, 100, {5'000, 20'000}, "bench_interactive [TRIANGLES...]");
    constexpr int kSteps = 60, kIterations = 3;
    fmt::print(
        "| drag | triangles | updates a second | slowest update, ms | flips, all updates | k of the last update | k "
        "from "
        "nothing |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const bool with_pin : {false, true})
        for (const int size : sizes) {
            const Surface surface(disk(disk_rings_for_triangles(size)));
            BoundaryCondition boundary;
            for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, 0.0);
            if (with_pin) boundary.pin(0, 0.0);  // the disk's centre
            boundary.images = images_at(surface, with_pin, 0.05);
            ExtremalSolver solver(surface, boundary);
            solver.solve();
            double slowest = 0, k = 0;
            int flips = 0;
            const double start = now();
            for (int step = 1; step <= kSteps; ++step) {
                const double before = now();
                const ExtremalSolver::Update update =
                    solver.update(images_at(surface, with_pin, 0.05 + 0.95 * step / kSteps), kIterations);
                slowest = std::max(slowest, now() - before);
                flips += update.flipped;
                k = update.k;
            }
            const double seconds = now() - start;
            boundary.images = images_at(surface, with_pin, 1);
            const ExtremalMap fresh = extremal_map(surface, boundary);
            fmt::print("| {} | {} | {:.0f} | {:.0f} | {} | {:.5f} | {:.5f} |\n",
                       with_pin ? "boundary and pin" : "boundary", surface.mesh.face_count(), kSteps / seconds,
                       1e3 * slowest, flips, k, fresh.history.back().k);
            std::fflush(stdout);
        }
}
