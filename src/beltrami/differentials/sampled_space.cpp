#include <beltrami/differentials/sampled_space.h>

#include <array>
#include <cmath>

#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

/// Up to so many samples every value is kept: 30 MB for 40 functions.
constexpr int kMostDenseSamples = 45'000;
/// Edge of a cell in a domain of diameter 2. A power of degree 40 turns by less than half a radian from the middle of
/// a cell to its corner, where the cubic is off by half a percent; one of degree 10 by 1e-5.
constexpr double kCellSize = 0.018;
constexpr int kNodes = 4;
constexpr int kCellsPerChunk = 64;

/// i^q, the directions of the nodes.
Complex node_direction(int q) {
    constexpr std::array<std::array<double, 2>, 4> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return {directions[q & 3][0], directions[q & 3][1]};
}

}  // namespace

SampledSpace::SampledSpace(const Chart& chart, double phase) : chart_(chart) {
    if (chart.positions.size() <= kMostDenseSamples) return;
    grid_ = chart_grid(chart, phase, kCellSize);
    node_radius_ = 0.5 * kCellSize;
    // Each cell about the mean of its samples, which a cell at the rim may have on one side only.
    centres_ = Eigen::VectorXcd::Zero(grid_.cell_count());
    for (int c = 0; c < grid_.cell_count(); ++c) {
        for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) centres_[c] += chart.positions[grid_.samples[i]];
        centres_[c] /= static_cast<double>(grid_.offsets[c + 1] - grid_.offsets[c]);
    }
}

void SampledSpace::set(const DifferentialSpace& space) {
    space_ = &space;
    if (!interpolates()) {
        values_ = space.evaluate({chart_.positions, chart_.derivatives});
        for (Eigen::Index s = 0; s < values_.rows(); ++s)
            if (chart_.excluded[s]) values_.row(s).setZero();
        return;
    }
    ChartPoints nodes;
    nodes.positions.resize(kNodes * centres_.size());
    nodes.derivatives = Eigen::VectorXcd::Ones(nodes.positions.size());
    for (Eigen::Index c = 0; c < centres_.size(); ++c)
        for (int q = 0; q < kNodes; ++q)
            nodes.positions[kNodes * c + q] = centres_[c] + node_radius_ * node_direction(q);
    values_ = space.evaluate(nodes);
}

Eigen::VectorXcd SampledSpace::combination(const Eigen::VectorXcd& coefficients) const {
    Eigen::VectorXcd values = values_ * coefficients;
    if (!interpolates()) return values;
    Eigen::VectorXcd phi = Eigen::VectorXcd::Zero(chart_.positions.size());
    parallel_for(
        0, grid_.cell_count(),
        [&](int first, int last) {
            for (int c = first; c < last; ++c) {
                // Discrete Fourier transform of the nodes: coefficients of (w/r)^p.
                std::array<Complex, kNodes> taylor{};
                for (int p = 0; p < kNodes; ++p)
                    for (int q = 0; q < kNodes; ++q)
                        taylor[p] += 0.25 * std::conj(node_direction(p * q)) * values[kNodes * c + q];
                for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) {
                    const int s = grid_.samples[i];
                    const Complex w = (chart_.positions[s] - centres_[c]) / node_radius_;
                    const Complex value = taylor[0] + w * (taylor[1] + w * (taylor[2] + w * taylor[3]));
                    phi[s] = value * chart_.derivatives[s] * chart_.derivatives[s];
                }
            }
        },
        kCellsPerChunk);
    return phi;
}

Eigen::MatrixXcd SampledSpace::pair(const Eigen::MatrixXcd& weights) const {
    if (!interpolates()) return values_.transpose() * weights;
    Eigen::MatrixXcd at_nodes(values_.rows(), weights.cols());
    parallel_for(
        0, grid_.cell_count(),
        [&](int first, int last) {
            for (int c = first; c < last; ++c)
                for (Eigen::Index column = 0; column < weights.cols(); ++column) {
                    std::array<Complex, kNodes> moment{};
                    for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) {
                        const int s = grid_.samples[i];
                        const Complex w = (chart_.positions[s] - centres_[c]) / node_radius_;
                        Complex term = weights(s, column) * chart_.derivatives[s] * chart_.derivatives[s];
                        for (int p = 0; p < kNodes; ++p, term *= w) moment[p] += term;
                    }
                    for (int q = 0; q < kNodes; ++q) {
                        Complex weight = 0;
                        for (int p = 0; p < kNodes; ++p) weight += 0.25 * std::conj(node_direction(p * q)) * moment[p];
                        at_nodes(kNodes * c + q, column) = weight;
                    }
                }
        },
        kCellsPerChunk);
    return values_.transpose() * at_nodes;
}

}  // namespace beltrami
