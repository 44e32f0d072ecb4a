#include <algorithm>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/baselines/start.h>
#include <beltrami/operators/sample_neighbours.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

namespace {

/// |μ| counts as at most this in the mean, so that flipped faces do not spoil it.
constexpr double kMostMu = 0.95;

}  // namespace

BaselineMap qc_iteration_baseline(const Surface& source, const BoundaryCondition& boundary,
                                  const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    require_whole_boundary(boundary, source);
    const Operators& operators = source.operators;
    const int samples = operators.sample_count();
    BaselineMap result;
    BeltramiSolver solver(source, freedoms(boundary, source), 10);
    const Eigen::VectorXcd prescribed = prescribed_values(boundary, source);
    Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(samples);
    solver.factorize(nu);
    result.map = solver.solve(prescribed);
    result.factorizations = 1;
    if (detail::must_fold(source, boundary, result)) return result;

    const SampleNeighbours neighbours(source);
    const double area = operators.area(), image_area = detail::enclosed_area(source, boundary);
    Eigen::VectorXcd phase(samples), smoothed(samples);
    // The next coefficient from the map; returns by how much it differs from the last, root mean square.
    const auto next_coefficient = [&] {
        double mean = 0;
        for (int s = 0; s < samples; ++s) {
            const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
            phase[s] = d_zbar * std::conj(d_z);
            const double size = std::abs(d_z), other = std::abs(d_zbar);
            mean += other < kMostMu * size ? other / size : other > 0 ? kMostMu : 0.0;
            phase[s] = size > 0 && other > 0 ? phase[s] / (size * other) : Complex(1);
        }
        mean /= samples;
        for (int pass = 0; pass < options.smoothing_passes; ++pass) {
            neighbours.smooth(phase, options.smoothing, smoothed);
            phase.swap(smoothed);
        }
        double change = 0;
        for (int s = 0; s < samples; ++s) {
            const Complex next = mean * phase[s];
            change += operators.weights[s] * std::norm(next - nu[s]);
            nu[s] = next;
        }
        return std::sqrt(change / area);
    };
    const auto energy = [&] {
        double sum = 0;
        for (int s = 0; s < samples; ++s) {
            const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
            sum += operators.weights[s] * std::norm(d_zbar - nu[s] * d_z);
        }
        return sum / image_area;
    };

    result.converged = next_coefficient() <= options.tolerance;
    while (!result.converged && result.iterations < options.max_iterations) {
        result.map = solver.solve_near(nu, prescribed, result.map);
        ++result.iterations;
        if (options.progress && !options.progress(result.iterations, energy()))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));
        result.converged = next_coefficient() <= options.tolerance;
    }
    result.factorizations = solver.factorization_count();
    detail::warn_of_limit("iterations before the coefficient settled", result);
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
