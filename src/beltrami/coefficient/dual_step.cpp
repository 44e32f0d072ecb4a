#include <beltrami/coefficient/dual_step.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <beltrami/base/parallel.h>
#include <beltrami/differentials/chart_grid.h>
#include <beltrami/linear/complex_columns.h>
#include <beltrami/linear/dense.h>

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
/// (δ/s)² and (r/s)² below which the second kind of Hessian row is left out.
constexpr double kNearZero = 1e-3, kNearReach = 0.05;
/// How far φ is expected to move at a point: as part of |φ| in the first step where nothing is known, then of the step
/// before.
constexpr double kFirstReach = 0.6, kReach = 0.7;
/// A step is halved at most so often, until the norm falls by this part of what the slope promises.
constexpr int kHalvings = 40;
constexpr double kDescent = 1e-4;
/// Newton steps on the coarse norm before the fine one is looked at again; they end at this part of the way made.
constexpr int kInnerSteps = 8;
constexpr double kInnerFraction = 0.15;
/// The Hessian before a step shorter than this part of the whole serves for the next step too.
constexpr double kSameHessian = 0.03;
/// The coarse norm is trusted no longer once less than this part of its step is taken.
constexpr double kTrusted = 0.3;
/// … and its Hessian, once it is that of the other norm, no longer where a round leaves more than this of the way.
constexpr double kSlow = 0.5;
/// The change that a second look is expected to make, as part of the first.
constexpr double kFirstRate = 0.2;
/// Gradients are exact where the norm is flat to rounding: so many rounds more, down to such a change.
constexpr int kFlatRounds = 3;
constexpr double kExact = 1e-11;
/// Columns of the Hessian's rows that a thread fills at once.
constexpr int kHessianColumns = 8;
/// Points of a finer norm whose rows are there at once.
constexpr Eigen::Index kHessianPoints = 8192;

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
    const Eigen::VectorXcd directions = weights.cwiseQuotient(sizes).cast<Complex>().cwiseProduct(phi.conjugate());
    return transposed_times_columns(basis, directions);
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
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override { return times_columns(problem_.basis, c); }
    double norm(const Eigen::VectorXcd& phi, double delta) const override {
        return problem_.weights.dot(sizes_of(phi, delta));
    }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        return dual_gradient(problem_.basis, problem_.weights, phi, delta);
    }

  private:
    const DualProblem& problem_;
};

/// The Hessian Σ w/s (Im(eφ_i) Im(eφ_j) + (ρ/s)² Re(eφ_i) Re(eφ_j)) with s = √(|φ|²+ρ²), e = conj(φ)/|φ|, in the lower
/// triangle: a product of scaled rows. The second kind of row matters only where φ is small.
///
/// ρ² = δ² + r² with r the length by which φ is expected to move at the point. The Hessian of |φ| itself (r = 0) knows
/// nothing about the far side of a zero, and steps overshoot wherever they are as long as φ is large; that of the
/// rounded norm does, and is as good where they are short.
/// @param storage of the rows: large, and kept from one call to the next
Eigen::MatrixXd hessian_of_rows(const Eigen::Ref<const Eigen::MatrixXcd>& basis, const RealView& view,
                                const Eigen::Ref<const Eigen::VectorXd>& weights,
                                const Eigen::Ref<const Eigen::VectorXcd>& phi,
                                const Eigen::Ref<const Eigen::VectorXd>& delta,
                                const Eigen::Ref<const Eigen::VectorXd>& reach, Eigen::VectorXd& storage) {
    const Eigen::Index m = basis.cols(), points = basis.rows();
    const Eigen::VectorXd rounding = reach.array().square() + delta.array().square();
    Eigen::VectorXd sizes = (phi.array().abs2() + rounding.array()).sqrt();
    sizes = sizes.cwiseMax(kFloor * sizes.maxCoeff());
    std::vector<int> second(static_cast<std::size_t>(points), -1);  // row of the second kind
    Eigen::VectorXcd e(points);
    int count = static_cast<int>(points);
    for (Eigen::Index i = 0; i < points; ++i) {
        const double size = std::sqrt(std::norm(phi[i])), square = sizes[i] * sizes[i];
        e[i] = (size > 0 ? std::conj(phi[i]) / size : 1.0) * std::sqrt(weights[i] / sizes[i]);
        if (delta[i] * delta[i] > kNearZero * square || reach[i] * reach[i] > kNearReach * square) second[i] = count++;
    }
    const Eigen::Index height = count, width = view.complex ? 2 * m : m;
    if (storage.size() < height * width) storage.resize(2 * points * width);
    Eigen::Map<Eigen::MatrixXd> rows(storage.data(), height, width);
    parallel_for(
        0, static_cast<int>(m),
        [&](int first, int last) {
            for (int j = first; j < last; ++j) {
                const Complex* const column = basis.col(j).data();
                double* const to = &rows(0, j);
                double* const to_imaginary = view.complex ? &rows(0, m + j) : nullptr;  // of iφ_j
                for (Eigen::Index i = 0; i < points; ++i) {
                    const double re = e[i].real() * column[i].real() - e[i].imag() * column[i].imag(),
                                 im = e[i].real() * column[i].imag() + e[i].imag() * column[i].real();
                    to[i] = im;
                    if (to_imaginary) to_imaginary[i] = re;
                    if (second[i] < 0) continue;
                    const double ratio = std::sqrt(rounding[i]) / sizes[i];
                    to[second[i]] = ratio * re;
                    if (to_imaginary) to_imaginary[second[i]] = -ratio * im;
                }
            }
        },
        kHessianColumns);
    return gram_lower(rows);
}

}  // namespace

