#include <beltrami/teichmuller/dual_step.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include <beltrami/differentials/chart_grid.h>
#include <beltrami/linear/dense.h>
#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

/// |φ| is floored at this part of its maximum, where its direction means nothing.
constexpr double kFloor = 1e-12;
/// The slope at which Newton stops, as part of the norm.
constexpr double kGradientTolerance = 1e-12;
/// Edge of a cluster per distance to the next corner or pin, and to the middle of the next hole.
constexpr double kClusterSlope = 0.6, kHoleClusterSlope = 0.25;
/// No cluster is smaller, in a domain of diameter 2.
constexpr double kSmallestCluster = 1e-5;
/// (δ/s)² below which the second kind of Hessian row is left out.
constexpr double kNearZero = 1e-3;
/// Columns worked through at a time.
constexpr int kColumnsPerChunk = 8;

/// √(|φ|² + δ²), without the care that std::abs takes of overflow.
Eigen::VectorXd sizes_of(const Eigen::VectorXcd& phi, double delta) {
    return (phi.array().abs2() + delta * delta).sqrt();
}

/// Real view of the coefficients: (Re c, Im c), or Re c alone.
struct RealView {
    bool complex;
    Eigen::VectorXd pack(const Eigen::VectorXcd& c) const {
        if (!complex) return c.real();
        Eigen::VectorXd x(2 * c.size());
        x << c.real(), c.imag();
        return x;
    }
    Eigen::VectorXcd unpack(const Eigen::VectorXd& x) const {
        if (!complex) return x.cast<Complex>();
        const Eigen::Index m = x.size() / 2;
        Eigen::VectorXcd c(m);
        c.real() = x.head(m);
        c.imag() = x.tail(m);
        return c;
    }
    /// Gradient in the real view of x ↦ Re Σ p_j c_j.
    Eigen::VectorXd covector(const Eigen::VectorXcd& p) const {
        if (!complex) return p.real();
        Eigen::VectorXd x(2 * p.size());
        x << p.real(), -p.imag();
        return x;
    }
};

}  // namespace

Eigen::VectorXcd dual_gradient(const Eigen::MatrixXcd& basis, const Eigen::VectorXd& weights,
                               const Eigen::VectorXcd& phi, double delta) {
    Eigen::VectorXd sizes = sizes_of(phi, delta);
    sizes = sizes.cwiseMax(kFloor * sizes.maxCoeff());
    return basis.transpose() * weights.cwiseQuotient(sizes).cast<Complex>().cwiseProduct(phi.conjugate());
}

double dilatation_of_pairing(double S) {
    S = std::clamp(S, -1.0, 1.0);
    return S / (1 + std::sqrt(1 - S * S));
}

namespace {

/// N on the points of the problem.
class OwnNorm final : public DualNorm {
  public:
    explicit OwnNorm(const DualProblem& problem) : problem_(problem) {}
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override { return problem_.basis * c; }
    double norm(const Eigen::VectorXcd& phi, double delta) const override {
        return problem_.weights.dot(sizes_of(phi, delta));
    }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        return dual_gradient(problem_.basis, problem_.weights, phi, delta);
    }

  private:
    const DualProblem& problem_;
};

