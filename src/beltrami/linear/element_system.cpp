#include <beltrami/linear/element_system.h>

#include <stdexcept>
#include <utility>

#include <beltrami/base/stop.h>
#include <beltrami/linear/symmetric_solver.h>

namespace beltrami {

using detail::ElementAssembly;
using detail::SymmetricSolver;

namespace {

/// The pattern with `block` unknowns in place of every node and zero values.
SymmetricSolver::Matrix pattern(const ElementAssembly& nodes, int block) {
    const int count = nodes.unknown_count();
    const std::vector<int>&begins = nodes.columns(), &rows = nodes.rows();
    SymmetricSolver::Matrix result(block * count, block * count);
    result.makeCompressed();
    result.resizeNonZeros(static_cast<Eigen::Index>(block) * block * begins.back() - count * (block * (block - 1) / 2));
    int *begin = result.outerIndexPtr(), *row = result.innerIndexPtr(), at = 0;
    for (int c = 0; c < count; ++c)
        for (int part = 0; part < block; ++part) {
            *begin++ = at;
            for (int k = begins[c]; k < begins[c + 1]; ++k)
                for (int i = rows[k] == c ? part : 0; i < block; ++i, ++at) *row++ = block * rows[k] + i;
        }
    *begin = at;
    result.coeffs().setZero();
    return result;
}

}  // namespace

ElementSystem::ElementSystem(std::vector<int> offsets, std::vector<int> nodes, int node_count,
                             int expected_factorizations, int block)
    : assembly_(std::move(offsets), std::move(nodes), node_count),
      block_(block),
      solver_(std::make_unique<SymmetricSolver>(pattern(assembly_, block), expected_factorizations, block)),
      entries_(solver_->matrix().valuePtr()) {
    if (block != 1 && block != 2) throw std::logic_error("ElementSystem: one or two unknowns a node");
}

ElementSystem::~ElementSystem() = default;
ElementSystem::ElementSystem(ElementSystem&&) noexcept = default;
ElementSystem& ElementSystem::operator=(ElementSystem&&) noexcept = default;

ElementSystem::Values::Values(const ElementSystem& system)
    : entries_(Eigen::VectorXd::Zero(system.solver_->matrix().nonZeros())) {}

void ElementSystem::clear() {
    factorized_ = false;
    solver_->matrix().coeffs().setZero();
}

void ElementSystem::add_to_diagonal(int unknown, double value) {
    factorized_ = false;
    entries_[diagonal_at(unknown)] += value;
}

void ElementSystem::scale_diagonal(double factor) {
    factorized_ = false;
    for (int u = 0; u < unknown_count(); ++u) entries_[diagonal_at(u)] *= factor;
}

void ElementSystem::set(const Values& a) {
    factorized_ = false;
    solver_->matrix().coeffs() = a.entries_.array();
}

void ElementSystem::set(const Values& a, double factor, const Values& b) {
    factorized_ = false;
    solver_->matrix().coeffs() = (a.entries_ + factor * b.entries_).array();
}

void ElementSystem::factorize() {
    stop_if_wanted();
    solver_->factorize();
    factorized_ = true;
}

Eigen::MatrixXd ElementSystem::solve(const Eigen::MatrixXd& rhs) const {
    if (!factorized_) throw std::logic_error("ElementSystem::solve before factorize");
    stop_if_wanted();
    return solver_->solve(rhs);
}

bool ElementSystem::solve_near(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution, double tolerance,
                               int max_steps) const {
    stop_if_wanted();
    return solver_->solve_near(rhs, solution, tolerance, max_steps);
}

double ElementSystem::last_residual() const {
    return solver_->last_residual();
}

int ElementSystem::factorization_count() const {
    return solver_->factorization_count();
}

}  // namespace beltrami
