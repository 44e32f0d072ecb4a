// Points inside are dragged and the map follows, first with a boundary that stays, then with one that slides:
// ExtremalSolver keeps the factorisation's order, the chart and φ.
#include <beltrami/beltrami.h>

#include <cstdio>

/// The last point that is pinned goes to the right.
void drag(const beltrami::Surface& disk, const beltrami::Constraints& constraints) {
    beltrami::ExtremalSolver solver(disk, constraints);
    std::vector<beltrami::Complex> images = constraints.prescribed.images;
    for (int frame = 1; frame <= 10; ++frame) {
        images.back() = 0.02 * frame;
        const beltrami::ExtremalSolver::Update now = solver.update(images, 4);
        std::printf("pin at %.2f: k = %.4f, %d samples flipped\n", images.back().real(), now.k, now.flipped);
    }
    const beltrami::ExtremalMap last = solver.solve();
    std::printf("settled: K = %.4f, %zu faces flipped\n", last.K, last.distortion.flipped.size());
}

int main() {
    const beltrami::Surface disk(beltrami::disk(20));
    const auto place = [&](int v) { return beltrami::Complex(disk.mesh.positions(v, 0), disk.mesh.positions(v, 1)); };
    beltrami::BoundaryCondition boundary;
    for (const int v : disk.topology.boundary_loops[0]) boundary.pin(v, place(v));
    boundary.pin(0, 0.0);  // the pin, at the centre
    drag(disk, boundary);

    // The circle slides along itself, one point stays where it is: only their hyperbolic distance matters.
    const int other = 300;
    beltrami::Constraints sliding(beltrami::TargetDomain{beltrami::TargetCurve::circle(0, 1), {}});
    sliding.pin(other, place(other)).pin(0, 0.0);
    drag(disk, sliding);
}
