#include <beltrami/coefficient/coefficient_step.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/base/parallel.h>
#include <beltrami/coefficient/differential_quadrature.h>
#include <beltrami/linear/dense.h>

namespace beltrami {

namespace {

/// δ of the rounded |φ| as part of its mean, per edge length of a sample in a domain of diameter 2: about |φ| at a
/// fraction of an edge from a simple zero.
constexpr double kRounding = 0.4;
/// Of tabulated spaces, of few functions, where Newton's method hardly needs it: on a handle that hardly takes part in
/// a map |φ| is a thousandth of its mean, and rounded off to more it does not tell its direction there.
constexpr double kRoundingOfTables = 1e-3;
/// On the nodes of cells, which do not become denser as samples do, at least this.
constexpr double kLeastRoundingOnCells = 0.005;
/// Where curves are, Newton's method needs the Hessian of what it minimises: so many clusters, at least.
constexpr int kClustersWithCurves = 12000;
/// Without a start, Newton's method begins with these values of δ, on the clusters.
constexpr std::array kColdRoundings{0.3, 0.1, 0.03};
/// … and ends each of them at steps of this length.
constexpr double kColdStep = 0.05;

Complex clipped(Complex mu, double clip) {
    const double square = std::norm(mu);
    if (std::isnan(square)) return 0;
    if (std::isinf(square)) return clip;
    return square > clip * clip ? mu * (clip / std::sqrt(square)) : mu;
}

/// Points of the canonical domain itself.
ChartPoints in_domain(const Eigen::VectorXcd& points) {
    return {points, Eigen::VectorXcd::Ones(points.size())};
}

Eigen::VectorXd areas_in_domain(const Operators& operators, const Chart& chart) {
    Eigen::VectorXd areas(operators.sample_count());
    parallel_for(0, operators.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s)
            areas[s] = chart.excluded[s] ? 0.0 : operators.weights[s] * std::norm(chart.derivatives[s]);
    });
    return areas;
}

/// How a dual problem ended, and its φ made of length 1.
CoefficientStep::Result result_of(const DualSolution& dual) {
    CoefficientStep::Result result;
    result.converged = dual.converged;
    result.newton_steps = dual.newton_steps;
    const double length = dual.coefficients.norm();
    result.direction = length > 0 ? Eigen::VectorXcd(dual.coefficients / length) : dual.coefficients;
    return result;
}

}  // namespace

CoefficientStep::CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities,
                                 double phase, int cluster_count, Eigen::VectorXd areas)
    : source_(source),
      chart_(chart),
      singularities_(singularities),
      phase_(phase),
      cluster_count_(cluster_count),
      sampled_(chart, singularities, phase),
      areas_(std::move(areas)) {
    soft_ = !singularities.curves.empty();
    edge_ = std::sqrt(areas_.sum() / static_cast<double>(source.operators.sample_count()));
}

CoefficientStep::CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities,
                                 double phase, int cluster_count, Sums sums)
    : CoefficientStep(source, chart, singularities, phase, cluster_count, areas_in_domain(source.operators, chart)) {
    if (sums == Sums::over_cells && singularities.empty() && chart.positions.size() > cluster_count) {
        cells_.emplace(chart, areas_, phase);
        quadrature_ = {cells_->nodes(), cells_->node_weights(areas_)};
    } else {
        make_clusters_near();
    }
}

CoefficientStep::CoefficientStep(const Surface& source, const Chart& chart, const Singularities& singularities,
                                 double phase, int cluster_count, SamplePoints means)
    : CoefficientStep(source, chart, singularities, phase, cluster_count, areas_in_domain(source.operators, chart)) {
    make_clusters(means);
    sampled_.keep_means(std::move(means));
}

void CoefficientStep::make_clusters_near() {
    SamplePoints means = points_near(singularities_, source_, chart_);
    make_clusters(means);
    sampled_.set_means(std::move(means));
}

void CoefficientStep::make_clusters(const SamplePoints& means) {
    clusters_ = cluster_samples(source_.operators, chart_, singularities_, phase_,
                                soft_ ? std::max(cluster_count_, kClustersWithCurves) : cluster_count_);
    set_quadrature(means);
}

