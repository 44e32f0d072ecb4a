// The extremal map of a bump over the unit disk, whose boundary is turned unevenly, and its certificate.
#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdio>

int main() {
    // A surface in space over the disk.
    const beltrami::Mesh disk = beltrami::disk(beltrami::disk_rings_for_triangles(5000));
    beltrami::Mesh bump;
    bump.faces = disk.faces;
    bump.positions.resize(disk.vertex_count(), 3);
    for (int v = 0; v < disk.vertex_count(); ++v) {
        const double x = disk.positions(v, 0), y = disk.positions(v, 1);
        bump.positions.row(v) << x, y, 0.5 * std::exp(-4 * ((x - 0.2) * (x - 0.2) + y * y));
    }

    // Diagnosis, topology and operators once; boundary values; the map.
    const beltrami::Surface surface(bump);
    const beltrami::BoundaryCondition boundary = beltrami::boundary_to_disk(surface, 0.6);
    const beltrami::ExtremalMap result = beltrami::extremal_map(surface, boundary);

    std::printf("%s after %d iterations, %zu faces flipped\n", to_string(result.termination), result.iterations,
                result.distortion.flipped.size());
    std::printf("this map stretches by about %.4f nearly everywhere (|mu| = %.4f, standard deviation %.4f)\n", result.K,
                result.distortion.mean, result.distortion.standard_deviation);
    std::printf("K of any map with these boundary values is at least %.4f\n", result.K_lower);
}
