#include <cmath>
#include <memory>
#include <utility>

#include <beltrami/baselines/start.h>
#include <beltrami/linear/element_assembly.h>
#include <beltrami/mesh/error.h>

namespace beltrami {

namespace {

/// The real Dirichlet Laplacian of a surface with its fixed vertices eliminated, factorised: L_ij = Σ A Re(conj(g_i)
/// g_j).
class Laplacian {
  public:
    Laplacian(const Operators& operators, const std::vector<Freedom>& freedoms)
        : operators_(operators), unknown_(freedoms.size(), -1) {
        for (std::size_t v = 0; v < freedoms.size(); ++v)
            if (freedoms[v] != Freedom::fixed) unknown_[v] = count_++;
        std::vector<int> unknowns;
        unknowns.reserve(operators.vertices.size());
        for (const int v : operators.vertices) unknowns.push_back(unknown_[v]);
        const ElementAssembly assembly(operators.offsets, std::move(unknowns), count_);
        solver_ = std::make_unique<SymmetricSolver>(assembly.pattern(), 1);
        double* values = solver_->matrix().valuePtr();
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto g = operators.gradient(s);
            const int* slot = assembly.slots(s).data();
            for (std::size_t i = 0; i < g.size(); ++i)
                for (std::size_t j = 0; j <= i; ++j, ++slot)
                    if (*slot >= 0) values[*slot] += operators.weights[s] * std::real(std::conj(g[i]) * g[j]);
        }
        solver_->factorize();
    }

    /// The map nearest to having ∂f = @p target and ∂̄f = 0 at every sample; fixed vertices keep their value of @p f.
    void solve(const Eigen::VectorXcd& target, Eigen::VectorXcd& f) const {
        Eigen::VectorXcd base = f;
        for (Eigen::Index v = 0; v < f.size(); ++v)
            if (unknown_[v] >= 0) base[v] = 0;
        Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(count_, 2);
        for (int s = 0; s < operators_.sample_count(); ++s) {
            const auto [d_z, d_zbar] = operators_.derivatives(s, base);
            const auto stencil = operators_.stencil(s);
            const auto g = operators_.gradient(s);
            for (std::size_t j = 0; j < g.size(); ++j) {
                const int u = unknown_[stencil[j]];
                if (u < 0) continue;
                const Complex force = operators_.weights[s] * ((target[s] - d_z) * g[j] - d_zbar * std::conj(g[j]));
                rhs(u, 0) += force.real();
                rhs(u, 1) += force.imag();
            }
        }
        const Eigen::MatrixXd solution = solver_->solve(rhs);
        for (Eigen::Index v = 0; v < f.size(); ++v)
            if (unknown_[v] >= 0) f[v] = {solution(unknown_[v], 0), solution(unknown_[v], 1)};
    }

  private:
    const Operators& operators_;
    std::vector<int> unknown_;  // #V, −1 where fixed
    int count_ = 0;
    std::unique_ptr<SymmetricSolver> solver_;
};

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

    std::vector<Freedom> held = freedoms(boundary, source);
    if (boundary.empty()) held[source.topology.boundary_loops[0][0]] = Freedom::fixed;
    const Laplacian laplacian(operators, held);
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
        laplacian.solve(target, result.map);
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
    if (!result.converged)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before the energy settled");
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
