#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/baselines/start.h>
#include <beltrami/forms/harmonic_forms.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

namespace {

using Form = detail::HarmonicForms::Form;

/// Of the differential's lagged weights 1/|φ|: the least |φ|, relative to its maximum.
constexpr double kLeastPhi = 1e-4;
/// And of those weights, which vanish where ∂f does.
constexpr double kLeastWeight = 1e-12;
/// Steps of the differential between two of the map.
constexpr int kMostInnerSteps = 10;

/// The least-squares Beltrami energy Σ A |∂̄f − k conj(φ)/|φ| ∂f|² of a fixed map, as a function of φ with its best k.
struct Energy {
    Eigen::VectorXcd product;  // #S A conj(∂f) ∂̄f
    Eigen::VectorXd d_z;       // #S A |∂f|²
    double sum_d_z = 0, sum_d_zbar = 0;

    Energy(const Operators& operators, const Eigen::VectorXcd& f)
        : product(operators.sample_count()), d_z(operators.sample_count()) {
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto [dz, dzbar] = operators.derivatives(s, f);
            product[s] = operators.weights[s] * std::conj(dz) * dzbar;
            d_z[s] = operators.weights[s] * std::norm(dz);
            sum_d_zbar += operators.weights[s] * std::norm(dzbar);
        }
        sum_d_z = d_z.sum();
    }

    /// Σ A Re(conj(e ∂f) ∂̄f) / Σ A |∂f|², e = conj(φ)/|φ|: eq. (12), whose print is garbled.
    double best_k(const Eigen::VectorXcd& phi) const {
        double sum = 0;
        for (Eigen::Index s = 0; s < phi.size(); ++s) {
            const double size = std::abs(phi[s]);
            if (size > 0) sum += std::real(phi[s] * product[s]) / size;
        }
        return sum / sum_d_z;
    }

    /// With the best k, per area of the image, which the boundary fixes.
    double at(double k) const { return (sum_d_zbar - k * k * sum_d_z) / (sum_d_z - sum_d_zbar); }
};

/// The largest value of a function on [0, 1] by golden sections, which is 0 unless something larger than value(0) is
/// found.
template <class Function>
double line_search(const Function& value) {
    constexpr double ratio = 0.61803398874989485;
    double low = 0, high = 1, best = 0, best_value = value(0);
    const auto tried = [&](double t) {
        const double v = value(t);
        if (v > best_value) best = t, best_value = v;
        return v;
    };
    tried(1);
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    double value_a = tried(a), value_b = tried(b);
    for (int step = 0; step < 12; ++step)
        if (value_a > value_b) {
            high = std::exchange(b, a);
            value_b = value_a;
            a = high - ratio * (high - low);
            value_a = tried(a);
        } else {
            low = std::exchange(a, b);
            value_a = value_b;
            b = low + ratio * (high - low);
            value_b = tried(b);
        }
    return best;
}

}  // namespace

BaselineMap alternation_baseline(const Surface& source, const BoundaryCondition& boundary,
                                 const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    require_whole_boundary(boundary, source);
    const Operators& operators = source.operators;
    BaselineMap result;
    BeltramiSolver solver(source, freedoms(boundary, source), 10);
    const Eigen::VectorXcd prescribed = prescribed_values(boundary, source);
    Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(operators.sample_count());
    solver.factorize(nu);
    result.map = solver.solve(prescribed);
    result.factorizations = 1;
    if (detail::must_fold(source, boundary, result)) return result;

    detail::HarmonicForms forms(source, result.warnings);
    Form form = forms.zero();
    Eigen::VectorXcd phi;
    double k = 0;
    // Minimises the energy over φ for the weights 1/size and a k. The print's h-step, eq. (11).
    const auto quadratic_step = [&](const Energy& energy, const Eigen::VectorXd& size, double for_k) {
        Eigen::VectorXd weights = for_k * for_k * energy.d_z.cwiseQuotient(size.cwiseAbs2());
        weights = weights.cwiseMax(kLeastWeight * weights.maxCoeff());
        const Eigen::VectorXcd pull = for_k * energy.product.conjugate().cwiseQuotient(size.cast<Complex>());
        return forms.fit(weights, pull, form);
    };
    const auto optimise_phi = [&](const Energy& energy) {
        k = energy.best_k(phi);
        for (int step = 0; step < kMostInnerSteps && k > 0; ++step) {
            const Eigen::VectorXd size = phi.cwiseAbs().cwiseMax(kLeastPhi * phi.cwiseAbs().maxCoeff());
            const Form wanted = quadratic_step(energy, size, k);
            const Eigen::VectorXcd wanted_phi = forms.values(wanted);
            const double t =
                line_search([&](double part) { return energy.best_k((1 - part) * phi + part * wanted_phi); });
            if (t == 0) break;
            form.potential += t * (wanted.potential - form.potential);
            form.periods += t * (wanted.periods - form.periods);
            phi = (1 - t) * phi + t * wanted_phi;
            const double before = std::exchange(k, energy.best_k(phi));
            if (energy.at(before) - energy.at(k) <= options.tolerance * options.tolerance) break;
        }
    };

    double energy_before = 0;
    {
        const Energy energy(operators, result.map);
        form = quadratic_step(energy, Eigen::VectorXd::Ones(operators.sample_count()), 1);
        phi = forms.values(form);
        optimise_phi(energy);
        energy_before = energy.at(k);
    }
    // Without anything to pair with, the harmonic map is the answer: it is conformal, or as good as that.
    result.converged = !(k > options.tolerance);
    while (!result.converged && result.iterations < options.max_iterations) {
        for (Eigen::Index s = 0; s < phi.size(); ++s) {
            const double size = std::abs(phi[s]);
            nu[s] = size > 0 ? k * std::conj(phi[s]) / size : 0.0;
        }
        result.map = solver.solve_near(nu, prescribed, result.map);
        ++result.iterations;
        const Energy energy(operators, result.map);
        optimise_phi(energy);
        const double now = energy.at(k);
        if (options.progress && !options.progress(result.iterations, now))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(result.iterations));
        result.converged = std::abs(energy_before - now) <= options.tolerance * options.tolerance;
        energy_before = now;
    }
    result.factorizations = solver.factorization_count() + forms.factorization_count();
    detail::warn_of_limit("iterations before the energy settled", result);
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
