#include <beltrami/differentials/differential_smoothing.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Coefficients of the polynomials that are fitted.
constexpr int kInner = 2, kRim = 3;
/// Samples for each coefficient, without which fewer are fitted.
constexpr int kSamplesPerCoefficient = 2;
/// Least pivot, relative to the mean square, of a fit that is determined.
constexpr double kDetermined = 1e-3;

}  // namespace

DifferentialSmoothing::DifferentialSmoothing(const Surface& source, const Chart& chart, Eigen::VectorXcd tangents,
                                             const std::vector<int>& marked)
    : source_(source), chart_(chart), squared_tangents_(std::move(tangents)) {
    const Operators& operators = source.operators;
    for (const int v : marked) marks_.push_back(chart.vertices[v]);
    factors_.resize(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) factors_[s] = pole_factor(chart.positions[s]);
    inverse_factors_ = factors_.cwiseInverse();
    for (int v = 0; v < operators.vertex_count; ++v) {
        const Complex factor = pole_factor(chart.vertices[v]);
        const bool known = source.topology.on_boundary[v] && std::norm(factor) > 0;
        squared_tangents_[v] = known ? squared_tangents_[v] * squared_tangents_[v] / factor : 0.0;
    }

    std::vector<std::vector<int>> stars(operators.vertex_count);
    for (int s = 0; s < operators.sample_count(); ++s)
        if (!chart.excluded[s])
            for (const int v : operators.stencil(s)) stars[v].push_back(s);
    std::vector<int> counts(operators.vertex_count);
    std::vector<Fit> chunks(static_cast<std::size_t>(operators.vertex_count) / kDefaultGrain + 1);
    parallel_for(0, operators.vertex_count, [&](int begin, int end) {
        Fit& fit = chunks[begin / kDefaultGrain];
        std::vector<int> wider;
        for (int v = begin; v < end; ++v) {
            const std::size_t before = fit.samples.size();
            if (source.topology.on_boundary[v]) {
                wider.clear();
                for (const int s : stars[v])
                    for (const int w : operators.stencil(s))
                        wider.insert(wider.end(), stars[w].begin(), stars[w].end());
                std::sort(wider.begin(), wider.end());
                wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
                add_fit(fit, wider, chart.vertices[v], kRim);
            } else {
                add_fit(fit, stars[v], chart.vertices[v], kInner);
            }
            counts[v] = static_cast<int>(fit.samples.size() - before);
        }
    });
    for (const int count : counts) offsets_.push_back(offsets_.back() + count);
    samples_.reserve(offsets_.back());
    weights_.reserve(offsets_.back());
    for (const Fit& fit : chunks) {
        samples_.insert(samples_.end(), fit.samples.begin(), fit.samples.end());
        weights_.insert(weights_.end(), fit.weights.begin(), fit.weights.end());
    }
}

Complex DifferentialSmoothing::pole_factor(Complex z) const {
    Complex factor = 1;
    for (const Complex p : marks_) factor *= z - p;
    return factor;
}

/// Those of the polynomial that fits best (by area).
void DifferentialSmoothing::add_fit(Fit& fit, const std::vector<int>& around, Complex place, int coefficients) const {
    const auto area = [&](int s) { return source_.operators.weights[s] * std::norm(chart_.derivatives[s]); };
    double mass = 0, spread = 0;
    for (const int s : around) {
        mass += area(s);
        spread += area(s) * std::norm(chart_.positions[s] - place);
    }
    if (!(mass > 0)) return;
    const double scale = std::sqrt(spread / mass);
    int n = std::clamp(static_cast<int>(around.size()) / kSamplesPerCoefficient, 1, coefficients);
    Eigen::VectorXcd first;  // row of the inverse of the Gram matrix that gives the constant coefficient
    for (; n > 1; --n) {
        Eigen::MatrixXcd gram = Eigen::MatrixXcd::Zero(n, n);
        Eigen::VectorXcd powers(n);
        for (const int s : around) {
            powers[0] = 1;
            for (int j = 1; j < n; ++j) powers[j] = powers[j - 1] * (chart_.positions[s] - place) / scale;
            gram += area(s) / mass * powers.conjugate() * powers.transpose();
        }
        const Eigen::LDLT<Eigen::MatrixXcd> factors(gram);
        if (!(factors.vectorD().real().minCoeff() > kDetermined)) continue;
        first = factors.solve(Eigen::VectorXcd::Unit(n, 0)).conjugate();
        break;
    }
    for (const int s : around) {
        Complex weight = n > 1 ? first[n - 1] : 1.0;
        for (int j = n - 2; j >= 0; --j) weight = weight * std::conj((chart_.positions[s] - place) / scale) + first[j];
        fit.samples.push_back(s);
        fit.weights.push_back(area(s) / mass * weight);
    }
}

Eigen::VectorXcd DifferentialSmoothing::operator()(const Eigen::VectorXcd& phi) const {
    Eigen::VectorXcd at_vertices = Eigen::VectorXcd::Zero(source_.operators.vertex_count);
    for (Eigen::Index v = 0; v < at_vertices.size(); ++v) {
        Complex value = 0;
        for (int i = offsets_[v]; i < offsets_[v + 1]; ++i)
            value += weights_[i] * phi[samples_[i]] * factors_[samples_[i]];
        const Complex square = squared_tangents_[v];
        at_vertices[v] = square == 0.0 ? value : std::real(value * square) / square;
    }
    Eigen::VectorXcd result = at_samples(source_.operators, at_vertices);
    for (Eigen::Index s = 0; s < result.size(); ++s)
        result[s] = chart_.excluded[s] ? 0.0 : result[s] * inverse_factors_[s];
    return result;
}

}  // namespace beltrami
