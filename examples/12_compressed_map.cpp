// A map kept as its boundary values and its Beltrami coefficient on a coarse mesh, and made again from these.
#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdio>

int main() {
    using Complex = std::complex<double>;
    const beltrami::Surface fine(beltrami::disk(60));
    const Eigen::VectorXcd z = beltrami::planar_coordinates(fine.mesh);
    Eigen::VectorXcd f(z.size());
    for (int v = 0; v < z.size(); ++v)
        f[v] = z[v] + 0.25 * std::conj(z[v]) * std::exp(Complex(0, 1) * z[v]) / (1.0 + std::norm(z[v]));

    // What is kept: mu at the vertices of a coarse mesh, the mean over the fine samples near them, and f on the
    // boundary.
    const beltrami::Surface coarse(beltrami::disk(10));
    const beltrami::PlanarLocator on_coarse(coarse.mesh);
    const Eigen::VectorXcd mu = beltrami::beltrami_coefficient(fine.operators, f);
    std::vector<beltrami::MeshPoint> places;
    Eigen::VectorXcd kept = Eigen::VectorXcd::Zero(coarse.mesh.vertex_count());
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(kept.size());
    for (int s = 0; s < mu.size(); ++s) {
        const auto v = fine.operators.stencil(s);
        places.push_back(on_coarse.nearest((z[v[0]] + z[v[1]] + z[v[2]]) / 3.0));
        for (int i = 0; i < 3; ++i) {
            const double near = std::pow(places.back().barycentric[i], 4);
            kept[places.back().vertices[i]] += near * mu[s];
            weight[places.back().vertices[i]] += near;
        }
    }
    kept.array() /= weight.array();
    beltrami::BoundaryCondition boundary;
    for (const int v : fine.topology.boundary_loops[0]) boundary.pin(v, f[v]);

    // Made again: linear between the kept values, then one linear solve.
    Eigen::VectorXcd read(mu.size());
    for (int s = 0; s < mu.size(); ++s) read[s] = places[static_cast<std::size_t>(s)].interpolate(kept);
    const Eigen::VectorXcd map = beltrami::quasiconformal_map(fine, read, boundary);
    std::printf("%ld numbers instead of %ld; the map errs by at most %.4f, %zu faces flipped\n",
                static_cast<long>(kept.size()) + static_cast<long>(boundary.vertices.size()),
                static_cast<long>(z.size()), (map - f).cwiseAbs().maxCoeff(),
                beltrami::distortion(fine.operators, map).flipped.size());
}