/// The clusters' points; where a cluster is one sample that has several, those.
void CoefficientStep::set_quadrature(const SamplePoints& means) {
    const auto clusters = static_cast<std::size_t>(clusters_.points.positions.size());
    std::vector<int> samples(clusters, 0);
    std::vector<double> area(clusters, 0.0);
    for (std::size_t s = 0; s < clusters_.cluster.size(); ++s)
        if (clusters_.cluster[s] >= 0) {
            ++samples[clusters_.cluster[s]];
            area[clusters_.cluster[s]] += areas_[static_cast<Eigen::Index>(s)];
        }
    std::vector<Complex> places;
    std::vector<char> divided(clusters, 0);
    for (std::size_t i = 0; i < means.samples.size(); ++i) {
        const int cluster = clusters_.cluster[means.samples[i]];
        if (cluster < 0 || samples[cluster] != 1) continue;
        divided[cluster] = 1;
        places.push_back(means.points.positions[static_cast<Eigen::Index>(i)]);
        parts_.push_back({cluster, means.weights[static_cast<Eigen::Index>(i)]});
    }
    for (std::size_t q = 0; q < clusters; ++q)
        if (!divided[q]) {
            places.push_back(clusters_.points.positions[static_cast<Eigen::Index>(q)]);
            parts_.push_back({static_cast<int>(q), 1.0});
        }
    const auto all = static_cast<Eigen::Index>(places.size());
    quadrature_ = {Eigen::Map<const Eigen::VectorXcd>(places.data(), all), Eigen::VectorXd(all)};
    for (Eigen::Index q = 0; q < all; ++q) quadrature_.weights[q] = parts_[q].part * area[parts_[q].cluster];
}

/// Weights of the samples as weights of the points of the norm: the samples, and after them the points of samples that
/// have several, which leave 0 to their sample.
Eigen::VectorXd CoefficientStep::at_points(const Eigen::VectorXd& of_samples) const {
    const SamplePoints& means = sampled_.means();
    const Eigen::Index samples = of_samples.size(), points = means.weights.size();
    if (points == 0) return of_samples;
    Eigen::VectorXd result(samples + points);
    result.head(samples) = of_samples;
    for (Eigen::Index i = 0; i < points; ++i) result[samples + i] = means.weights[i] * of_samples[means.samples[i]];
    for (const int s : means.samples) result[s] = 0;
    return result;
}

void CoefficientStep::set_space(const DifferentialSpace& space) {
    sampled_.set(space);
    last_coefficients_.resize(0);
    bent_ = false;
    problem_.complex_coefficients = space.complex_coefficients();
    on_cells_ = cells_.has_value() && !space.tabulated();
    if (on_cells_) {
        problem_.basis = space.evaluate(in_domain(cells_->nodes()));
        at_places_ = SplitMatrix(space.generators(in_domain(cells_->places())));
        return;
    }
    if (clusters_.cluster.empty()) make_clusters_near();
    problem_.basis = space.tabulated() ? means_over_clusters(*space.tabulated(), clusters_, chart_)
                                       : space.evaluate(in_domain(quadrature_.points));
    if (space.tabulated() && space.transform()) problem_.basis = complex_product(problem_.basis, *space.transform());
}

const Eigen::VectorXcd& CoefficientStep::values(const Eigen::VectorXcd& coefficients) {
    if (coefficients.size() == 0) {  // of a space without functions, where the chart says nothing about any sample
        last_coefficients_.resize(0);
        last_values_ = Eigen::VectorXcd::Zero(source_.operators.sample_count());
        return last_values_;
    }
    if (coefficients.size() != last_coefficients_.size() || coefficients != last_coefficients_) {
        last_values_ = sampled_.combination(coefficients);
        last_coefficients_ = coefficients;
    }
    return last_values_;
}

Eigen::VectorXcd CoefficientStep::coefficient(double k, const Eigen::VectorXcd& phi) const {
    double delta = 0;
    if (soft_) {
        double sum = 0, area = 0;
        for (Eigen::Index s = 0; s < phi.size(); ++s) {
            if (chart_.excluded[s]) continue;
            sum += source_.operators.weights[s] * std::abs(phi[s]);  // |ψ| by area in the domain
            area += areas_[s];
        }
        delta = area > 0 ? std::max(least_rounding_, kRounding * edge_) * sum / area : 0.0;
    }
    Eigen::VectorXcd nu(phi.size());
    parallel_for(0, static_cast<int>(phi.size()), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const double rounded = delta > 0 ? delta * std::norm(chart_.derivatives[s]) : 0.0;
            const double size = std::sqrt(std::norm(phi[s]) + rounded * rounded);
            nu[s] = size > 0 ? k / size * std::conj(phi[s]) : 0.0;
        }
    });
    return nu;
}

