#include <beltrami/baselines/perturbation_formula.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/quasiconformal_map.h>

namespace beltrami {

namespace {

constexpr double kShortest = 1e-4;  // step length below which no step is taken
constexpr int kGrain = 64;

bool folded(const Operators& operators, const Eigen::VectorXcd& map) {
    return parallel_sum(operators.sample_count(), 0, [&](int first, int last) {
               int count = 0;
               for (int s = first; s < last; ++s) {
                   const auto [dz, dzbar] = operators.derivatives(s, map);
                   count += !(std::norm(dzbar) < std::norm(dz));
               }
               return count;
           }) > 0;
}

/// ρ = (σ − μ)/(1 − |μ|²) ∂f/conj(∂f).
Eigen::VectorXcd change_towards(const Operators& operators, const Eigen::VectorXcd& map,
                                const Eigen::VectorXcd& wanted) {
    Eigen::VectorXcd change(wanted.size());
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto [dz, dzbar] = operators.derivatives(s, map);
        const Complex mu = dzbar / dz;
        change[s] = (wanted[s] - mu) / (1 - std::norm(mu)) * dz / std::conj(dz);
    }
    return change;
}

}  // namespace

Eigen::VectorXcd perturbation_motion(const FaceList& faces, const Eigen::VectorXcd& image,
                                     const Eigen::VectorXcd& change) {
    Eigen::VectorXcd middle(faces.size()), strength(faces.size());
    for (int f = 0; f < faces.size(); ++f) {
        const Complex a = image[faces[f][0]], b = image[faces[f][1]], c = image[faces[f][2]];
        const double area = 0.5 * std::abs(std::imag(std::conj(b - a) * (c - a)));
        const Complex z = (a + b + c) / 3.0;
        middle[f] = z;
        strength[f] = change[f] * area / (z * (z - 1.0));
    }
    Eigen::VectorXcd motion(image.size());
    parallel_for(
        0, static_cast<int>(image.size()),
        [&](int first, int last) {
            for (int v = first; v < last; ++v) {
                const Complex w = image[v];
                const Complex sum = (strength.array() / (middle.array() - w)).sum();
                motion[v] = -w * (w - 1.0) / std::numbers::pi * sum;
            }
        },
        kGrain);
    return motion;
}

PerturbationFlow perturbation_flow(const Surface& source, const Eigen::VectorXcd& mu,
                                   const PerturbationFlowOptions& options) {
    require_coefficient(source, mu);
    if (!source.in_plane() || source.operators.sample_count() != source.mesh.face_count())
        throw Error(Cause::bad_mesh, "the perturbation formula is for triangles in the plane");
    PerturbationFlow result;
    result.map = *source.coordinate();
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        for (const int v : loop) held[v] = 1;
    while (result.iterations < options.max_iterations && !result.converged) {
        Eigen::VectorXcd motion =
            perturbation_motion(source.mesh.faces, result.map, change_towards(source.operators, result.map, mu));
        for (Eigen::Index v = 0; v < motion.size(); ++v)
            if (held[v]) motion[v] = 0;
        double length = 1;
        while (length > kShortest && folded(source.operators, result.map + length * motion)) length *= 0.5;
        if (length <= kShortest) break;
        result.map += length * motion;
        ++result.iterations;
        result.converged = length * motion.cwiseAbs().maxCoeff() < options.tolerance;
    }
    return result;
}

}  // namespace beltrami
