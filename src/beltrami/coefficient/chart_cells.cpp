#include <beltrami/coefficient/chart_cells.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Edge of a cell in a domain of radius 1; per distance to the circle, and least.
constexpr double kLargest = 0.1, kRimSlope = 0.5, kLeast = 0.008;
/// The nodes of a cell, and the places on a circle about its centre.
constexpr int kNodes = 3, kPlaces = 4;
/// What is added to the covariance of a cell, as part of its trace: the samples of a cell may lie on a line.
constexpr double kLeastCovariance = 1e-3;
/// How far the mean of the weights may lie from the centre, in standard deviations: weights of nodes stay positive.
constexpr double kFarthestMean = 0.7;
/// Turns the nodes of a cell against those of the one before.
constexpr double kGoldenAngle = 2.399963229728653;
constexpr int kCellsPerChunk = 64;

CellSize cell_size() {
    CellSize size(kLargest);
    size.shrink_towards_circle(kRimSlope, kLeast);
    return size;
}

/// The q-th of four places on the unit circle.
Complex on_circle(int q) {
    constexpr std::array<std::array<double, 2>, kPlaces> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return {directions[q & 3][0], directions[q & 3][1]};
}

/// The q-th of three directions, each a third of a turn from the next.
Complex node_direction(Complex first, int q) {
    constexpr double c = -0.5, s = std::numbers::sqrt3 / 2;
    return q == 0 ? first : first * Complex(c, q == 1 ? s : -s);
}

/// body(c) for every cell, which writes to places of its own.
template <class Body>
void for_each(int cells, const Body& body) {
    parallel_for(
        0, cells,
        [&](int first, int last) {
            for (int c = first; c < last; ++c) body(c);
        },
        kCellsPerChunk);
}

}  // namespace

ChartCells::ChartCells(const Chart& chart, const Eigen::VectorXd& areas, double phase)
    : chart_(chart), phase_(phase), grid_(chart_grid(chart, phase, cell_size())), cells_(grid_.cell_count()) {
    int nodes = 0, places = 0;
    for (int c = 0; c < cell_count(); ++c) {
        const int samples = grid_.offsets[c + 1] - grid_.offsets[c];
        const bool itself = samples <= kNodes;
        cells_[c] = {0, nodes, places, itself, 1, 0, 1, 0};
        nodes += itself ? samples : kNodes;
        places += itself ? samples : kPlaces;
    }
    nodes_.resize(nodes);
    places_.resize(places);
    for_each(cell_count(), [&](int c) { set_nodes(cells_[c], areas, c); });
}

void ChartCells::set_nodes(Cell& cell, const Eigen::VectorXd& areas, int index) {
    const int first = grid_.offsets[index], last = grid_.offsets[index + 1];
    if (cell.itself) {
        for (int i = first; i < last; ++i)
            nodes_[cell.node + i - first] = places_[cell.place + i - first] = chart_.positions[grid_.samples[i]];
        return;
    }
    double area = 0;
    for (int i = first; i < last; ++i) {
        const int s = grid_.samples[i];
        area += areas[s];
        cell.centre += areas[s] * chart_.positions[s];
    }
    cell.centre /= area;
    double xx = 0, xy = 0, yy = 0;
    for (int i = first; i < last; ++i) {
        const int s = grid_.samples[i];
        const Complex d = chart_.positions[s] - cell.centre;
        xx += areas[s] / area * d.real() * d.real();
        xy += areas[s] / area * d.real() * d.imag();
        yy += areas[s] / area * d.imag() * d.imag();
    }
    const double more = kLeastCovariance * (xx + yy);
    xx += more;
    yy += more;
    // The root of a symmetric matrix of two rows: (C + √det C) / √(trace C + 2 √det C).
    const double root = std::sqrt(xx * yy - xy * xy), scale = 1 / std::sqrt(xx + yy + 2 * root);
    xx = scale * (xx + root);
    yy = scale * (yy + root);
    xy *= scale;
    const double determinant = xx * yy - xy * xy;
    cell.xx = yy / determinant;
    cell.yy = xx / determinant;
    cell.xy = -xy / determinant;
    cell.direction = std::polar(std::numbers::sqrt2, phase_ + kGoldenAngle * index);
    for (int q = 0; q < kNodes; ++q) {
        const Complex d = node_direction(cell.direction, q);
        nodes_[cell.node + q] = cell.centre + Complex(xx * d.real() + xy * d.imag(), xy * d.real() + yy * d.imag());
    }
    for (int q = 0; q < kPlaces; ++q)
        places_[cell.place + q] = cell.centre + 0.5 * grid_.size[index] * std::polar(1.0, phase_) * on_circle(q);
}

Eigen::VectorXd ChartCells::node_weights(const Eigen::VectorXd& of_samples) const {
    Eigen::VectorXd weights(nodes_.size());
    for_each(cell_count(), [&](int c) {
        const Cell& cell = cells_[c];
        const int begin = grid_.offsets[c], end = grid_.offsets[c + 1];
        if (cell.itself) {
            for (int i = begin; i < end; ++i) weights[cell.node + i - begin] = of_samples[grid_.samples[i]];
            return;
        }
        double mass = 0;
        Complex mean = 0;
        for (int i = begin; i < end; ++i) {
            const int s = grid_.samples[i];
            mass += of_samples[s];
            mean += of_samples[s] * (chart_.positions[s] - cell.centre);
        }
        if (mass > 0) mean /= mass;
        mean = {cell.xx * mean.real() + cell.xy * mean.imag(), cell.xy * mean.real() + cell.yy * mean.imag()};
        const double far = std::abs(mean);
        if (far > kFarthestMean) mean *= kFarthestMean / far;
        for (int q = 0; q < kNodes; ++q)
            weights[cell.node + q] =
                mass / kNodes * (1 + std::real(std::conj(node_direction(cell.direction, q)) * mean));
    });
    return weights;
}

Eigen::VectorXcd ChartCells::place_weights(const Eigen::VectorXcd& of_samples) const {
    Eigen::VectorXcd weights(places_.size());
    const Complex turn = std::polar(1.0, -phase_);
    for_each(cell_count(), [&](int c) {
        const Cell& cell = cells_[c];
        const int begin = grid_.offsets[c], end = grid_.offsets[c + 1];
        if (cell.itself) {
            for (int i = begin; i < end; ++i) weights[cell.place + i - begin] = of_samples[grid_.samples[i]];
            return;
        }
        // Moments in units of the circle; the cubic's coefficients are the discrete Fourier transform of its
        // values at the places.
        const Complex scale = turn * (2 / grid_.size[c]);
        std::array<Complex, kPlaces> moment{};
        for (int i = begin; i < end; ++i) {
            const int s = grid_.samples[i];
            const Complex w = scale * (chart_.positions[s] - cell.centre);
            Complex term = of_samples[s];
            for (int p = 0; p < kPlaces; ++p, term *= w) moment[p] += term;
        }
        for (int q = 0; q < kPlaces; ++q) {
            Complex weight = 0;
            for (int p = 0; p < kPlaces; ++p) weight += 0.25 * std::conj(on_circle(p * q)) * moment[p];
            weights[cell.place + q] = weight;
        }
    });
    return weights;
}

}  // namespace beltrami
