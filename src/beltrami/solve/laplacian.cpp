#include <beltrami/solve/laplacian.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/parallel.h>

namespace beltrami::detail {

namespace {

std::vector<int> unknowns_of(const Operators& operators, const std::vector<char>& held) {
    std::vector<int> unknown(static_cast<std::size_t>(operators.vertex_count), -1);
    for (const int v : operators.vertices)
        if (!held[v]) unknown[v] = 0;
    int count = 0;
    for (int& u : unknown)
        if (u == 0) u = count++;
    return unknown;
}

ElementSystem system_of(const Operators& operators, const std::vector<int>& unknown, int expected_factorizations) {
    std::vector<int> nodes;
    nodes.reserve(operators.vertices.size());
    for (const int v : operators.vertices) nodes.push_back(unknown[v]);
    const auto held = std::count(unknown.begin(), unknown.end(), -1);
    return {operators.offsets, std::move(nodes), operators.vertex_count - static_cast<int>(held),
            expected_factorizations};
}

}  // namespace

std::vector<char> fixed_vertices(const std::vector<Freedom>& freedoms) {
    std::vector<char> fixed(freedoms.size());
    std::transform(freedoms.begin(), freedoms.end(), fixed.begin(), [](Freedom f) { return f == Freedom::fixed; });
    return fixed;
}

Laplacian::Laplacian(const Operators& operators, const std::vector<char>& held, int expected_factorizations,
                     std::vector<signed char> signs)
    : operators_(operators),
      signs_(std::move(signs)),
      unknown_(unknowns_of(operators, held)),
      system_(system_of(operators, unknown_, expected_factorizations)) {
    factorize(operators.weights);
}

void Laplacian::factorize(std::span<const double> weights) {
    system_.clear();
    std::vector<double> lower;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const int first = operators_.offsets[s], last = operators_.offsets[s + 1];
        lower.clear();
        for (int i = first; i < last; ++i)
            for (int j = first; j <= i; ++j) lower.push_back(entry(i, j, weights[s]));
        system_.add(s, lower);
    }
    system_.factorize();
}

void Laplacian::put_back(const Eigen::MatrixXd& solution, Eigen::MatrixXd& of_vertices) const {
    for (Eigen::Index v = 0; v < of_vertices.rows(); ++v)
        if (unknown_[v] >= 0) of_vertices.row(v) = solution.row(unknown_[v]);
}

Eigen::MatrixXd Laplacian::solve(const Eigen::MatrixXd& force) const {
    Eigen::MatrixXd rhs(system_.unknown_count(), force.cols()), u = Eigen::MatrixXd::Zero(force.rows(), force.cols());
    for (Eigen::Index v = 0; v < force.rows(); ++v)
        if (unknown_[v] >= 0) rhs.row(unknown_[v]) = force.row(v);
    put_back(system_.solve(rhs), u);
    return u;
}

Eigen::MatrixXd Laplacian::extend(const Eigen::MatrixXd& values) const {
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(system_.unknown_count(), values.cols()), u = values;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const int first = operators_.offsets[s], last = operators_.offsets[s + 1];
        for (int i = first; i < last; ++i) {
            const int to = unknown_[operators_.vertices[i]];
            for (int j = first; j < last && to >= 0; ++j)
                if (const int v = operators_.vertices[j]; unknown_[v] < 0)
                    rhs.row(to) -= entry(i, j, operators_.weights[s]) * values.row(v);
        }
    }
    put_back(system_.solve(rhs), u);
    return u;
}

Complex Laplacian::gradient(int sample, const Eigen::VectorXd& u) const {
    const int first = operators_.offsets[sample], last = operators_.offsets[sample + 1];
    Complex sum = 0;
    const double base = sign(first) * u[operators_.vertices[first]];
    for (int j = first + 1; j < last; ++j)
        sum += (sign(j) * u[operators_.vertices[j]] - base) * operators_.gradients[j];
    return sum;
}

Eigen::VectorXd Laplacian::apply(const Eigen::VectorXd& u) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const Complex along = operators_.weights[s] * gradient(s, u);
        for (int j = operators_.offsets[s]; j < operators_.offsets[s + 1]; ++j)
            result[operators_.vertices[j]] += sign(j) * std::real(std::conj(operators_.gradients[j]) * along);
    }
    return result;
}

double Laplacian::energy(const Eigen::VectorXd& u) const {
    return parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double sum = 0;
        for (int s = first; s < last; ++s) sum += operators_.weights[s] * std::norm(gradient(s, u));
        return sum;
    });
}

}  // namespace beltrami::detail