Eigen::MatrixXd dual_hessian(const Eigen::Ref<const Eigen::MatrixXcd>& basis, bool complex_coefficients,
                             const Eigen::VectorXd& weights, const Eigen::VectorXcd& phi, const Eigen::VectorXd& delta,
                             const Eigen::VectorXd& reach) {
    const RealView view{complex_coefficients};
    Eigen::VectorXd storage;
    Eigen::MatrixXd sum;
    // A block at a time: the rows of all points would be several times as large as the basis.
    for (Eigen::Index first = 0; first < basis.rows(); first += kHessianPoints) {
        const Eigen::Index count = std::min<Eigen::Index>(kHessianPoints, basis.rows() - first);
        Eigen::MatrixXd part = hessian_of_rows(basis.middleRows(first, count), view, weights.segment(first, count),
                                               phi.segment(first, count), delta.segment(first, count),
                                               reach.segment(first, count), storage);
        if (first == 0)
            sum = std::move(part);
        else
            sum += part;
    }
    return sum;
}

namespace {

/// The norm on the points of the problem with a linear term, Σ w √(|φ_x|²+δ²) + t·x, to be minimised on the hyperplane
/// p·x = const. A tilt t makes its gradient that of another norm at one place; a quadratic term ½ (x − y)·C (x − y) its
/// Hessian too, where means over the points hide most of what functions do.
class TiltedNorm {
  public:
    TiltedNorm(const DualProblem& problem, const RealView& view, const Eigen::VectorXd& p, double delta)
        : problem_(problem), view_(view), p_(p), delta_(delta) {}

    /// With the quadratic term, without a tilt.
    Eigen::VectorXd gradient(const Eigen::VectorXd& x, const Eigen::VectorXcd& phi) const {
        Eigen::VectorXd result = view_.covector(dual_gradient(problem_.basis, problem_.weights, phi, delta_));
        if (bend_.size() > 0) result += bend_ * (x - bent_at_);
        return result;
    }

    /// Makes @p hessian (lower triangle) the Hessian at @p x.
    void bend(const Eigen::VectorXd& x, const Eigen::VectorXcd& phi, const Eigen::VectorXd& reach,
              const Eigen::MatrixXd& hessian) {
        const Eigen::MatrixXd more = hessian - own_hessian(phi, reach);
        bend_ = more.selfadjointView<Eigen::Lower>();
        bent_at_ = x;
        wanted_ = hessian;
        same_hessian_ = false;
    }

