#include <beltrami/teichmuller/extremal_map.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/conformal/round_disk.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/mesh/error.h>
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
    iteration.run(state, result.harmonic, PolynomialSpace::for_samples(operators.sample_count()), true);
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
        result.warnings.push_back(
            std::to_string(result.distortion.flipped.size()) +
            " faces are flipped in the result; it is not one-to-one there and no lower bound can be given");
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
    return result;
}

}  // namespace beltrami
