#include <beltrami/differentials/sampled_space.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Up to so many samples every value is kept: 30 MB for 40 functions.
constexpr int kMostDenseSamples = 45'000;
/// On larger ones spaces that compute values quickly do so for so many, samples times functions.
constexpr double kMostQuickValues = 1e7;
/// Edge of a cell in a domain of diameter 2. A power of degree 40 turns by less than half a radian from the middle of
/// a cell to its corner, where the cubic is off by half a percent; one of degree 10 by 1e-5.
constexpr double kCellSize = 0.018;
/// Edge of a cell per distance to the next corner or pin: 1/(z − p) is then interpolated to 1e-3 at worst; and to the
/// middle of the next hole, where powers up to the tenth or so are wanted.
constexpr double kCellSlope = 0.25, kHoleSlope = 0.06, kSmallestCell = 1e-4;
constexpr int kNodes = 4;
constexpr int kCellsPerChunk = 64;

/// i^q, the directions of the nodes.
Complex node_direction(int q) {
    constexpr std::array<std::array<double, 2>, 4> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return {directions[q & 3][0], directions[q & 3][1]};
}

}  // namespace

void take_means(const SamplePoints& means, const Eigen::MatrixXcd& at_points, Eigen::MatrixXcd& values) {
    for (const int s : means.samples) values.row(s).setZero();
    for (std::size_t i = 0; i < means.samples.size(); ++i) {
        const auto point = static_cast<Eigen::Index>(i);
        values.row(means.samples[i]) += means.weights[point] * at_points.row(point);
    }
}

void SampledSpace::set_means(SamplePoints means) {
    if (!large_) means_ = std::move(means);
}

void SampledSpace::keep_means(SamplePoints means) {
    large_ = false;
    means_ = std::move(means);
}

Eigen::VectorXcd SampledSpace::combination_at_means(const Eigen::VectorXcd& coefficients) const {
    if (means_.samples.empty()) return {};
    return at_means_.times(space_->of_generators(coefficients));
}

Eigen::MatrixXcd SampledSpace::pair_at_means(const Eigen::MatrixXcd& weights) const {
    return space_->from_generators(at_means_.transposed_times(weights));
}

SampledSpace::SampledSpace(const Chart& chart, const Singularities& singularities, double phase)
    : chart_(chart),
      phase_(phase),
      cell_size_(kCellSize, singularities, kCellSlope, kHoleSlope, kSmallestCell),
      large_(chart.positions.size() > kMostDenseSamples) {}

/// Whether values of a space are computed each time.
bool SampledSpace::made_afresh(const DifferentialSpace& space) const {
    return space.quick() &&
           (!large_ ||
            static_cast<double>(space.size()) * static_cast<double>(chart_.positions.size()) <= kMostQuickValues);
}

/// Sorts the samples into cells, unless these would be nearly as many.
SampledSpace::Mode SampledSpace::mode_on_large_mesh() {
    const auto samples = chart_.positions.size();
    grid_ = chart_grid(chart_, phase_, cell_size_);
    if (kNodes * grid_.cell_count() > samples / 2) {
        grid_ = {{}, {0}, {}, {}};
        return Mode::afresh;
    }
    // Each cell about the mean of its samples, which a cell at the rim may have on one side only.
    centres_ = Eigen::VectorXcd::Zero(grid_.cell_count());
    for (int c = 0; c < grid_.cell_count(); ++c) {
        for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) centres_[c] += chart_.positions[grid_.samples[i]];
        centres_[c] /= static_cast<double>(grid_.offsets[c + 1] - grid_.offsets[c]);
    }
    nodes_.positions.resize(kNodes * centres_.size());
    nodes_.derivatives = Eigen::VectorXcd::Ones(nodes_.positions.size());
    for (Eigen::Index c = 0; c < centres_.size(); ++c)
        for (int q = 0; q < kNodes; ++q)
            nodes_.positions[kNodes * c + q] = centres_[c] + 0.5 * grid_.size[c] * node_direction(q);
    return Mode::interpolated;
}

void SampledSpace::set(const DifferentialSpace& space) {
    space_ = &space;
    mode_ = Mode::dense;
    if (!space.tabulated()) {
        if (made_afresh(space)) {
            mode_ = Mode::afresh;
        } else if (large_) {
            if (!on_grid_) on_grid_ = mode_on_large_mesh();
            mode_ = *on_grid_;
        }
    }
    values_ = {};
    if (mode_ == Mode::afresh) return;
    if (mode_ == Mode::dense) {
        Eigen::MatrixXcd values =
            space.tabulated() ? *space.tabulated() : space.generators({chart_.positions, chart_.derivatives});
        if (values.rows() != static_cast<Eigen::Index>(chart_.excluded.size()))
            throw std::logic_error("SampledSpace: a tabulated space of other samples");
        if (!means_.samples.empty()) {
            const Eigen::MatrixXcd at_points = space.generators(means_.points);
            take_means(means_, at_points, values);
            at_means_ = SplitMatrix(at_points);
        }
        for (Eigen::Index s = 0; s < values.rows(); ++s)
            if (chart_.excluded[s]) values.row(s).setZero();
        values_ = SplitMatrix(values);
        return;
    }
    if (!space.quick()) values_ = SplitMatrix(space.generators(nodes_));
}

