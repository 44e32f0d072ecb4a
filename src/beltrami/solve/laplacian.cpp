#include <beltrami/solve/laplacian.h>

#include <utility>

namespace beltrami::detail {

Laplacian::Laplacian(const Operators& operators, const std::vector<Freedom>& freedoms, int expected_factorizations)
    : operators_(operators), unknown_(freedoms.size(), -1) {
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (freedoms[v] != Freedom::fixed) unknown_[v] = count_++;
    if (count_ == 0) return;
    std::vector<int> unknowns;
    unknowns.reserve(operators.vertices.size());
    for (const int v : operators.vertices) unknowns.push_back(unknown_[v]);
    assembly_ = std::make_unique<ElementAssembly>(operators.offsets, std::move(unknowns), count_);
    solver_ = std::make_unique<SymmetricSolver>(assembly_->pattern(), expected_factorizations);
    factorize(operators.weights);
}

void Laplacian::factorize(std::span<const double> weights) {
    if (count_ == 0) return;
    solver_->matrix().coeffs().setZero();
    double* values = solver_->matrix().valuePtr();
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const auto g = operators_.gradient(s);
        const int* slot = assembly_->slots(s).data();
        for (std::size_t i = 0; i < g.size(); ++i)
            for (std::size_t j = 0; j <= i; ++j, ++slot)
                if (*slot >= 0) values[*slot] += weights[s] * std::real(std::conj(g[i]) * g[j]);
    }
    solver_->factorize();
}

Eigen::MatrixXd Laplacian::solve(const Eigen::MatrixXd& force) const {
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(force.rows(), force.cols());
    if (count_ == 0) return u;
    Eigen::MatrixXd rhs(count_, force.cols());
    for (Eigen::Index v = 0; v < force.rows(); ++v)
        if (unknown_[v] >= 0) rhs.row(unknown_[v]) = force.row(v);
    const Eigen::MatrixXd solution = solver_->solve(rhs);
    for (Eigen::Index v = 0; v < force.rows(); ++v)
        if (unknown_[v] >= 0) u.row(v) = solution.row(unknown_[v]);
    return u;
}

}  // namespace beltrami::detail
