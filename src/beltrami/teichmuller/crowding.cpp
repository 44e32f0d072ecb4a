#include <beltrami/teichmuller/crowding.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <beltrami/base/constants.h>
#include <beltrami/certificate/chart_quadrilateral.h>
#include <beltrami/linear/dense.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// Values that force so much in a quadrilateral crowd in the chart (camel_b: 5; other scans 1.1 to 1.8).
constexpr double kCrowded = 3;
/// A face may have so many times that before its |μ| is held, but no less and no more than these.
constexpr double kAboveForced = 4, kLeastClip = 0.95, kMostClip = 0.99;
constexpr int kWaves = 6;
/// What is left of a product beside those taken before, as part of the first: less is mesh noise.
constexpr double kDependent = 1e-3;
/// Samples below which so many functions would fit anything.
constexpr int kLeastSamples = 10 * kWaves * (2 * kWaves + 1);

/// The way along the image of each boundary vertex, as an angle, and whether there is one.
std::pair<Eigen::VectorXd, bool> way_along_image(const std::vector<int>& loop, const Eigen::VectorXcd& map) {
    const auto n = static_cast<Eigen::Index>(loop.size());
    Eigen::VectorXd at(n);
    double length = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        at[i] = length;
        length += std::abs(map[loop[(i + 1) % n]] - map[loop[i]]);
    }
    return {at * (kTurn / length), length > 0};
}

/// The upper factor R of RᴴR = the Gram matrix of so many of the columns, each scaled to length 1: the one with most
/// left beside those before it comes next (Cholesky with pivots).
struct PivotedFactor {
    std::vector<Eigen::Index> columns;
    Eigen::MatrixXcd R;
};
/// @param upper the Gram matrix of all columns, of length 1
PivotedFactor pivoted_factor(const Eigen::MatrixXcd& upper) {
    const Eigen::Index n = upper.cols();
    const Eigen::MatrixXcd gram = upper.selfadjointView<Eigen::Upper>();
    Eigen::VectorXd left = gram.diagonal().real();
    PivotedFactor result;
    Eigen::MatrixXcd rows = Eigen::MatrixXcd::Zero(n, n);  // of R, for all columns
    for (Eigen::Index count = 0; count < n; ++count) {
        Eigen::Index next = 0;
        if (!(left.maxCoeff(&next) > kDependent * kDependent)) break;
        Eigen::RowVectorXcd row = gram.row(next) - rows.col(next).head(count).adjoint() * rows.topRows(count);
        row /= std::sqrt(left[next]);
        rows.row(count) = row;
        left -= row.cwiseAbs2().transpose();
        result.columns.push_back(next);
        for (const Eigen::Index taken : result.columns) left[taken] = 0;
    }
    const auto rank = static_cast<Eigen::Index>(result.columns.size());
    result.R = rows(Eigen::seqN(0, rank), result.columns);
    return result;
}

/// Columns scaled to length 1 and made orthonormal, those left out that depend on others.
Eigen::MatrixXcd orthonormal(Eigen::MatrixXcd columns) {
    for (Eigen::Index j = 0; j < columns.cols(); ++j)
        if (const double size = columns.col(j).norm(); size > 0) columns.col(j) /= size;
    const PivotedFactor factor = pivoted_factor(complex_gram_upper(columns));
    const auto rank = static_cast<Eigen::Index>(factor.columns.size());
    const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(rank, rank);
    Eigen::MatrixXcd combinations = Eigen::MatrixXcd::Zero(columns.cols(), rank);
    const Eigen::MatrixXcd inverse = factor.R.triangularView<Eigen::Upper>().solve(identity);
    combinations(factor.columns, Eigen::all) = inverse;
    columns = complex_product(columns, combinations);
    // Once more, for what rounding has left: the Gram matrix has the square of the condition.
    const Eigen::LLT<Eigen::MatrixXcd, Eigen::Upper> again(complex_gram_upper(columns));
    const Eigen::MatrixXcd correction = again.matrixU().solve(identity);
    return complex_product(columns, correction);
}

/// The K that quadrilaterals of the rim force in the chart.
double forced(const Surface& source, const Chart& chart, const Eigen::VectorXcd& harmonic) {
    const Eigen::VectorXcd images = harmonic(source.topology.boundary_loops[0]);
    return chart_quadrilateral_estimate(source, chart, {images.begin(), images.end()});
}

}  // namespace

bool values_crowd(const Surface& source, const Chart& chart, const Eigen::VectorXcd& harmonic) {
    return source.operators.sample_count() >= kLeastSamples && forced(source, chart, harmonic) >= kCrowded;
}

double crowded_clip(const Surface& source, const Chart& chart, const Eigen::VectorXcd& harmonic) {
    return std::clamp(k_of(kAboveForced * forced(source, chart, harmonic)), kLeastClip, kMostClip);
}

Chart uncrowded(const Surface& source, Chart chart, const Eigen::VectorXcd& harmonic) {
    const Operators& operators = source.operators;
    const Chart frames = chart_of_frames(source);
    chart.exact = false;
    chart.analytic = {};
    chart.derivatives = frames.derivatives;
    chart.excluded = frames.excluded;
    chart.excluded_faces = 0;
    chart.positions.setZero(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto corners = operators.stencil(s);
        for (const int v : corners) chart.positions[s] += harmonic[v] / static_cast<double>(corners.size());
        // Means of φ over several faces need one frame: that of the places.
        const Complex along = operators.derivatives(s, harmonic)[0];
        if (std::abs(along) > 0) chart.derivatives[s] *= along / std::abs(along);
    }
    return chart;
}

TabulatedSpace form_product_space(const Surface& source, const BeltramiSolver& solver,
                                  const Eigen::VectorXcd& harmonic) {
    const Operators& operators = source.operators;
    const int samples = operators.sample_count(), forms = 2 * kWaves;
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const auto [way, goes_round] = way_along_image(loop, harmonic);
    Eigen::MatrixXcd form(samples, forms);
    for (int j = 1; goes_round && j <= kWaves; ++j) {
        Eigen::VectorXcd wave = Eigen::VectorXcd::Zero(operators.vertex_count);
        for (std::size_t i = 0; i < loop.size(); ++i)
            wave[loop[i]] = std::polar(1.0, j * way[static_cast<Eigen::Index>(i)]);
        wave = solver.solve(wave);
        for (int s = 0; s < samples; ++s) {
            const auto [dz, dzbar] = operators.derivatives(s, wave);
            form(s, 2 * j - 2) = dz;
            form(s, 2 * j - 1) = std::conj(dzbar);
        }
    }
    const Eigen::ArrayXd root_areas = Eigen::Map<const Eigen::ArrayXd>(operators.weights.data(), samples).sqrt();
    Eigen::MatrixXcd products(samples, forms * (forms + 1) / 2);
    for (int i = 0, column = 0; i < forms; ++i)
        for (int j = i; j < forms; ++j) products.col(column++) = form.col(i).array() * form.col(j).array() * root_areas;
    products = orthonormal(std::move(products));
    for (Eigen::Index j = 0; j < products.cols(); ++j) products.col(j).array() /= root_areas;
    return TabulatedSpace(std::move(products), Coefficients::complex);
}

}  // namespace beltrami