ChartPoints SampledSpace::chunk(int first, int last) const {
    return {chart_.positions.segment(first, last - first), chart_.derivatives.segment(first, last - first)};
}

Eigen::VectorXcd SampledSpace::combination(const Eigen::VectorXcd& coefficients) const {
    if (mode_ == Mode::interpolated)
        return interpolate(space_->quick() ? space_->combination(nodes_, coefficients)
                                           : values_.times(space_->of_generators(coefficients)));
    if (mode_ == Mode::dense) return values_.times(space_->of_generators(coefficients));
    const int samples = static_cast<int>(chart_.positions.size());
    Eigen::VectorXcd phi(samples);
    if (space_->quick()) {
        phi = space_->combination({chart_.positions, chart_.derivatives}, coefficients);
    } else {
        parallel_for(0, samples, [&](int first, int last) {
            phi.segment(first, last - first) = space_->combination(chunk(first, last), coefficients);
        });
    }
    for (int s = 0; s < samples; ++s)
        if (chart_.excluded[s]) phi[s] = 0;
    return phi;
}

Eigen::VectorXcd SampledSpace::interpolate(const Eigen::VectorXcd& at_nodes) const {
    Eigen::VectorXcd phi = Eigen::VectorXcd::Zero(chart_.positions.size());
    parallel_for(
        0, grid_.cell_count(),
        [&](int first, int last) {
            for (int c = first; c < last; ++c) {
                // Discrete Fourier transform of the nodes: coefficients of (w/r)^p.
                std::array<Complex, kNodes> taylor{};
                for (int p = 0; p < kNodes; ++p)
                    for (int q = 0; q < kNodes; ++q)
                        taylor[p] += 0.25 * std::conj(node_direction(p * q)) * at_nodes[kNodes * c + q];
                const double scale = 2 / grid_.size[c];
                for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) {
                    const int s = grid_.samples[i];
                    const Complex w = scale * (chart_.positions[s] - centres_[c]);
                    const Complex value = taylor[0] + w * (taylor[1] + w * (taylor[2] + w * taylor[3]));
                    phi[s] = value * chart_.derivatives[s] * chart_.derivatives[s];
                }
            }
        },
        kCellsPerChunk);
    return phi;
}

Eigen::MatrixXcd SampledSpace::pair(const Eigen::MatrixXcd& weights) const {
    if (mode_ == Mode::interpolated)
        return space_->quick() ? space_->pair(nodes_, gather(weights))
                               : space_->from_generators(values_.transposed_times(gather(weights)));
    if (mode_ == Mode::dense) return space_->from_generators(values_.transposed_times(weights));
    Eigen::MatrixXcd included = weights;
    const int samples = static_cast<int>(chart_.positions.size());
    for (int s = 0; s < samples; ++s)
        if (chart_.excluded[s]) included.row(s).setZero();
    if (space_->quick()) return space_->pair({chart_.positions, chart_.derivatives}, included);
    const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(space_->size(), weights.cols());
    return parallel_sum<Eigen::MatrixXcd>(samples, zero, [&](int first, int last) -> Eigen::MatrixXcd {
        return space_->pair(chunk(first, last), included.middleRows(first, last - first));
    });
}

/// What weights at the samples are as weights at the nodes: the adjoint of interpolate().
Eigen::MatrixXcd SampledSpace::gather(const Eigen::MatrixXcd& weights) const {
    Eigen::MatrixXcd at_nodes(nodes_.positions.size(), weights.cols());
    parallel_for(
        0, grid_.cell_count(),
        [&](int first, int last) {
            for (int c = first; c < last; ++c) {
                const double scale = 2 / grid_.size[c];
                for (Eigen::Index column = 0; column < weights.cols(); ++column) {
                    std::array<Complex, kNodes> moment{};
                    for (int i = grid_.offsets[c]; i < grid_.offsets[c + 1]; ++i) {
                        const int s = grid_.samples[i];
                        const Complex w = scale * (chart_.positions[s] - centres_[c]);
                        Complex term = weights(s, column) * chart_.derivatives[s] * chart_.derivatives[s];
                        for (int p = 0; p < kNodes; ++p, term *= w) moment[p] += term;
                    }
                    for (int q = 0; q < kNodes; ++q) {
                        Complex weight = 0;
                        for (int p = 0; p < kNodes; ++p) weight += 0.25 * std::conj(node_direction(p * q)) * moment[p];
                        at_nodes(kNodes * c + q, column) = weight;
                    }
                }
            }
        },
        kCellsPerChunk);
    return at_nodes;
}

}  // namespace beltrami
