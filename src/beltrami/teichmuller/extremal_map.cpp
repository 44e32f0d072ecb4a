#include <beltrami/teichmuller/extremal_map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/conformal/round_disk.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/polygon.h>
#include <beltrami/teichmuller/coarse_start.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 8;

/// A rotation of the chart that turns with the source when the boundary values are carried along.
double phase_of(const Chart& chart, const BoundaryCondition& boundary) {
    Complex mean = 0, correlation = 0;
    for (const Complex image : boundary.images) mean += image;
    mean /= static_cast<double>(boundary.images.size());
    for (std::size_t i = 0; i < boundary.images.size(); ++i)
        correlation += chart.vertices[boundary.vertices[i]] * std::conj(boundary.images[i] - mean);
    return std::arg(correlation);
}

/// Boundary values that no one-to-one map has: clockwise, coinciding, turning straight back or crossing themselves.
void require_possible(const BoundaryCondition& boundary, const Surface& source) {
    const auto& loop = source.topology.boundary_loops[0];
    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    std::vector<Complex> polygon;
    for (const int v : loop) polygon.push_back(images[v]);
    try {
        require_simple_polygon(polygon);
    } catch (const Error& error) {
        if (error.indices().empty())
            throw Error(Cause::bad_boundary, "the boundary values enclose no area or run clockwise",
                        "prescribe them counter-clockwise, as the boundary runs with the surface on its left");
        std::vector<int> vertices;
        std::string named;
        for (const int edge : error.indices()) {
            vertices.push_back(loop[edge]);
            named += (named.empty() ? "" : " and ") + std::to_string(loop[edge]);
        }
        throw Error(Cause::bad_boundary,
                    "the boundary values coincide, turn back or cross themselves at the boundary edges that begin at "
                    "the vertices " +
                        named,
                    "no one-to-one map has them; prescribe a simple curve", std::move(vertices));
    }
}

/// √ of the mean of |μ − k conj(φ)/|φ||², |μ| held at 1: how far a map is from the coefficient that the theory
/// promises.
double deviation(const Operators& operators, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi, double k) {
    double sum = 0, area = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const double size = std::abs(phi[s]);
        if (!(size > 0) || !std::isfinite(std::abs(mu[s]))) continue;
        const Complex m = std::abs(mu[s]) > 1 ? mu[s] / std::abs(mu[s]) : mu[s];
        sum += operators.weights[s] * std::norm(m - k * std::conj(phi[s]) / size);
        area += operators.weights[s];
    }
    return area > 0 ? std::sqrt(sum / area) : 0.0;
}

/// Where the deviation exceeds this part of k, k is no more than a rough estimate.
constexpr double kRough = 0.6;

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
    require_disk(source);
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    require_possible(boundary, source);
    for (const int v : boundary.vertices)
        if (!source.topology.on_boundary[v])
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(v) + " is pinned inside; extremal maps take boundary values only",
                        "drop the pin, or use another method", {v});
    const Operators& operators = source.operators;
    ExtremalMap result;

    BeltramiSolver solver(source, freedoms(boundary, source), kExpectedFactorizations);
    const Eigen::VectorXcd prescribed = prescribed_values(boundary, source);
    solver.factorize(Eigen::VectorXcd::Zero(operators.sample_count()));
    result.harmonic = solver.solve(prescribed);

    const Chart chart = round_disk_chart(source, solver);
    result.factorizations += chart.factorizations;
    result.warnings = chart.warnings;
    const double phase = phase_of(chart, boundary);

    HamiltonState state = coarse_start(source, boundary, chart, phase, options);
    CoefficientStep coefficient_step(source, chart, phase, options.cluster_count);
    HamiltonIteration iteration(source, solver, prescribed, coefficient_step, options);
    iteration.run(state, result.harmonic,
                  PolynomialSpace::starting_space(PolynomialSpace::largest_degree(operators.sample_count())), true);
    result.map = iteration.map();
    result.history = iteration.history();
    result.iterations = iteration.iterations();
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;
    const CoefficientStep::Result& step = iteration.last_step();

    // The record: measured on the final map, with φ of the c-step of that map.
    result.factorizations += solver.factorization_count();
    result.distortion = distortion(operators, result.map);
    result.phi = step.phi;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        result.boundary_residual =
            std::max(result.boundary_residual, std::abs(result.map[boundary.vertices[i]] - boundary.images[i]));

    result.k = step.k;
    result.K = (1 + step.k) / (1 - step.k);
    result.K_max =
        result.distortion.flipped.empty() ? dilatation(result.distortion.max) : std::numeric_limits<double>::infinity();
    const ReichStrebel integrals = reich_strebel(source, chart, *state.space, step.direction, result.distortion.mu);
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
        result.warnings.push_back("flipped faces in the result: " + std::to_string(result.distortion.flipped.size()) +
                                  "; it is not one-to-one there and no lower bound can be given");
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
    if (result.k > 1e-3 && deviation(operators, result.distortion.mu, step.phi, result.k) > kRough * result.k)
        result.warnings.push_back(
            "the map is far from constant dilatation: the mesh is too coarse for its shape, or the extremal map is not "
            "smooth; K is a rough estimate and K_lower may be far below K*");
    return result;
}

}  // namespace beltrami
