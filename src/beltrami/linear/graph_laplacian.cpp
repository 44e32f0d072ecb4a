#include <beltrami/linear/graph_laplacian.h>

#include <cmath>
#include <utility>

namespace beltrami {

namespace {

std::vector<int> numbered(const std::vector<char>& held) {
    std::vector<int> unknown(held.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < held.size(); ++v)
        if (!held[v]) unknown[v] = count++;
    return unknown;
}

ElementSystem system_of(const std::vector<std::array<int, 2>>& edges, const std::vector<int>& unknown,
                        int expected_factorizations) {
    std::vector<int> offsets, nodes;
    offsets.reserve(edges.size() + 1);
    nodes.reserve(2 * edges.size());
    offsets.push_back(0);
    for (const auto& [a, b] : edges) {
        if (a != b) nodes.insert(nodes.end(), {unknown[a], unknown[b]});
        offsets.push_back(static_cast<int>(nodes.size()));
    }
    int count = 0;
    for (const int u : unknown) count += u >= 0;
    return {std::move(offsets), std::move(nodes), count, expected_factorizations};
}

}  // namespace

GraphLaplacian::GraphLaplacian(std::vector<std::array<int, 2>> edges, const std::vector<char>& held,
                               int expected_factorizations)
    : edges_(std::move(edges)),
      unknown_(numbered(held)),
      system_(system_of(edges_, unknown_, expected_factorizations)) {}

void GraphLaplacian::set(std::span<const double> weights) {
    weights_.assign(weights.begin(), weights.end());
    system_.clear();
    for (int e = 0; e < system_.element_count(); ++e) {
        const double w = weights[e];
        system_.add(e, std::array{w, -w, w});
    }
}

double GraphLaplacian::mean_diagonal() const {
    double sum = 0;
    for (int u = 0; u < unknown_count(); ++u) sum += std::abs(system_.diagonal(u));
    return sum / unknown_count();
}

void GraphLaplacian::shift_diagonal(double value) {
    for (int u = 0; u < unknown_count(); ++u) system_.add_to_diagonal(u, value);
}

void GraphLaplacian::add_to_diagonal(const Eigen::VectorXd& values) {
    for (Eigen::Index v = 0; v < values.size(); ++v)
        if (unknown_[v] >= 0) system_.add_to_diagonal(unknown_[v], values[v]);
}

template <class Act>
void GraphLaplacian::each_link(Act&& act) const {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto [a, b] = edges_[e];
        if (unknown_[a] >= 0 && unknown_[b] < 0) act(a, b, weights_[e]);
        if (unknown_[b] >= 0 && unknown_[a] < 0) act(b, a, weights_[e]);
    }
}

Eigen::MatrixXd GraphLaplacian::solve(const Eigen::MatrixXd& load) const {
    Eigen::MatrixXd inner(unknown_count(), load.cols()), u = Eigen::MatrixXd::Zero(load.rows(), load.cols());
    for (Eigen::Index v = 0; v < load.rows(); ++v)
        if (unknown_[v] >= 0) inner.row(unknown_[v]) = load.row(v);
    inner = system_.solve(inner);
    for (Eigen::Index v = 0; v < load.rows(); ++v)
        if (unknown_[v] >= 0) u.row(v) = inner.row(unknown_[v]);
    return u;
}

Eigen::VectorXcd GraphLaplacian::extend(Eigen::VectorXcd values) const {
    Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(unknown_count(), 2);
    each_link([&](int vertex, int held, double weight) {
        inner(unknown_[vertex], 0) += weight * values[held].real();
        inner(unknown_[vertex], 1) += weight * values[held].imag();
    });
    inner = system_.solve(inner);
    for (Eigen::Index v = 0; v < values.size(); ++v)
        if (const int u = unknown_[v]; u >= 0) values[v] = {inner(u, 0), inner(u, 1)};
    return values;
}

Eigen::VectorXd GraphLaplacian::flux(const Eigen::VectorXd& u) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
    each_link([&](int inner, int held, double weight) { result[held] += weight * u[inner]; });
    return result;
}

}  // namespace beltrami