namespace {

/// N on every sample of the mesh, and on the points of samples that have several. Values of φ: those of the samples,
/// then those of the points.
class SampleNorm final : public DualNorm {
  public:
    /// @param weights A a of every point, 0 where the chart excludes the sample
    /// @param known, values coefficients of which the values at the samples are known
    /// @param clusters the points of the problem
    SampleNorm(const SampledSpace& space, const Chart& chart, const SampleClusters& clusters,
               const Eigen::VectorXd& weights, const Eigen::VectorXcd& known, const Eigen::VectorXcd& values)
        : space_(space),
          chart_(chart),
          clusters_(clusters),
          weights_(weights),
          known_(known),
          values_(values),
          samples_(static_cast<int>(chart.excluded.size())) {}
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override {
        const Eigen::Index points = weights_.size() - samples_;
        if (points == 0) return at_samples(c);
        Eigen::VectorXcd all(weights_.size());
        all.head(samples_) = at_samples(c);
        all.tail(points) = space_.combination_at_means(c);
        return all;
    }
    double norm(const Eigen::VectorXcd& phi, double delta) const override {
        return parallel_sum<double>(static_cast<int>(phi.size()), 0.0, [&](int first, int last) {
            double sum = 0;
            for (int s = first; s < last; ++s) sum += weights_[s] * std::sqrt(square(phi[s], s, delta));
            return sum;
        });
    }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        Eigen::MatrixXcd direction(phi.size(), 1);
        parallel_for(0, static_cast<int>(phi.size()), [&](int first, int last) {
            for (int s = first; s < last; ++s) {
                const double of = square(phi[s], s, delta);
                direction(s, 0) = of > 0 ? weights_[s] / std::sqrt(of) * std::conj(phi[s]) : 0.0;
            }
        });
        const Eigen::Index points = phi.size() - samples_;
        if (points == 0) return space_.pair(direction);
        return space_.pair(direction.topRows(samples_)) + space_.pair_at_means(direction.bottomRows(points));
    }
    /// Of tables, whose functions are there at every sample.
    Eigen::MatrixXd hessian(const Eigen::VectorXcd& phi, double delta, const Eigen::VectorXd& reach) const override {
        const DifferentialSpace& space = space_.space();
        const bool by_clusters = reach.size() == clusters_.points.positions.size();
        if (!space.tabulated() || space.transform() || phi.size() != samples_ || !by_clusters) return {};
        Eigen::VectorXd rounded(samples_), reached(samples_);
        for (int s = 0; s < samples_; ++s) {
            const double square = std::norm(chart_.derivatives[s]);
            const int cluster = clusters_.cluster[s];
            rounded[s] = delta * square;
            reached[s] = cluster >= 0 ? reach[cluster] * square : 0.0;
        }
        return dual_hessian(*space.tabulated(), space.complex_coefficients(), weights_, phi, rounded, reached);
    }

  private:
    Eigen::VectorXcd at_samples(const Eigen::VectorXcd& c) const {
        if (c.size() == known_.size() && c.size() > 0) {
            const double factor = c.norm() / known_.norm();
            if ((c - factor * known_).norm() < 1e-14 * c.norm()) return factor * values_;
        }
        return space_.combination(c);
    }
    double square(Complex phi, int s, double delta) const {
        const Complex derivative =
            s < samples_ ? chart_.derivatives[s] : space_.means().points.derivatives[s - samples_];
        const double rounded = delta * std::norm(derivative);
        return std::norm(phi) + rounded * rounded;
    }
    const SampledSpace& space_;
    const Chart& chart_;
    const SampleClusters& clusters_;
    const Eigen::VectorXd& weights_;
    const Eigen::VectorXcd &known_, &values_;
    int samples_;
};

}  // namespace

CoefficientStep::Weights CoefficientStep::weights_of(const Eigen::VectorXcd& mu) const {
    const int samples = source_.operators.sample_count();
    Weights weights{Eigen::VectorXcd(samples), Eigen::VectorXd(samples)};
    parallel_for(0, samples, [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            weights.pairing[s] = 0;
            weights.norm[s] = 0;
            if (chart_.excluded[s]) continue;
            const Complex m = clipped(mu[s], clip_);
            const double square = std::norm(m), area = source_.operators.weights[s];
            weights.pairing[s] = area / (1 - square) * m;
            weights.norm[s] = area * (1 + square) / (1 - square);
        }
    });
    return weights;
}

CoefficientStep::Result CoefficientStep::solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start, double step,
                                               int newton_steps) {
    DualOptions options;
    options.max_steps = newton_steps;
    options.step = step;
    if (start.size() > 0) options.reach = moved_;
    const Weights weights = weights_of(mu);
    return on_cells_ ? solve_on_cells(weights, start, options) : solve_on_samples(weights, start, std::move(options));
}

