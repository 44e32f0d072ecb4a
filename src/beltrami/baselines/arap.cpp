#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/baselines/start.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

/// The map nearest to having ∂f = @p target and ∂̄f = 0 at every sample; fixed vertices keep their value of @p f.
/// @param laplacian with the vertices @p held eliminated
void fit(const Operators& operators, const detail::Laplacian& laplacian, const std::vector<char>& held,
         const Eigen::VectorXcd& target, Eigen::VectorXcd& f) {
    Eigen::VectorXcd base = f;
    for (Eigen::Index v = 0; v < f.size(); ++v)
        if (!held[v]) base[v] = 0;
    Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(f.size(), 2);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto [d_z, d_zbar] = operators.derivatives(s, base);
        const auto stencil = operators.stencil(s);
        const auto g = operators.gradient(s);
        for (std::size_t j = 0; j < g.size(); ++j) {
            const Complex force = operators.weights[s] * ((target[s] - d_z) * g[j] - d_zbar * std::conj(g[j]));
            forces(stencil[j], 0) += force.real();
            forces(stencil[j], 1) += force.imag();
        }
    }
    const Eigen::MatrixXd solution = laplacian.solve(forces);
    for (Eigen::Index v = 0; v < f.size(); ++v)
        if (!held[v]) f[v] = {solution(v, 0), solution(v, 1)};
}

}  // namespace

BaselineMap arap_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    const Operators& operators = source.operators;
    BaselineMap result;
    result.map = detail::linear_map(source, boundary, result.factorizations);
    if (detail::must_fold(source, boundary, result)) return result;

    const double area = operators.area();
    double scale = 1;
    if (unprescribed_boundary(boundary, source).empty())
        scale = std::sqrt(detail::enclosed_area(source, boundary) / area);

    std::vector<char> held = detail::fixed_vertices(freedoms(boundary, source));
    if (boundary.empty()) held[source.topology.boundary_loops[0][0]] = 1;
    const detail::Laplacian laplacian(operators, held);
    ++result.factorizations;

    // The rotation nearest to a Jacobian (∂f, ∂̄f) is ∂f/|∂f|: ‖Df − R‖² = 2|∂f − R|² + 2|∂̄f|².
    Eigen::VectorXcd target(operators.sample_count());
    const auto energy_and_target = [&] {
        double energy = 0;
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
            const double length = std::abs(d_z);
            target[s] = length > 0 ? scale * d_z / length : Complex(scale);
            energy += operators.weights[s] * 2 * (std::norm(d_z - target[s]) + std::norm(d_zbar));
        }
        return energy / (area * scale * scale);
    };
    double energy = energy_and_target();
    while (result.iterations < options.max_iterations) {
        fit(operators, laplacian, held, target, result.map);
        const double before = std::exchange(energy, energy_and_target());
        ++result.iterations;
        if (options.progress && !options.progress(result.iterations, energy))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));
        // The first step leaves the start, whose scale may be any.
        if (result.iterations > 1 && before - energy <= options.tolerance * options.tolerance) {
            result.converged = true;
            break;
        }
    }
    detail::warn_of_limit("iterations before the energy settled", result);
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
