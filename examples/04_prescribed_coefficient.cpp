// The map of a disk with a given Beltrami coefficient and given boundary values, and how well it has them.
#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdio>

int main() {
    using Complex = std::complex<double>;
    const beltrami::Surface disk(beltrami::disk(40));
    const Eigen::VectorXcd z = beltrami::planar_coordinates(disk.mesh);

    // f = z + 0.2 conj(z)^2 has the coefficient 0.4 conj(z): one value a sample, in the frame of the plane.
    Eigen::VectorXcd mu(disk.operators.sample_count());
    for (int s = 0; s < mu.size(); ++s) {
        Complex middle = 0;
        for (const int v : disk.operators.stencil(s)) middle += z[v] / 3.0;
        mu[s] = 0.4 * std::conj(middle);
    }
    const auto f = [](Complex p) { return p + 0.2 * std::conj(p * p); };
    beltrami::BoundaryCondition boundary;
    for (const int v : disk.topology.boundary_loops[0]) boundary.pin(v, f(z[v]));

    const Eigen::VectorXcd map = beltrami::quasiconformal_map(disk, mu, boundary);
    double error = 0;
    for (Eigen::Index v = 0; v < map.size(); ++v) error = std::max(error, std::abs(map[v] - f(z[v])));
    std::printf("largest error of the map %.1e, of its coefficient %.1e (root mean square)\n", error,
                beltrami::coefficient_error(disk, map, mu).l2);
}
