#include <beltrami/certificate/dirichlet_form.h>

#include <utility>

#include <beltrami/base/parallel.h>

namespace beltrami::detail {

DirichletForm::DirichletForm(const Operators& operators, std::vector<signed char> signs, const std::vector<char>& held)
    : operators_(operators), signs_(std::move(signs)), unknown_(static_cast<std::size_t>(operators.vertex_count), -1) {
    for (const int v : operators.vertices)
        if (!held[v]) unknown_[v] = 0;
    for (int& unknown : unknown_)
        if (unknown == 0) unknown = count_++;
    if (count_ == 0) return;
    std::vector<int> unknowns;
    unknowns.reserve(operators.vertices.size());
    for (const int v : operators.vertices) unknowns.push_back(unknown_[v]);
    const ElementAssembly assembly(operators.offsets, std::move(unknowns), count_);
    SymmetricSolver::Matrix lower = assembly.pattern();
    lower.coeffs().setZero();
    double* values = lower.valuePtr();
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto g = operators.gradient(s);
        const int first = operators.offsets[s];
        const int* slot = assembly.slots(s).data();
        for (int i = 0; i < static_cast<int>(g.size()); ++i)
            for (int j = 0; j <= i; ++j, ++slot)
                if (*slot >= 0)
                    values[*slot] +=
                        operators.weights[s] * sign(first + i) * sign(first + j) * std::real(std::conj(g[i]) * g[j]);
    }
    solver_ = std::make_unique<SymmetricSolver>(std::move(lower), 1);
    solver_->factorize();
}

Eigen::VectorXd DirichletForm::solve(const Eigen::VectorXd& force) const {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(force.size());
    if (count_ == 0) return u;
    Eigen::VectorXd rhs(count_);
    for (Eigen::Index v = 0; v < force.size(); ++v)
        if (unknown_[v] >= 0) rhs[unknown_[v]] = force[v];
    const Eigen::VectorXd solution = solver_->solve(rhs);
    for (Eigen::Index v = 0; v < force.size(); ++v)
        if (unknown_[v] >= 0) u[v] = solution[unknown_[v]];
    return u;
}

Complex DirichletForm::gradient(int sample, const Eigen::VectorXd& u) const {
    const int first = operators_.offsets[sample], last = operators_.offsets[sample + 1];
    Complex sum = 0;
    const double base = sign(first) * u[operators_.vertices[first]];
    for (int j = first + 1; j < last; ++j)
        sum += (sign(j) * u[operators_.vertices[j]] - base) * operators_.gradients[j];
    return sum;
}

Eigen::VectorXd DirichletForm::apply(const Eigen::VectorXd& u) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const Complex along = operators_.weights[s] * gradient(s, u);
        for (int j = operators_.offsets[s]; j < operators_.offsets[s + 1]; ++j)
            result[operators_.vertices[j]] += sign(j) * std::real(std::conj(operators_.gradients[j]) * along);
    }
    return result;
}

double DirichletForm::energy(const Eigen::VectorXd& u) const {
    return parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double sum = 0;
        for (int s = first; s < last; ++s) sum += operators_.weights[s] * std::norm(gradient(s, u));
        return sum;
    });
}

}  // namespace beltrami::detail
