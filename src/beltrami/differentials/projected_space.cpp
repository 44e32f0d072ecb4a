#include <beltrami/differentials/projected_space.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/differentials/differential_smoothing.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/linear/dense.h>

namespace beltrami {

namespace {

/// Up to so many holes and marks, every pair of them makes seeds; beyond, each goes with so many of the nearest.
constexpr int kAllPairs = 10, kNearest = 6;
/// Without a gap of this factor the space is not known at all.
constexpr double kNoGap = 3;
/// Within this distance of a marked point, as part of the root of the chart's area, φ² counts less in lengths: its
/// integral does not exist.
constexpr double kTame = 0.17;

std::string listed(const Eigen::VectorXd& values, Eigen::Index count) {
    std::ostringstream out;
    out.precision(2);
    for (Eigen::Index i = 0; i < std::min(count, values.size()); ++i) out << (i ? ", " : "") << values[i];
    return out.str();
}

/// Tangents of the circles through three neighbouring vertices: exact on circles, second order elsewhere.
Eigen::VectorXcd loop_tangents(const Surface& source, const Eigen::VectorXcd& z) {
    Eigen::VectorXcd tangents = Eigen::VectorXcd::Zero(z.size());
    for (const auto& loop : source.topology.boundary_loops) {
        const std::size_t n = loop.size();
        for (std::size_t i = 0; i < n; ++i) {
            // Inversion in the vertex sends that circle to a line parallel to the tangent.
            const Complex back = z[loop[(i + n - 1) % n]] - z[loop[i]], ahead = z[loop[(i + 1) % n]] - z[loop[i]];
            tangents[loop[i]] = ahead / std::norm(ahead) - back / std::norm(back);
        }
    }
    return tangents;
}

/// ψ ↦ conj(ψ − ∂̄V) for the best V; in the chart throughout.
class Projection {
  public:
    Projection(const Surface& source, const Chart& chart, const ProjectionOptions& options)
        : source_(source), chart_(chart), solver_(options.solver) {
        std::vector<Freedom> freedoms = freedoms_of(source, options);
        if (!solver_ || solver_->freedoms() != freedoms) solver_ = &own_solver_.emplace(source, std::move(freedoms), 1);
        Eigen::VectorXcd directions =
            options.tangents.size() ? options.tangents : loop_tangents(source, chart.vertices);
        std::vector<int> bad;
        for (int v = 0; v < source.operators.vertex_count; ++v) {
            if (!source.topology.on_boundary[v]) continue;
            const double length = std::abs(directions[v]);
            if (!(length > 0) || !std::isfinite(length)) bad.push_back(v);
            directions[v] /= length;
        }
        if (!bad.empty())
            throw Error(Cause::bad_option, "there is no tangent at boundary vertex " + std::to_string(bad.front()),
                        "neighbouring boundary vertices must not coincide in the chart", {Things::vertices, bad});
        solver_->factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()), directions);
        tangents_ = std::move(directions);
    }
    /// #V unit tangents in the chart.
    const Eigen::VectorXcd& tangents() const { return tangents_; }

    /// ∂̄ of the chart is ∂̄/conj(derivative) where it is conformal.
    /// @param seeds #S × any number
    Eigen::MatrixXcd operator()(const Eigen::MatrixXcd& seeds) const {
        const Eigen::Index samples = source_.operators.sample_count();
        const int count = static_cast<int>(seeds.cols());
        Eigen::MatrixXcd offsets = Eigen::MatrixXcd::Zero(samples, count);
        parallel_for_each(count, [&](int j) {
            for (Eigen::Index s = 0; s < samples; ++s)
                if (!chart_.excluded[s]) offsets(s, j) = -std::conj(chart_.derivatives[s]) * seeds(s, j);
        });
        const Eigen::MatrixXcd fields = solver_->solve_offsets(offsets);
        const Eigen::VectorXcd inverse = chart_.derivatives.cwiseInverse();
        Eigen::MatrixXcd& phi = offsets;
        parallel_for_each(count, [&](int j) {
            const Eigen::VectorXcd V = fields.col(j);
            for (Eigen::Index s = 0; s < samples; ++s) {
                if (chart_.excluded[s]) continue;
                const Complex dV = source_.operators.derivatives(static_cast<int>(s), V)[1];
                phi(s, j) = std::conj(seeds(s, j)) - std::conj(dV) * inverse[s];
            }
        });
        return phi;
    }

