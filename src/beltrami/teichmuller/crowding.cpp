#include <beltrami/teichmuller/crowding.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Takes columns in the order of what is left of them beside those before, puts them in front, and leaves the others
/// out: Cholesky's factorisation, with pivots, of their products.
/// @return what makes those taken orthonormal, upper triangular
Eigen::MatrixXcd take_independent(Eigen::MatrixXcd& columns) {
    Eigen::MatrixXcd gram = complex_gram_upper(columns);
    gram.triangularView<Eigen::StrictlyLower>() = gram.adjoint();
    const Eigen::Index n = columns.cols();
    Eigen::MatrixXcd factor = Eigen::MatrixXcd::Zero(n, n);
    Eigen::VectorXd left = gram.diagonal().real();
    Eigen::Index count = 0;
    for (; count < n; ++count) {
        Eigen::Index most = 0;
        if (!(left.tail(n - count).maxCoeff(&most) > kDependent * kDependent)) break;
        most += count;
        columns.col(count).swap(columns.col(most));
        gram.col(count).swap(gram.col(most));
        gram.row(count).swap(gram.row(most));
        factor.col(count).swap(factor.col(most));
        std::swap(left[count], left[most]);
        const double size = std::sqrt(left[count]);
        factor(count, count) = size;
        for (Eigen::Index j = count + 1; j < n; ++j) {
            const Complex before = factor.col(count).head(count).dot(factor.col(j).head(count));
            factor(count, j) = (gram(count, j) - before) / size;
            left[j] -= std::norm(factor(count, j));
        }
    }
    columns.conservativeResize(Eigen::NoChange, count);
    return factor.topLeftCorner(count, count)
        .triangularView<Eigen::Upper>()
        .solve(Eigen::MatrixXcd::Identity(count, count));
}

/// Columns scaled to length 1 and made orthonormal, without those that all but depend on others.
Eigen::MatrixXcd orthonormal(Eigen::MatrixXcd columns) {
    for (Eigen::Index j = 0; j < columns.cols(); ++j)
        if (const double size = columns.col(j).norm(); size > 0) columns.col(j) /= size;
    // Twice: the first time leaves rounding over kDependent².
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::MatrixXcd change = take_independent(columns);
        columns = complex_product(columns, change);
    }
    return columns;
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

std::vector<RimNode> rim_nodes(const Surface& source, const Eigen::VectorXcd& map) {
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    std::vector<RimNode> rim;
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        rim.push_back({loop[i], length});
        length += std::abs(map[loop[(i + 1) % loop.size()]] - map[loop[i]]);
    }
    if (!(length > 0)) return {};
    for (RimNode& node : rim) node.way *= kTurn / length;
    return rim;
}

TabulatedSpace form_product_space(const Operators& operators, const std::vector<RimNode>& rim,
                                  const BeltramiSolver& solver) {
    const int samples = operators.sample_count(), forms = 2 * kWaves;
    Eigen::MatrixXcd form(samples, forms);
    for (int j = 1; !rim.empty() && j <= kWaves; ++j) {
        Eigen::VectorXcd wave = Eigen::VectorXcd::Zero(operators.vertex_count);
        for (const RimNode& node : rim) wave[node.node] = std::polar(1.0, j * node.way);
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
