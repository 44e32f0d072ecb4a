// A map of which a part is lost: its Beltrami coefficient is filled in from around the gap, and the map made from it.
#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdio>

int main() {
    const beltrami::Surface disk(beltrami::disk(40));
    const Eigen::VectorXcd z = beltrami::planar_coordinates(disk.mesh);
    Eigen::VectorXcd f(z.size());
    for (int v = 0; v < z.size(); ++v) f[v] = z[v] + 0.2 * z[v] * std::conj(z[v] * z[v]);
    Eigen::VectorXcd mu = beltrami::beltrami_coefficient(disk.operators, f);  // one a triangle, in the plane's frame

    // Lost: what lies within 0.35 of the point 0.3. The mean over neighbouring faces, again and again, fills it.
    std::vector<std::array<int, 2>> pairs;
    for (const auto& [left, right] : disk.topology.edge_faces)
        if (left >= 0 && right >= 0) pairs.push_back({left, right});
    std::vector<char> lost(static_cast<std::size_t>(mu.size()), 0);
    for (int s = 0; s < mu.size(); ++s) {
        const auto v = disk.operators.stencil(s);
        lost[s] = std::abs((z[v[0]] + z[v[1]] + z[v[2]]) / 3.0 - 0.3) < 0.35;
        if (lost[s]) mu[s] = 0;
    }
    for (int round = 0; round < 5000; ++round) {
        Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(mu.size());
        Eigen::VectorXd count = Eigen::VectorXd::Zero(mu.size());
        for (const auto& [left, right] : pairs) {
            sum[left] += mu[right], ++count[left];
            sum[right] += mu[left], ++count[right];
        }
        for (int s = 0; s < mu.size(); ++s)
            if (lost[s]) mu[s] = sum[s] / count[s];
    }

    beltrami::BoundaryCondition boundary;
    for (const int v : disk.topology.boundary_loops[0]) boundary.pin(v, f[v]);
    const Eigen::VectorXcd map = beltrami::quasiconformal_map(disk, mu, boundary);
    const Eigen::VectorXcd harmonic = beltrami::quasiconformal_map(disk, Eigen::VectorXcd::Zero(mu.size()), boundary);
    std::printf("%zu faces flipped; the map errs by at most %.4f in the gap and around it, one with mu = 0 by %.4f\n",
                beltrami::distortion(disk.operators, map).flipped.size(), (map - f).cwiseAbs().maxCoeff(),
                (harmonic - f).cwiseAbs().maxCoeff());
}