/// The Hessian Σ w/s (Im(eφ_i) Im(eφ_j) + (δ/s)² Re(eφ_i) Re(eφ_j)) with s = √(|φ|²+δ²), e = conj(φ)/|φ|, in the lower
/// triangle: a product of scaled rows. The second kind of row matters only near zeros of φ.
/// @param storage of the rows: large, and kept from one call to the next
Eigen::MatrixXd dual_hessian(const DualProblem& problem, const RealView& view, const Eigen::VectorXcd& phi,
                             double delta, Eigen::VectorXd& storage) {
    const Eigen::Index m = problem.basis.cols(), points = problem.basis.rows();
    Eigen::VectorXd sizes = sizes_of(phi, delta);
    sizes = sizes.cwiseMax(kFloor * sizes.maxCoeff());
    std::vector<Eigen::Index> near_zeros;
    for (Eigen::Index i = 0; i < points; ++i)
        if (delta * delta > kNearZero * sizes[i] * sizes[i]) near_zeros.push_back(i);
    Eigen::VectorXcd e(points);
    for (Eigen::Index i = 0; i < points; ++i) {
        const double size = std::sqrt(std::norm(phi[i]));
        e[i] = size > 0 ? std::conj(phi[i]) / size : 1.0;
    }
    e = e.cwiseProduct(problem.weights.cwiseQuotient(sizes).cwiseSqrt().cast<Complex>());
    const Eigen::Index height = points + static_cast<Eigen::Index>(near_zeros.size()), width = view.complex ? 2 * m : m;
    if (storage.size() < height * width) storage.resize(2 * points * width);
    Eigen::Map<Eigen::MatrixXd> rows(storage.data(), height, width);
    const auto fill = [&](int first, int last) {
        Eigen::VectorXcd column(points);
        for (Eigen::Index j = first; j < last; ++j) {
            column = e.cwiseProduct(problem.basis.col(j));
            rows.col(j).head(points) = column.imag();
            if (view.complex) rows.col(m + j).head(points) = column.real();  // of iφ_j
            for (std::size_t i = 0; i < near_zeros.size(); ++i) {
                const auto row = points + static_cast<Eigen::Index>(i);
                const double ratio = delta / sizes[near_zeros[i]];
                rows(row, j) = ratio * column[near_zeros[i]].real();
                if (view.complex) rows(row, m + j) = -ratio * column[near_zeros[i]].imag();
            }
        }
    };
    parallel_for(0, static_cast<int>(m), fill, kColumnsPerChunk);
    return gram_lower(rows);
}

}  // namespace

DualSolution solve_dual(const DualProblem& problem, const Eigen::VectorXcd& start, const DualOptions& options) {
    const Eigen::Index m = problem.basis.cols();
    const RealView view{problem.complex_coefficients};
    const OwnNorm own(problem);
    const DualNorm& fine = options.norm ? *options.norm : own;
    const Eigen::VectorXd p = view.covector(problem.pairing);
    DualSolution solution;
    solution.coefficients = Eigen::VectorXcd::Zero(m);
    if (!(p.squaredNorm() > 0)) {
        solution.phi = fine.values(solution.coefficients);
        return solution;
    }

    Eigen::VectorXcd c = Eigen::VectorXcd::Zero(m);
    if (start.size() > 0 && start.size() <= m) c.head(start.size()) = start;
    double along = p.dot(view.pack(c));
    if (!(along > 0)) {
        c = view.unpack(p);
        along = p.squaredNorm();
    }
    Eigen::VectorXd x = view.pack(c) / along;
    Eigen::VectorXcd coarse_phi = problem.basis * view.unpack(x), phi = fine.values(view.unpack(x));
    const double total = problem.weights.sum();
    const double delta = total > 0 ? problem.rounding * problem.weights.dot(coarse_phi.cwiseAbs()) / total : 0.0;
    double norm = fine.norm(phi, delta);
    Eigen::VectorXd storage;  // of dual_hessian
    // The hyperplane of a single real function is a point.
    solution.converged = x.size() == 1;
    for (; x.size() > 1 && solution.newton_steps < options.max_steps; ++solution.newton_steps) {
        const Eigen::VectorXd gradient = view.covector(fine.gradient(phi, delta));
        Eigen::MatrixXd hessian = dual_hessian(problem, view, coarse_phi, delta, storage);
        // c itself is a null direction (N is homogeneous of degree one). On the hyperplane a multiple of p pᵀ changes
        // nothing and makes the matrix definite; the tiny shift is for functions that no quadrature point sees.
        const double mean_diagonal = hessian.trace() / static_cast<double>(x.size());
        hessian.selfadjointView<Eigen::Lower>().rankUpdate(p, mean_diagonal / p.squaredNorm());
        hessian.diagonal().array() += 1e-14 * mean_diagonal;
        const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> cholesky(hessian);
        if (cholesky.info() != Eigen::Success) break;
        const Eigen::VectorXd by_gradient = cholesky.solve(gradient), by_constraint = cholesky.solve(p);
        const double multiplier = p.dot(by_gradient) / p.dot(by_constraint);
        const Eigen::VectorXd step = multiplier * by_constraint - by_gradient;
        const double slope = gradient.dot(step);
        if (!(slope < -kGradientTolerance * kGradientTolerance * norm)) {
            solution.converged = slope > -kGradientTolerance * norm;
            break;
        }

        const Eigen::VectorXcd phi_step = fine.values(view.unpack(step));
        double length = 1;
        bool accepted = false;
        for (int halving = 0; halving < 40 && !accepted; ++halving) {
            const Eigen::VectorXcd trial = phi + length * phi_step;
            const double trial_norm = fine.norm(trial, delta);
            accepted = trial_norm <= norm + 1e-4 * length * slope;
            if (accepted) {
                phi = trial;
                norm = trial_norm;
            } else {
                length *= 0.5;
            }
        }
        if (accepted) {
            x += length * step;
            coarse_phi = problem.basis * view.unpack(x);
        }
        // At the level of rounding no step need descend.
        const bool flat = -slope < kGradientTolerance * norm;
        if (flat || (accepted && length * step.norm() < options.step * x.norm())) {
            solution.converged = true;
            solution.newton_steps += accepted;
            break;
        }
        if (!accepted) break;
    }
    solution.coefficients = view.unpack(x);
    solution.pairing = p.dot(x);
    solution.norm = norm;
    solution.phi = std::move(phi);
    return solution;
}

