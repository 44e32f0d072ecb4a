// A point inside is dragged and the map follows: ExtremalSolver keeps the factorisation's order, the chart and φ.
#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const beltrami::Surface disk(beltrami::disk(20));
    beltrami::BoundaryCondition boundary;
    for (const int v : disk.topology.boundary_loops[0])
        boundary.pin(v, beltrami::Complex(disk.mesh.positions(v, 0), disk.mesh.positions(v, 1)));
    boundary.pin(0, 0.0);  // the pin, at the centre
    beltrami::ExtremalSolver solver(disk, boundary);
    std::vector<beltrami::Complex> images = boundary.images;
    for (int frame = 1; frame <= 10; ++frame) {
        images.back() = 0.02 * frame;
        const beltrami::ExtremalSolver::Update now = solver.update(images, 4);
        std::printf("pin at %.2f: k = %.4f, %d samples flipped\n", images.back().real(), now.k, now.flipped);
    }
    const beltrami::ExtremalMap last = solver.solve();
    std::printf("settled: K = %.4f, %zu faces flipped\n", last.K, last.distortion.flipped.size());
}
