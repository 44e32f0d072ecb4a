#include <beltrami/teichmuller/extremal_map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <beltrami/conformal/round_disk.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/linear/anderson.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/parallel.h>
#include <beltrami/teichmuller/dual_step.h>

namespace beltrami {

namespace {

/// Coefficients of flipped or nearly flipped samples are held here while φ is determined.
constexpr double kClip = 0.95;
/// k of the f-step stays below this.
constexpr double kLargest = 0.9999;
/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 8;

Complex clipped(Complex mu) {
    const double size = std::abs(mu);
    if (std::isnan(size)) return 0;
    if (std::isinf(size)) return kClip;
    return size > kClip ? mu * (kClip / size) : mu;
}

/// The c-step on a mesh: pairings over every sample, the norm over clusters, k over every sample again.
class DualStep {
  public:
    struct Result {
        Eigen::VectorXcd direction;  ///< coefficients of length 1
        Eigen::VectorXcd phi;        ///< #S
        double k = 0;
    };

    DualStep(const Surface& source, const Chart& chart, double phase, int cluster_count)
        : source_(source),
          chart_(chart),
          points_{chart.positions, chart.derivatives},
          clusters_(cluster_samples(source.operators, chart, phase, cluster_count)) {}

    const ChartPoints& points() const { return points_; }

    void set_space(const DifferentialSpace& space) {
        space_ = &space;
        problem_.basis = space.evaluate(clusters_.points);
        problem_.complex_coefficients = space.complex_coefficients();
    }

    /// @param start  direction to start from; empty at the very beginning
    Result solve(const Eigen::VectorXcd& mu, const Eigen::VectorXcd& start) {
        const int samples = source_.operators.sample_count();
        Eigen::VectorXcd weighted(samples);    // A b
        Eigen::VectorXd norm_weight(samples);  // A a
        problem_.weights = Eigen::VectorXd::Zero(problem_.basis.rows());
        for (int s = 0; s < samples; ++s) {
            if (chart_.excluded[s]) {
                weighted[s] = 0;
                norm_weight[s] = 0;
                continue;
            }
            const Complex m = clipped(mu[s]);
            const double size = std::norm(m), area = source_.operators.weights[s];
            weighted[s] = area / (1 - size) * m;
            norm_weight[s] = area * (1 + size) / (1 - size);
            problem_.weights[clusters_.cluster[s]] += clusters_.squared[s] * (1 + size) / (1 - size);
        }
        Eigen::VectorXcd at = start;
        for (int round = start.size() ? 1 : 0; round < 2; ++round) {
            const Eigen::Index given = at.size();
            at.conservativeResizeLike(Eigen::VectorXcd::Zero(space_->size()));
            const Eigen::VectorXcd phi = given ? space_->combination(points_, at) : Eigen::VectorXcd();
            set_pairing(weighted, norm_weight, phi, at);
            at = solve_dual(problem_, at).coefficients;
        }
        Result result;
        result.phi = space_->combination(points_, at);
        double norm = 0, pairing = 0;
        for (int s = 0; s < samples; ++s) {
            norm += norm_weight[s] * std::abs(result.phi[s]);
            pairing += std::real(weighted[s] * result.phi[s]);
        }
        result.k = norm > 0 ? dilatation_of_pairing(2 * pairing / norm) : 0.0;
        const double length = at.norm();
        result.direction = length > 0 ? Eigen::VectorXcd(at / length) : at;
        return result;
    }

