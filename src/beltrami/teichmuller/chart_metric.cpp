#include <beltrami/teichmuller/chart_metric.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/base/parallel.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// Of a sample that the chart collapses to a point.
constexpr double kLeastScale = 1e-100;
/// To which c-steps are solved that measure noise, as part of φ: k is exact to the square.
constexpr double kNoiseStep = 0.1;
constexpr int kNoiseSteps = 20;

/// The surface with other positions; its operators are those of the old ones still.
Surface in_plane_of(const Surface& source, const Eigen::VectorXcd& z) {
    Surface plane = source;
    plane.metric.reset();
    plane.mesh.positions.resize(z.size(), 2);
    plane.mesh.positions.col(0) = z.real();
    plane.mesh.positions.col(1) = z.imag();
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        const auto& loop = source.topology.boundary_loops[l];
        for (std::size_t i = 0; i < loop.size(); ++i)
            plane.boundary_edge_lengths[l][i] = std::abs(z[loop[(i + 1) % loop.size()]] - z[loop[i]]);
    }
    return plane;
}

}  // namespace

ChartMetric::ChartMetric(const Surface& source, const Chart& chart)
    : plane_(in_plane_of(source, chart.vertices)),
      mu_(source.operators.sample_count()),
      derivatives_(source.operators.sample_count()) {
    const Operators& old = source.operators;
    Operators& now = plane_.operators;
    parallel_for(0, old.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            auto [a, b] = old.derivatives(s, chart.vertices);
            if (unseen(old, s, chart)) {  // a similarity in place of the chart
                a = std::max({std::abs(a), std::abs(b), kLeastScale});
                b = 0;
            }
            const double determinant = std::norm(a) - std::norm(b);
            mu_[s] = b / a;
            derivatives_[s] = a;
            // From f_z = a F_w + conj(b) F_w̄, f_z̄ = b F_w + conj(a) F_w̄.
            for (int j = old.offsets[s]; j < old.offsets[s + 1]; ++j)
                now.gradients[j] = (a * old.gradients[j] - b * std::conj(old.gradients[j])) / determinant;
            now.weights[s] = old.weights[s] * determinant;
        }
    });
    const MuStatistics statistics = mu_statistics(beltrami_coefficient(old, chart.vertices), old.weights);
    chart_mean_ = statistics.mean;

    chart_ = chart;
    chart_.exact = false;
    chart_.analytic = {};
    chart_.derivatives.setOnes();
    chart_.warnings.clear();
    chart_.excluded_faces = 0;
    for (int s = 0, last_face = -1; s < old.sample_count(); ++s) {
        chart_.excluded[s] = unseen(old, s, chart);
        if (chart_.excluded[s] && old.faces[s] != last_face) {
            ++chart_.excluded_faces;
            last_face = old.faces[s];
        }
    }
}

Chart ChartMetric::chart_on_surface() const {
    Chart chart = chart_;
    chart.derivatives = derivatives_;
    return chart;
}

Eigen::VectorXcd ChartMetric::coefficient_on_surface(const Eigen::VectorXcd& nu) const {
    Eigen::VectorXcd result(nu.size());
    parallel_for(0, static_cast<int>(nu.size()), [&](int first, int last) {
        for (int s = first; s < last; ++s) result[s] = compose_coefficients(mu_[s], nu[s], derivatives_[s]);
    });
    return result;
}

Eigen::VectorXcd ChartMetric::differential_on_surface(const Eigen::VectorXcd& phi) const {
    return phi.cwiseProduct(derivatives_.cwiseProduct(derivatives_));
}

double chart_noise(const Surface& source, const Chart& chart, const Eigen::VectorXcd& map, int degree, double phase,
                   int cluster_count) {
    CoefficientStep step(source, chart, {}, phase, cluster_count, CoefficientStep::Sums::over_cells);
    const PolynomialSpace space(degree, degree);
    step.set_space(space);
    // From a constant φ: from nothing at all the c-step would take its time.
    const Eigen::VectorXcd constant = Eigen::VectorXcd::Ones(1);
    const auto k_of = [&](const Eigen::VectorXcd& f) {
        return step.solve(beltrami_coefficient(source.operators, f), constant, kNoiseStep, kNoiseSteps).k;
    };
    const double k = k_of(map);
    return k > 0 ? k_of(chart.vertices) / k : std::numeric_limits<double>::infinity();
}

}  // namespace beltrami