  private:
    static std::vector<Freedom> freedoms_of(const Surface& source, const ProjectionOptions& options) {
        std::vector<Freedom> result = freedoms({}, source);
        for (int v = 0; v < source.operators.vertex_count; ++v)
            if (source.topology.on_boundary[v]) result[v] = Freedom::sliding;
        for (const int v : options.marked) result[v] = Freedom::fixed;
        // An annulus turns freely, or nearly so.
        if (options.marked.empty() && source.topology.boundary_loops.size() == 2)
            result[source.topology.boundary_loops[0][0]] = Freedom::fixed;
        return result;
    }

    const Surface& source_;
    const Chart& chart_;
    BeltramiSolver* solver_;
    std::optional<BeltramiSolver> own_solver_;
    Eigen::VectorXcd tangents_;
};

/// Poles of the seeds: places in the holes, which may be double, and marked points.
std::vector<std::pair<Complex, Complex>> pairs_of_poles(const Chart& chart, const std::vector<int>& marked) {
    std::vector<Complex> poles;
    for (const Chart::Hole& hole : chart.holes) poles.push_back(hole.centre);
    for (const int v : marked) poles.push_back(chart.vertices[v]);
    const int n = static_cast<int>(poles.size()), holes = static_cast<int>(chart.holes.size());
    std::vector<std::pair<Complex, Complex>> pairs;
    for (int i = 0; i < n; ++i) {
        if (i < holes) pairs.push_back({poles[i], poles[i]});
        std::vector<int> others;
        others.reserve(static_cast<std::size_t>(n));
        for (int j = 0; j < n; ++j)
            if (j != i) others.push_back(j);
        if (n > kAllPairs) {
            std::stable_sort(others.begin(), others.end(), [&](int a, int b) {
                return std::abs(poles[a] - poles[i]) < std::abs(poles[b] - poles[i]);
            });
            others.resize(kNearest);
        }
        for (const int j : others)
            if (j > i || n > kAllPairs) pairs.push_back({poles[i], poles[j]});
    }
    return pairs;
}

Eigen::MatrixXd real_gram(const Eigen::MatrixXcd& functions, const Eigen::VectorXd& areas) {
    Eigen::MatrixXd both(2 * functions.rows(), functions.cols());
    both << areas.cwiseSqrt().asDiagonal() * functions.real(), areas.cwiseSqrt().asDiagonal() * functions.imag();
    return gram_lower(both);
}

}  // namespace

void ProjectionOptions::validate(const Surface& source) const {
    std::vector<int> bad;
    for (std::size_t i = 0; i < marked.size(); ++i)
        if (marked[i] < 0 || marked[i] >= source.operators.vertex_count ||
            std::count(marked.begin(), marked.begin() + static_cast<std::ptrdiff_t>(i), marked[i]))
            bad.push_back(marked[i]);
    if (!bad.empty())
        throw Error(Cause::bad_option, "vertex " + std::to_string(bad.front()) + " cannot be marked",
                    "name vertices of the mesh, each once", {Things::vertices, bad});
    if (!(least_gap >= 1)) throw Error(Cause::bad_option, "the least gap is below 1", "give a factor above 1");
    if (tangents.size() && tangents.size() != source.operators.vertex_count)
        throw Error(Cause::bad_option,
                    "there are " + std::to_string(tangents.size()) + " tangents for " +
                        std::to_string(source.operators.vertex_count) + " vertices",
                    "give one for every vertex, or none");
}