  private:
    /// Pairings p_j = Σ A b φ_j and, where φ is known, the gradient of the exact norm there beyond that of the
    /// clusters.
    void set_pairing(const Eigen::VectorXcd& weighted, const Eigen::VectorXd& norm_weight, const Eigen::VectorXcd& phi,
                     const Eigen::VectorXcd& at) {
        const int samples = source_.operators.sample_count();
        Eigen::MatrixXcd right(samples, 2);
        right.col(0) = weighted;
        right.col(1).setZero();
        if (phi.size())
            for (int s = 0; s < samples; ++s)
                if (const double size = std::abs(phi[s]); size > 0)
                    right(s, 1) = norm_weight[s] / size * std::conj(phi[s]);
        const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(space_->size(), 2);
        const Eigen::MatrixXcd sum = parallel_sum(samples, zero, [&](int first, int last) -> Eigen::MatrixXcd {
            const ChartPoints part{points_.positions.segment(first, last - first),
                                   points_.derivatives.segment(first, last - first)};
            return space_->evaluate(part).transpose() * right.middleRows(first, last - first);
        });
        problem_.pairing = sum.col(0);
        problem_.correction.resize(0);
        if (phi.size() && phi.cwiseAbs().maxCoeff() > 0)
            problem_.correction = sum.col(1) - dual_gradient(problem_.basis, problem_.weights, problem_.basis * at);
    }

    const Surface& source_;
    const Chart& chart_;
    ChartPoints points_;
    SampleClusters clusters_;
    const DifferentialSpace* space_ = nullptr;
    DualProblem problem_;
};

/// ν = k conj(φ)/|φ|, 0 where φ says nothing.
Eigen::VectorXcd teichmueller_coefficient(double k, const Eigen::VectorXcd& phi) {
    Eigen::VectorXcd nu(phi.size());
    for (Eigen::Index s = 0; s < phi.size(); ++s) {
        const double size = std::abs(phi[s]);
        nu[s] = size > 0 ? k * std::conj(phi[s]) / size : 0.0;
    }
    return nu;
}

/// A rotation of the chart that turns with the source when the boundary values are carried along.
double phase_of(const Chart& chart, const BoundaryCondition& boundary) {
    Complex mean = 0, correlation = 0;
    for (const Complex image : boundary.images) mean += image;
    mean /= static_cast<double>(boundary.images.size());
    for (std::size_t i = 0; i < boundary.images.size(); ++i)
        correlation += chart.vertices[boundary.vertices[i]] * std::conj(boundary.images[i] - mean);
    return std::arg(correlation);
}

/// (direction of φ, k) as one real vector for the accelerated fixed-point iteration.
Eigen::VectorXd pack(const Eigen::VectorXcd& direction, double k) {
    Eigen::VectorXd x(2 * direction.size() + 1);
    x << direction.real(), direction.imag(), k;
    return x;
}

}  // namespace

void ExtremalOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(tolerance > 0 && tolerance < 1, "tolerance must lie between 0 and 1");
    demand(max_iterations >= 1, "max_iterations must be at least 1");
    demand(growth > 0, "growth must be positive");
    demand(anderson_window >= 0, "anderson_window must not be negative");
    demand(cluster_count >= 100, "cluster_count must be at least 100");
}

const char* to_string(Termination termination) {
    switch (termination) {
        case Termination::converged:
            return "converged";
        case Termination::iteration_limit:
            return "iteration_limit";
    }
    return "unknown";
}

ExtremalMap extremal_map(const Mesh& source, const BoundaryCondition& boundary, const ExtremalOptions& options) {
    return extremal_map(Surface(source), boundary, options);
}