    struct End {
        int steps = 0;
        bool converged = false;
    };
    /// Newton's method with backtracking from @p x.
    /// @param phi       of x at the points; moves with it
    /// @param reach     by how much φ is expected to move at the points; afterwards, in a step that would follow
    /// @param step      it ends where another step is expected to be shorter than this part of x
    /// @param fraction  … or than this part of the way made so far
    End descend(Eigen::VectorXd& x, Eigen::VectorXcd& phi, const Eigen::VectorXd& tilt, Eigen::VectorXd& reach,
                double step, double fraction, int max_steps) {
        End end;
        const Eigen::VectorXd start = x;
        double value = problem_.weights.dot(sizes_of(phi, delta_)) + tilt.dot(x) + bent(x), last_moved = 0;
        while (end.steps < max_steps) {
            const Eigen::VectorXd slope_by = gradient(x, phi) + tilt;
            const bool fresh = !same_hessian_;
            if (fresh && !set_hessian(phi, reach)) break;
            same_hessian_ = false;
            const Eigen::VectorXd direction = newton_step(slope_by);
            const double slope = slope_by.dot(direction), scale = std::abs(value);
            if (!(slope < -kGradientTolerance * kGradientTolerance * scale)) {
                end.converged = slope > -kGradientTolerance * scale;
                break;
            }
            const Eigen::VectorXcd phi_step = times_columns(problem_.basis, view_.unpack(direction));
            // At the level of rounding no step need descend.
            const bool flat = -slope < kGradientTolerance * scale;
            double length = 1;
            bool accepted = false;
            for (int halving = 0; halving < (fresh ? kHalvings : 1) && !accepted; ++halving) {
                const Eigen::VectorXcd trial = phi + length * phi_step;
                const double trial_value = problem_.weights.dot(sizes_of(trial, delta_)) + tilt.dot(x) +
                                           length * tilt.dot(direction) + bent(x + length * direction);
                accepted = trial_value <= value + (flat ? kGradientTolerance * scale : kDescent * length * slope);
                if (accepted) {
                    phi = trial;
                    value = trial_value;
                } else {
                    length *= 0.5;
                }
            }
            if (!accepted) {
                if (fresh) break;
                continue;  // with the Hessian of the place
            }
            x += length * direction;
            reach = kReach * length * sizes_of(phi_step, 0);
            ++end.steps;
            const double moved = length * direction.norm();
            if (last_moved > 0) rate_ = std::min(1.0, moved / last_moved);
            const double rest = rate_ * moved;
            same_hessian_ = length == 1 && moved < kSameHessian * x.norm() && (fresh || moved < kReach * last_moved);
            if (flat || rest < step * x.norm() || rest < fraction * (x - start).norm()) {
                end.converged = true;
                break;
            }
            last_moved = moved;
        }
        return end;
    }

  private:
    Eigen::MatrixXd own_hessian(const Eigen::VectorXcd& phi, const Eigen::VectorXd& reach) {
        return hessian_of_rows(problem_.basis, view_, problem_.weights, phi,
                               Eigen::VectorXd::Constant(phi.size(), delta_), reach, storage_);
    }

    /// The quadratic term.
    double bent(const Eigen::VectorXd& x) const {
        if (bend_.size() == 0) return 0;
        const Eigen::VectorXd way = x - bent_at_;
        return 0.5 * way.dot(bend_ * way);
    }

    /// @return false if the Hessian is not definite
    bool set_hessian(const Eigen::VectorXcd& phi, const Eigen::VectorXd& reach) {
        Eigen::MatrixXd hessian = own_hessian(phi, reach);
        if (bend_.size() == 0) return factorize(hessian);
        hessian += bend_;
        if (factorize(hessian)) return true;
        // Far from where it was bent the sum need not be definite: then that of the place itself serves.
        hessian = wanted_;
        return factorize(hessian);
    }

    /// @param hessian lower triangle; changed
    bool factorize(Eigen::MatrixXd& hessian) {
        // x itself is a null direction (the norm is homogeneous of degree one). On the hyperplane a multiple of p pᵀ
        // changes nothing and makes the matrix definite; the tiny shift is for functions that no quadrature point sees.
        const double mean_diagonal = hessian.trace() / static_cast<double>(p_.size());
        hessian.selfadjointView<Eigen::Lower>().rankUpdate(p_, mean_diagonal / p_.squaredNorm());
        hessian.diagonal().array() += 1e-14 * mean_diagonal;
        cholesky_.compute(hessian);
        if (cholesky_.info() != Eigen::Success) return false;
        by_constraint_ = cholesky_.solve(p_);
        return true;
    }

    Eigen::VectorXd newton_step(const Eigen::VectorXd& gradient) const {
        const Eigen::VectorXd by_gradient = cholesky_.solve(gradient);
        return p_.dot(by_gradient) / p_.dot(by_constraint_) * by_constraint_ - by_gradient;
    }