ProjectedSpace projected_space(const Surface& source, const Chart& chart, const ProjectionOptions& options) {
    options.validate(source);
    if (chart.holes.size() + 1 != source.topology.boundary_loops.size())
        throw Error(Cause::bad_option,
                    "the chart names " + std::to_string(chart.holes.size()) + " holes of " +
                        std::to_string(source.topology.boundary_loops.size() - 1),
                    "give a place inside every hole, or seeds");
    const auto pairs = pairs_of_poles(chart, options.marked);
    const Eigen::Index samples = source.operators.sample_count();
    Eigen::MatrixXcd seeds(samples, 2 * static_cast<Eigen::Index>(pairs.size()));
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (Eigen::Index s = 0; s < samples; ++s) {
            const Complex z = chart.positions[s];
            const Complex psi = std::conj(1.0 / ((z - pairs[i].first) * (z - pairs[i].second)));
            seeds(s, 2 * static_cast<Eigen::Index>(i)) = psi;
            seeds(s, 2 * static_cast<Eigen::Index>(i) + 1) = Complex(0, 1) * psi;
        }
    return projected_space(source, chart, seeds, options);
}

ProjectedSpace projected_space(const Surface& source, const Chart& chart, const Eigen::MatrixXcd& seeds,
                               const ProjectionOptions& options) {
    require_genus_zero(source);
    options.validate(source);
    const int samples = source.operators.sample_count();
    int on_boundary = 0;
    for (const int v : options.marked) on_boundary += source.topology.on_boundary[v];
    const int dimension =
        dimension_of_differentials(static_cast<int>(source.topology.boundary_loops.size()) - 1, on_boundary,
                                   static_cast<int>(options.marked.size()) - on_boundary);
    ProjectedSpace result{TabulatedSpace(Eigen::MatrixXcd(samples, 0)), dimension, {}, INFINITY, {}};
    if (dimension == 0) return result;

    Eigen::VectorXd areas(samples);
    for (int s = 0; s < samples; ++s)
        areas[s] = chart.excluded[s] ? 0.0 : source.operators.weights[s] * std::norm(chart.derivatives[s]);
    const Projection project(source, chart, options);
    const int count = static_cast<int>(seeds.cols());
    Eigen::VectorXd lengths(count);
    parallel_for_each(count, [&](int j) {
        double square = 0;
        for (int s = 0; s < samples; ++s)
            if (!chart.excluded[s]) square += areas[s] * std::norm(seeds(s, j));
        lengths[j] = std::sqrt(std::max(square, std::numeric_limits<double>::min()));
    });
    Eigen::MatrixXcd phi = project(seeds * lengths.cwiseInverse().asDiagonal());
    const DifferentialSmoothing smoothed(source, chart, project.tangents(), options.marked);
    parallel_for_each(count, [&](int j) { phi.col(j) = smoothed(phi.col(j)); });
    const double tame = kTame * kTame * areas.sum();
    for (int s = 0; s < samples; ++s)
        for (const int v : options.marked) {
            const double distance = std::norm(chart.positions[s] - chart.vertices[v]);
            areas[s] *= distance / (distance + tame);
        }
    const SymmetricEigen eigen = symmetric_eigen(real_gram(phi, areas));
    result.eigenvalues = eigen.values.reverse();
    const Eigen::VectorXd& values = result.eigenvalues;
    const double last = values.size() >= dimension ? values[dimension - 1] : 0.0,
                 next = values.size() > dimension ? values[dimension] : 0.0;
    result.gap = last / std::max(next, 0.0);
    const auto described = [&] {
        return std::to_string(dimension) +
               (dimension > 1 ? " eigenvalues should stand out and these are there: "
                              : " eigenvalue should stand out and these are there: ") +
               listed(values, dimension + 4);
    };
    if (!(last > 0) || !(result.gap >= kNoGap))
        throw Error(Cause::not_solved, "the quadratic differentials are not found: " + described(),
                    "a finer mesh, a smooth boundary or seeds that span the space are needed");
    if (result.gap < options.least_gap)
        result.warnings.push_back(
            {WarningKind::differentials, "the space of quadratic differentials hardly stands apart: " + described()});

    const Eigen::VectorXd scales = values.head(dimension).cwiseSqrt().cwiseInverse();
    phi = complex_product(
        phi, (eigen.vectors.rowwise().reverse().leftCols(dimension) * scales.asDiagonal()).cast<Complex>());
    for (int s = 0; s < samples; ++s) phi.row(s) *= chart.derivatives[s] * chart.derivatives[s];
    result.space = TabulatedSpace(std::move(phi));
    return result;
}

}  // namespace beltrami