ExtremalMap extremal_map(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options) {
    options.validate();
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    for (const int v : boundary.vertices)
        if (!source.topology.on_boundary[v])
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(v) + " is pinned inside; extremal maps take boundary values only",
                        "drop the pin, or use another method", {v});
    const Operators& operators = source.operators;
    ExtremalMap result;

    const Chart chart = round_disk_chart(source);
    result.factorizations += chart.factorizations;
    result.warnings = chart.warnings;

    BeltramiSolver solver(source, freedoms(boundary, source), kExpectedFactorizations);
    const Eigen::VectorXcd prescribed = prescribed_values(boundary, source);
    solver.factorize(Eigen::VectorXcd::Zero(operators.sample_count()));
    result.harmonic = solver.solve(prescribed);
    result.map = result.harmonic;

    DualStep dual(source, chart, phase_of(chart, boundary), options.cluster_count);
    std::unique_ptr<DifferentialSpace> space = PolynomialSpace::for_samples(operators.sample_count());
    dual.set_space(*space);

    Eigen::VectorXcd mu = beltrami_coefficient(operators, result.map);
    DualStep::Result step = dual.solve(mu, {});
    // Takes larger spaces while they raise k noticeably; returns whether it did.
    const auto grow = [&](double noticeable) {
        bool grown = false;
        while (auto larger = space->refined()) {
            dual.set_space(*larger);
            DualStep::Result more = dual.solve(mu, step.direction);
            const bool worth = more.k > step.k * (1 + noticeable);
            if (!worth) {
                dual.set_space(*space);
                break;
            }
            space = std::move(larger);
            step = std::move(more);
            grown = true;
        }
        return grown;
    };
    grow(options.growth);

    AndersonAcceleration anderson(options.anderson_window);
    Eigen::VectorXcd direction = step.direction;
    double k = step.k;
    result.termination = Termination::iteration_limit;
    result.history.push_back({k, 1.0, space->size()});
    while (result.iterations < options.max_iterations) {
        const Eigen::VectorXcd phi = space->combination(dual.points(), direction);
        result.map = solver.solve_near(teichmueller_coefficient(k, phi), prescribed, result.map);
        ++result.iterations;
        mu = beltrami_coefficient(operators, result.map);
        step = dual.solve(mu, direction);
        const double change = (step.direction - direction).norm(), k_change = std::abs(step.k - k);
        result.history.push_back({step.k, change, space->size()});
        if (options.progress && !options.progress(result.iterations, step.k))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));

        const bool settled = k_change < options.tolerance && (change < options.tolerance || step.k < options.tolerance);
        if (settled || k_change < 1e-3 * step.k) {
            const bool grown = grow(options.growth);
            if (grown) {
                anderson.reset();
                direction = step.direction;
                k = step.k;
                continue;
            }
        }
        if (settled) {
            result.termination = Termination::converged;
            break;
        }
        if (options.anderson_window > 0) {
            const Eigen::VectorXd next = anderson.next(pack(direction, k), pack(step.direction, step.k));
            const Eigen::Index m = direction.size();
            direction.real() = next.head(m);
            direction.imag() = next.segment(m, m);
            direction.normalize();
            k = std::clamp(next[2 * m], 0.0, kLargest);
        } else {
            direction = step.direction;
            k = std::min(step.k, kLargest);
        }
    }

    // The record: measured on the final map, with φ of the c-step of that map.
    result.factorizations += solver.factorization_count();
    result.distortion = distortion(operators, result.map);
    result.phi = step.phi;
    for (int s = 0; s < operators.sample_count(); ++s)
        if (chart.excluded[s]) result.phi[s] = 0;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        result.boundary_residual =
            std::max(result.boundary_residual, std::abs(result.map[boundary.vertices[i]] - boundary.images[i]));

    result.k = step.k;
    result.K = (1 + step.k) / (1 - step.k);
    result.K_max =
        result.distortion.flipped.empty() ? dilatation(result.distortion.max) : std::numeric_limits<double>::infinity();
    const ReichStrebel integrals = reich_strebel(source, chart, *space, step.direction, result.distortion.mu);
    if (integrals.valid) {
        result.K = integrals.estimate;
        result.k = (result.K - 1) / (result.K + 1);
        result.K_lower = std::max(1.0, integrals.lower);
        result.bounds.push_back({"reich_strebel", result.K_lower, Bound::Of::extremal, chart.exact});
        result.bounds.push_back({"reich_strebel_estimate", integrals.estimate, Bound::Of::extremal, false});
    }
    result.bounds.push_back({"mesh_harmonic", mesh_harmonic_bound(operators, result.harmonic), Bound::Of::mesh, true});
    if (std::isfinite(result.K_max)) result.bounds.push_back({"attained", result.K_max, Bound::Of::extremal, true});
    if (!result.distortion.flipped.empty())
        result.warnings.push_back(
            std::to_string(result.distortion.flipped.size()) +
            " faces are flipped in the result; it is not one-to-one there and no lower bound can be given");
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
    return result;
}

}  // namespace beltrami
