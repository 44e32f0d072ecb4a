#include <beltrami/charts/averaged_coefficient.h>

#include <cmath>

#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// cos of the largest angle between the roots of φ in a star, up to sign, with which they count as one branch.
constexpr double kSameBranch = 0.5;

}  // namespace

Eigen::VectorXcd averaged_coefficient(const Surface& source, const Chart& chart, const Eigen::VectorXcd& phi,
                                      const Eigen::VectorXcd& map) {
    const Operators& operators = source.operators;
    const int samples = operators.sample_count(), vertices = operators.vertex_count;
    Eigen::VectorXcd mu = beltrami_coefficient(operators, map);

    // √φ in the frame of the chart, where neighbours can be compared; 0 where there is nothing to average.
    Eigen::VectorXcd root = Eigen::VectorXcd::Zero(samples);
    for (int s = 0; s < samples; ++s)
        if (!chart.excluded[s] && std::norm(chart.derivatives[s]) > 0)
            root[s] = std::sqrt(phi[s] / (chart.derivatives[s] * chart.derivatives[s]));

    // Of every star: its first root, which decides the branch, and the sums of conj(√φ)∂f and √φ∂̄f.
    Eigen::VectorXcd branch = Eigen::VectorXcd::Zero(vertices), dz_sum = branch, dzbar_sum = branch;
    std::vector<char> usable(vertices, 1);
    const auto side = [&](int s, int v) { return std::real(root[s] * std::conj(branch[v])) < 0 ? -1.0 : 1.0; };
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(vertices);
    for (int s = 0; s < samples; ++s) {
        if (root[s] == 0.0) continue;
        const auto [dz, dzbar] = operators.derivatives(s, map);
        const Complex in_frame = root[s] * chart.derivatives[s];
        for (const int v : operators.stencil(s)) {
            if (branch[v] == 0.0) branch[v] = root[s];
            const double size = std::abs(root[s]) * std::abs(branch[v]);
            if (std::abs(std::real(root[s] * std::conj(branch[v]))) < kSameBranch * size) usable[v] = 0;
            const double signed_area = side(s, v) * operators.weights[s];
            dz_sum[v] += signed_area * std::conj(in_frame) * dz;
            dzbar_sum[v] += signed_area * in_frame * dzbar;
            weight[v] += operators.weights[s] * std::norm(in_frame);
        }
    }
    for (int s = 0; s < samples; ++s) {
        if (root[s] == 0.0) continue;
        Complex dz = 0, dzbar = 0;
        for (const int v : operators.stencil(s)) {
            if (!usable[v]) continue;
            dz += side(s, v) / weight[v] * dz_sum[v];
            dzbar += side(s, v) / weight[v] * dzbar_sum[v];
        }
        const double size = std::abs(phi[s]);
        if (dz != 0.0 && size > 0) mu[s] = dzbar / dz * (std::conj(phi[s]) / size);
    }
    return mu;
}

}  // namespace beltrami