Eigen::VectorXcd CoefficientStep::begin(const Eigen::VectorXcd& start) {
    Eigen::VectorXcd at = start;
    DualOptions cold;
    cold.step = kColdStep;
    // New densities are as far from what they have to be as all functions are without a start.
    if (at.size() == 0 || (soft_ && at.size() < problem_.basis.cols()))
        for (const double rounding : kColdRoundings) {
            problem_.rounding = rounding;
            at = solve_dual(problem_, at, cold).coefficients;
        }
    const double rounding = sampled_.space().tabulated() ? kRoundingOfTables : kRounding;
    problem_.rounding = std::max(least_rounding_, rounding * edge_);
    if (on_cells_) problem_.rounding = std::max(problem_.rounding, kLeastRoundingOnCells);
    return at;
}

CoefficientStep::Result CoefficientStep::solve_on_cells(const Weights& weights, const Eigen::VectorXcd& start,
                                                        const DualOptions& options) {
    const int samples = source_.operators.sample_count();
    {
        Weights in_domain{Eigen::VectorXcd(samples), Eigen::VectorXd(samples)};
        parallel_for(0, samples, [&](int first, int last) {
            for (int s = first; s < last; ++s) {
                const Complex derivative = chart_.derivatives[s];
                in_domain.pairing[s] = weights.pairing[s] * (derivative * derivative);
                in_domain.norm[s] = weights.norm[s] * std::norm(derivative);
            }
        });
        problem_.weights = cells_->node_weights(in_domain.norm);
        problem_.pairing =
            sampled_.space().from_generators(at_places_.transposed_times(cells_->place_weights(in_domain.pairing)));
    }
    const Eigen::VectorXcd at = begin(start);
    const DualSolution dual = solve_dual(problem_, at, options);
    moved_ = dual.moved;

    Result result = result_of(dual);
    result.phi = values(result.direction);
    const Eigen::Array3d sums = parallel_sum<Eigen::Array3d>(samples, Eigen::Array3d::Zero(), [&](int first, int last) {
        double pairing = 0, norm = 0, plain = 0;
        for (int s = first; s < last; ++s) {
            if (chart_.excluded[s]) continue;
            const double size = std::sqrt(std::norm(result.phi[s]));
            pairing += std::real(weights.pairing[s] * result.phi[s]);
            norm += weights.norm[s] * size;
            plain += source_.operators.weights[s] * size;
        }
        return Eigen::Array3d(pairing, norm, plain);
    });
    set_dilatation(sums[0], sums[1], sums[2], result);
    return result;
}

void CoefficientStep::set_dilatation(double pairing, double norm, double plain, Result& result) {
    if (!(norm > 0)) return;
    result.k = dilatation_of_pairing(2 * pairing / norm);
    result.merit = plain / (norm - 2 * pairing);
}

CoefficientStep::Result CoefficientStep::solve_on_samples(const Weights& weights, const Eigen::VectorXcd& start,
                                                          DualOptions options) {
    const int samples = source_.operators.sample_count();
    Eigen::VectorXd cluster_weight = Eigen::VectorXd::Zero(clusters_.points.positions.size());
    for (int s = 0; s < samples; ++s)
        if (clusters_.cluster[s] >= 0)
            cluster_weight[clusters_.cluster[s]] += weights.norm[s] * std::norm(chart_.derivatives[s]);
    const Eigen::VectorXd norm_weight = at_points(weights.norm);
    problem_.weights.resize(static_cast<Eigen::Index>(parts_.size()));
    for (std::size_t q = 0; q < parts_.size(); ++q)
        problem_.weights[static_cast<Eigen::Index>(q)] = parts_[q].part * cluster_weight[parts_[q].cluster];
    problem_.pairing = sampled_.pair(weights.pairing);
    const SampleNorm norm(sampled_, chart_, clusters_, norm_weight, last_coefficients_, last_values_);
    const Eigen::VectorXcd at = begin(start);
    options.norm = &norm;
    options.bent = bent_;
    const DualSolution dual = solve_dual(problem_, at, options);
    moved_ = dual.moved;
    bent_ = dual.bent;

    Result result = result_of(dual);
    const double length = dual.coefficients.norm();
    const Eigen::VectorXcd phi = length > 0 ? Eigen::VectorXcd(dual.phi / length) : dual.phi;
    result.phi = phi.head(samples);
    const double size = norm.norm(phi, 0);
    if (!(size > 0)) return result;
    last_coefficients_ = result.direction;
    last_values_ = result.phi;
    const Eigen::VectorXd areas =
        at_points(Eigen::Map<const Eigen::VectorXd>(source_.operators.weights.data(), samples));
    const double plain = parallel_sum<double>(static_cast<int>(phi.size()), 0.0, [&](int first, int last) {
        double sum = 0;
        for (int i = first; i < last; ++i)
            if (norm_weight[i] > 0) sum += areas[i] * std::sqrt(std::norm(phi[i]));
        return sum;
    });
    set_dilatation(dual.pairing / length, size, plain, result);
    return result;
}

}  // namespace beltrami
