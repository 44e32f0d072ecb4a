#include <beltrami/flow/beltrami_flow.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/flow/coefficient_error_sum.h>
#include <beltrami/solve/quasiconformal_map.h>
#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/solve/vertex_samples.h>
#include <beltrami/starts/sliding_loops.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 6;
/// |ν| of a damped step, where the map at hand is folded.
constexpr double kMostNu = 0.98;
/// Beyond this part of the residual the misfit counts as one; below the other value all is rounding.
constexpr double kMisfit = 0.4, kRounding = 1e-9;

/// Root mean square of b − a by that of a's distance from its mean, over the vertices of faces.
double relative_change(const Surface& source, const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    const std::vector<int>& vertices = source.operators.vertices;
    Complex mean = 0;
    for (const int v : vertices) mean += a[v] / static_cast<double>(vertices.size());
    double moved = 0, size = 0;
    for (const int v : vertices) {
        moved += std::norm(b[v] - a[v]);
        size += std::norm(a[v] - mean);
    }
    return std::sqrt(moved / size);
}

/// What a step asks for: the coefficient, or a mean of it and that of the map at hand.
Eigen::VectorXcd asked_for(const Surface& source, const Eigen::VectorXcd& map, const Eigen::VectorXcd& mu,
                           double step) {
    if (step == 1) return mu;
    Eigen::VectorXcd nu = beltrami_coefficient(source.operators, map);
    for (Eigen::Index s = 0; s < nu.size(); ++s) {
        if (!std::isfinite(std::abs(nu[s]))) nu[s] = mu[s];
        nu[s] = (1 - step) * nu[s] + step * mu[s];
        const double size = std::abs(nu[s]);
        if (size > std::max(kMostNu, std::abs(mu[s]))) nu[s] *= kMostNu / size;
    }
    return nu;
}

}  // namespace

void FlowOptions::validate() const {
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance must be positive");
    if (max_iterations < 1) throw Error(Cause::bad_option, "there must be at least one iteration");
    if (!(step > 0 && step <= 1)) throw Error(Cause::bad_option, "the step of the flow must be above 0 and at most 1");
}

CoefficientError coefficient_error(const Surface& source, const Eigen::VectorXcd& map, const Eigen::VectorXcd& mu) {
    const Operators& operators = source.operators;
    CoefficientErrorSum sums;
    // (∂̄f − μ∂f)/conj(∂f) is the same in every frame of the source, so that it can be averaged.
    Eigen::VectorXcd turned(operators.sample_count());
    Eigen::VectorXd image(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto [dz, dzbar] = operators.derivatives(s, map);
        const double w = operators.weights[s];
        image[s] = w * std::norm(dz);
        turned[s] = w * (dzbar - mu[s] * dz) * dz;  // the coefficient on the target, by weight
        sums.add(w, dz, dzbar, mu[s]);
    }

    const VertexSamples around(operators);
    Eigen::VectorXcd mean = Eigen::VectorXcd::Zero(operators.vertex_count);
    for (int v = 0; v < operators.vertex_count; ++v) {
        double sum = 0;
        for (const auto& corner : around[v]) {
            mean[v] += turned[corner.sample];
            sum += image[corner.sample];
        }
        if (sum > 0) mean[v] /= sum;
    }
    double smooth = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        Complex sum = 0;
        for (const int v : operators.stencil(s)) sum += mean[v];
        smooth += image[s] * std::norm(sum / static_cast<double>(operators.stencil(s).size()));
    }
    return sums.error(smooth);
}

bool coefficient_fits(const CoefficientError& error) {
    return error.misfit < std::max(kMisfit * error.residual, kRounding);
}

Warning misfit_warning(const CoefficientError& error) {
    return {WarningKind::coefficient,
            "the coefficient does not belong to a map onto this target: the relative residual is " +
                std::to_string(error.residual) + ", of which " + std::to_string(error.misfit) +
                " are no error of the mesh; the map is the least-squares one"};
}

FlowMap beltrami_flow(const Surface& source, const Eigen::VectorXcd& mu, const SlidingStart& start,
                      const FlowOptions& options) {
    options.validate();
    require_genus_zero(source);
    require_coefficient(source, mu);
    require_start_of(source, start);
    FlowMap result;
    result.map = start.map;
    SlidingBoundary boundary(source, start.loops);
    boundary.place(result.map);
    SlidingMapStep step(source, boundary, result.map, kExpectedFactorizations);
    result.termination = Termination::iteration_limit;
    while (result.iterations < options.max_iterations) {
        const Eigen::VectorXcd before = result.map;
        step.solve(asked_for(source, before, mu, options.step), 0.1 * options.tolerance);
        result.map = step.map();
        ++result.iterations;
        FlowIteration now{step.movement(), relative_change(source, before, result.map),
                          coefficient_error(source, result.map, mu), 0};
        now.flips = static_cast<int>(distortion(source.operators, result.map).flipped.size());
        result.history.push_back(now);
        if (options.progress && !options.progress(result.iterations, now, result.map))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));
        if (now.movement < options.tolerance && now.change < options.tolerance) {
            result.termination = Termination::converged;
            break;
        }
    }
    result.factorizations = step.factorization_count();
    record_map(source, start, boundary, result);
    result.error = result.history.back().error;
    require_not_collapsed(result.loops);
    result.fits = coefficient_fits(result.error);
    if (!result.fits) result.warnings.push_back(misfit_warning(result.error));
    warn_of_folds_and_limit(std::to_string(result.iterations) + " iterations before the map settled", result);
    return result;
}

FlowMap beltrami_flow(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& mu,
                      const FlowOptions& options, const Correspondence& wanted, const FlowStartOptions& start) {
    options.validate();
    require_coefficient(source, mu);
    return beltrami_flow(source, mu, flow_start(source, target, wanted, start), options);
}

}  // namespace beltrami