SampleClusters cluster_samples(const Operators& operators, const Chart& chart, const Singularities& singularities,
                               double phase, int target_count) {
    const int samples = operators.sample_count();
    SampleClusters result;
    result.squared.assign(samples, 0.0);
    double total = 0;
    int included = 0;
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        result.squared[s] = operators.weights[s] * std::norm(chart.derivatives[s]);
        total += result.squared[s];
        ++included;
    }
    int clusters = 0;
    if (included <= target_count || chart.positions.size() == 0) {
        result.cluster.assign(samples, -1);
        for (int s = 0; s < samples; ++s)
            if (!chart.excluded[s]) result.cluster[s] = clusters++;
    } else {
        ChartGrid grid = chart_grid(chart, phase,
                                    CellSize(std::sqrt(total / target_count), singularities, kClusterSlope,
                                             kHoleClusterSlope, kSmallestCluster));
        clusters = grid.cell_count();
        result.cluster = std::move(grid.cell);
    }
    result.points.positions = Eigen::VectorXcd::Zero(clusters);
    result.points.derivatives = Eigen::VectorXcd::Ones(clusters);
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(clusters);
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        if (chart.positions.size())
            result.points.positions[result.cluster[s]] += result.squared[s] * chart.positions[s];
        mass[result.cluster[s]] += result.squared[s];
    }
    for (int q = 0; q < clusters; ++q) result.points.positions[q] /= mass[q];
    return result;
}

Eigen::MatrixXcd means_over_clusters(const Eigen::MatrixXcd& values, const SampleClusters& clusters,
                                     const Chart& chart) {
    const Eigen::Index count = clusters.points.positions.size();
    Eigen::MatrixXcd means = Eigen::MatrixXcd::Zero(count, values.cols());
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(count);
    for (Eigen::Index s = 0; s < values.rows(); ++s) {
        const int q = clusters.cluster[s];
        if (q < 0) continue;
        mass[q] += clusters.squared[s];
        means.row(q) += clusters.squared[s] / (chart.derivatives[s] * chart.derivatives[s]) * values.row(s);
    }
    for (Eigen::Index q = 0; q < count; ++q) means.row(q) /= mass[q];
    return means;
}

}  // namespace beltrami