    const DualProblem& problem_;
    const RealView& view_;
    const Eigen::VectorXd& p_;
    double delta_;
    Eigen::MatrixXd bend_;     ///< of the quadratic term; empty: there is none
    Eigen::VectorXd bent_at_;  ///< y
    Eigen::MatrixXd wanted_;   ///< the Hessian there, lower triangle
    Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> cholesky_;
    Eigen::VectorXd by_constraint_;
    Eigen::VectorXd storage_;    ///< of hessian_of_rows()
    bool same_hessian_ = false;  ///< the next step takes the one at hand
    double rate_ = 1;            ///< what a step is expected to leave, as part of it: the last two steps' ratio
};

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
    Eigen::VectorXcd coarse_phi = times_columns(problem.basis, view.unpack(x));
    const double total = problem.weights.sum();
    const auto mean_size = [&] { return total > 0 ? problem.weights.dot(sizes_of(coarse_phi, 0)) / total : 0.0; };
    const double delta = problem.rounding * mean_size();
    TiltedNorm coarse(problem, view, p, delta);
    const Eigen::VectorXcd start_phi = coarse_phi;
    Eigen::VectorXd reach = options.reach.size() ? Eigen::VectorXd(mean_size() * options.reach)
                                                 : Eigen::VectorXd(kFirstReach * sizes_of(coarse_phi, 0));
    if (x.size() == 1) {  // the hyperplane of a single real function is a point
        solution.converged = true;
        solution.phi = fine.values(view.unpack(x));
        solution.norm = fine.norm(solution.phi, delta);
    } else if (!options.norm) {
        const TiltedNorm::End end =
            coarse.descend(x, coarse_phi, Eigen::VectorXd::Zero(x.size()), reach, options.step, 0, options.max_steps);
        solution.newton_steps = end.steps;
        solution.converged = end.converged;
        solution.phi = coarse_phi;
        solution.norm = own.norm(solution.phi, delta);
    } else {
        // The norm on fewer points, tilted to have the gradient of the other one: its minimum is that of the other one
        // but for the change of the difference between them.
        Eigen::VectorXcd phi = fine.values(view.unpack(x));
        double norm = fine.norm(phi, delta), last_moved = 0;
        bool trusted = true;
        int flat_rounds = 0;
        const auto bend = [&] {
            const Eigen::MatrixXd hessian = fine.hessian(phi, delta, reach);
            solution.bent = hessian.rows() > 0;
            if (solution.bent) coarse.bend(x, coarse_phi, reach, hessian);
        };
        if (options.bent) bend();
        for (int round = 0; solution.newton_steps < options.max_steps; ++round) {
            const Eigen::VectorXd gradient = view.covector(fine.gradient(phi, delta));
            const Eigen::VectorXd tilt = gradient - coarse.gradient(x, coarse_phi);
            Eigen::VectorXd next = x;
            const TiltedNorm::End end =
                coarse.descend(next, coarse_phi, tilt, reach, options.step, kInnerFraction,
                               std::min(trusted ? kInnerSteps : 1, options.max_steps - solution.newton_steps));
            solution.newton_steps += end.steps;
            if (end.steps == 0 && !end.converged) break;
            const Eigen::VectorXd direction = next - x;
            const double slope = gradient.dot(direction);
            if (!(slope < -kGradientTolerance * kGradientTolerance * norm)) {
                solution.converged = slope > -kGradientTolerance * norm;
                break;
            }
            const bool flat = -slope < kGradientTolerance * norm;
            flat_rounds += flat;
            const Eigen::VectorXcd phi_next = fine.values(view.unpack(next));
            double length = 1;
            bool accepted = false;
            for (int halving = 0; halving < kHalvings && !accepted; ++halving) {
                const Eigen::VectorXcd trial =
                    length < 1 ? Eigen::VectorXcd(phi + length * (phi_next - phi)) : phi_next;
                const double trial_norm = fine.norm(trial, delta);
                accepted = trial_norm <= norm + (flat ? kGradientTolerance * norm : kDescent * length * slope);
                if (accepted) {
                    phi = trial;
                    norm = trial_norm;
                } else {
                    length *= 0.5;
                }
            }
            if (accepted) x += length * direction;
            if (length < 1) coarse_phi = times_columns(problem.basis, view.unpack(x));
            const double moved = length * direction.norm() / x.norm();
            // What another round would still change.
            const double rate = round == 0 ? kFirstRate : std::min(1.0, moved / last_moved);
            const double rest = moved * rate;
            last_moved = moved;
            // Functions that the coarse norm hardly sees lead it astray: then with the other norm's Hessian, or, where
            // that is not to be had, step by step.
            const bool whole = length > kTrusted;
            if (trusted && (solution.bent ? length < 1 || rate > kSlow : !whole)) {
                bend();
                trusted = solution.bent;
            }
            if (flat_rounds > kFlatRounds || (accepted && whole && rest < std::max(options.step, kExact))) {
                solution.converged = true;
                break;
            }
            if (!accepted) break;
        }
        solution.phi = std::move(phi);
        solution.norm = norm;
    }
    solution.coefficients = view.unpack(x);
    solution.pairing = p.dot(x);
    solution.moved = sizes_of(coarse_phi - start_phi, 0) / mean_size();
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
