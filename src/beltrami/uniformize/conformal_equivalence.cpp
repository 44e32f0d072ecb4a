#include <beltrami/uniformize/conformal_equivalence.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/linear/symmetric_solver.h>

namespace beltrami {

namespace {

constexpr int kMostHalvings = 40;
constexpr double kSlopeAllowed = 0.1;     // share of the first slope that may be left, on the far side of the minimum
constexpr double kDegenerateBelow = 0.1;  // defects at which degenerate triangles are taken to be there to stay
constexpr double kRoundingLevel = 1e-6;   // stagnation above this defect is a failure, below it is rounding
constexpr double kLongestStep = 200;      // of u: no surface that can be meshed asks for more at once
constexpr double kFirstShift = 1e-9;      // of the mean diagonal
constexpr double kLargestShift = 1e-2;

/// Angle sums, cotangents and the list of degenerate triangles at one u.
struct State {
    Eigen::VectorXd defect;          // Θ − Σα, 0 where nothing is asked
    std::vector<double> cotangents;  // of the angle opposite each half-edge
    std::vector<int> degenerate;
    double residual = 0;

    void update(const ScaledSurface& surface, const ScaleFactorProblem& problem, const Eigen::VectorXd& u) {
        const IntrinsicTriangulation& triangulation = surface.triangulation();
        defect = problem.target_angles;
        cotangents.assign(static_cast<std::size_t>(triangulation.halfedge_count()), 0.0);
        degenerate.clear();
        for (int t = 0; t < triangulation.triangle_count(); ++t) {
            if (!surface.is_finite(t)) continue;
            const TriangleAngles triangle = triangulation.angles(t, u);
            if (triangle.degenerate) degenerate.push_back(t);
            for (int k = 0; k < 3; ++k) {
                const int h = 3 * t + k;
                cotangents[h] = triangle.cotangents[k];
                defect[triangulation.tail(IntrinsicTriangulation::previous(h))] -= triangle.angles[k];
            }
        }
        residual = 0;
        for (int v = 0; v < triangulation.vertex_count(); ++v) {
            if (std::isnan(defect[v]) || surface.is_held(v)) defect[v] = 0;
            residual = std::max(residual, std::abs(defect[v]));
        }
    }
};

/// A surface of which nothing but the problem holds vertices.
class PlainSurface final : public ScaledSurface {
  public:
    explicit PlainSurface(IntrinsicTriangulation& triangulation) : triangulation_(triangulation) {}
    const IntrinsicTriangulation& triangulation() const override { return triangulation_; }
    int make_delaunay(Eigen::VectorXd& u) override { return triangulation_.make_delaunay(u); }

  private:
    IntrinsicTriangulation& triangulation_;
};

std::vector<char> free_vertices(const ScaledSurface& surface, const ScaleFactorProblem& problem) {
    std::vector<char> free = problem.free;
    for (std::size_t v = 0; v < free.size(); ++v) free[v] = free[v] && !surface.is_held(static_cast<int>(v));
    return free;
}

/// The cotangent Laplacian of the free vertices. Its pattern is rebuilt only after flips.
class Hessian {
  public:
    int factorizations() const { return factorizations_; }
    void forget_pattern() { solver_.reset(); }

    /// @param free which vertices are, read where the pattern is rebuilt
    /// @return −H⁻¹ defect at the free vertices, 0 elsewhere
    Eigen::VectorXd step(const IntrinsicTriangulation& triangulation, const std::vector<char>& free,
                         const State& state) {
        if (!solver_) {
            number(free);
            build_pattern(triangulation);
        }
        fill(triangulation, state.cotangents);
        Eigen::VectorXd right_side(size_);
        for (std::size_t v = 0; v < unknowns_.size(); ++v)
            if (unknowns_[v] >= 0) right_side[unknowns_[v]] = -state.defect[static_cast<Eigen::Index>(v)];
        const Eigen::VectorXd solution = solve(right_side);
        Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns_.size()));
        for (std::size_t v = 0; v < unknowns_.size(); ++v)
            if (unknowns_[v] >= 0) result[static_cast<Eigen::Index>(v)] = solution[unknowns_[v]];
        return result;
    }

  private:
    void number(const std::vector<char>& free) {
        unknowns_.assign(free.size(), -1);
        size_ = 0;
        for (std::size_t v = 0; v < free.size(); ++v)
            if (free[v]) unknowns_[v] = size_++;
    }

    /// Row and column of an edge in the lower triangle; −1 if an end is fixed or both are the same vertex.
    std::pair<int, int> place(const IntrinsicTriangulation& triangulation, int h) const {
        const int i = unknowns_[triangulation.tail(h)], j = unknowns_[triangulation.head(h)];
        if (i < 0 || j < 0 || i == j) return {-1, -1};
        return {std::max(i, j), std::min(i, j)};
    }

    /// Two counting sorts, by row and then by column, give sorted columns in linear time.
    void build_pattern(const IntrinsicTriangulation& triangulation) {
        const int count = triangulation.halfedge_count();
        std::vector<int> row_start(static_cast<std::size_t>(size_) + 2, 0);
        std::vector<int> column_bound(static_cast<std::size_t>(size_) + 1, 0);  // room, before duplicates are merged
        for (int h = 0; h < count; ++h) {
            if (h < triangulation.twin(h)) continue;
            const auto [row, column] = place(triangulation, h);
            if (row < 0) continue;
            ++row_start[row + 2];
            ++column_bound[column + 1];
        }
        for (int i = 0; i < size_; ++i) {
            row_start[i + 2] += row_start[i + 1];
            column_bound[i + 1] += column_bound[i] + 1;
        }
        std::vector<int> by_row(static_cast<std::size_t>(row_start[size_ + 1]));
        for (int h = 0; h < count; ++h) {
            if (h < triangulation.twin(h)) continue;
            const int row = place(triangulation, h).first;
            if (row >= 0) by_row[row_start[row + 1]++] = h;
        }

        std::vector<int> rows(static_cast<std::size_t>(column_bound[size_]));
        std::vector<int> filled(column_bound.begin(), column_bound.end() - 1);
        slots_.assign(static_cast<std::size_t>(count), -1);
        for (int i = 0; i < size_; ++i) rows[filled[i]++] = i;  // the diagonal comes first in its column
        for (const int h : by_row) {
            const auto [row, column] = place(triangulation, h);
            if (rows[filled[column] - 1] != row) rows[filled[column]++] = row;
            slots_[h] = filled[column] - 1;
        }

        Matrix lower(size_, size_);
        std::vector<int> shift(static_cast<std::size_t>(size_));
        for (int i = 0; i < size_; ++i) {
            shift[i] = column_bound[i] - lower.outerIndexPtr()[i];
            lower.outerIndexPtr()[i + 1] = lower.outerIndexPtr()[i] + filled[i] - column_bound[i];
        }
        lower.resizeNonZeros(lower.outerIndexPtr()[size_]);
        for (int i = 0; i < size_; ++i)
            std::copy(rows.begin() + column_bound[i], rows.begin() + filled[i],
                      lower.innerIndexPtr() + lower.outerIndexPtr()[i]);
        for (const int h : by_row) slots_[h] -= shift[place(triangulation, h).second];
        std::fill(lower.valuePtr(), lower.valuePtr() + lower.nonZeros(), 0.0);
        solver_.emplace(std::move(lower), 2);
    }

    void fill(const IntrinsicTriangulation& triangulation, const std::vector<double>& cotangents) {
        Matrix& lower = solver_->matrix();
        double* values = lower.valuePtr();
        std::fill(values, values + lower.nonZeros(), 0.0);
        for (int h = 0; h < triangulation.halfedge_count(); ++h) {
            const int twin = triangulation.twin(h);
            if (h < twin) continue;
            const int i = unknowns_[triangulation.tail(h)], j = unknowns_[triangulation.head(h)];
            if (i == j) continue;
            const double weight = 0.5 * (cotangents[h] + (twin >= 0 ? cotangents[twin] : 0.0));
            if (i >= 0) values[lower.outerIndexPtr()[i]] += weight;
            if (j >= 0) values[lower.outerIndexPtr()[j]] += weight;
            if (slots_[h] >= 0) values[slots_[h]] -= weight;
        }
    }

    /// Degenerate triangles have no cotangents and may leave the matrix singular or nearly so: a shift of its diagonal
    /// then keeps the step finite, and a direction of descent.
    Eigen::VectorXd solve(const Eigen::VectorXd& right_side) {
        const double mean = solver_->matrix().diagonal().cwiseAbs().mean();
        for (double shift = 0;;) {
            const double next_shift = shift == 0 ? kFirstShift * mean : 100 * shift;
            const bool may_shift = next_shift <= kLargestShift * mean;
            ++factorizations_;
            try {
                solver_->factorize();
                Eigen::VectorXd solution = solver_->solve(right_side);
                if (solution.lpNorm<Eigen::Infinity>() <= kLongestStep || !may_shift) return solution;
            } catch (const Error&) {
                if (!may_shift) throw;
            }
            Matrix& lower = solver_->matrix();
            for (int i = 0; i < size_; ++i) lower.valuePtr()[lower.outerIndexPtr()[i]] += next_shift - shift;
            shift = next_shift;
        }
    }

    using Matrix = SymmetricSolver::Matrix;
    std::vector<int> unknowns_;  // vertex → unknown, −1 = fixed
    std::vector<int> slots_;     // half-edge → position of its entry among the values, −1 = none
    std::optional<SymmetricSolver> solver_;
    int size_ = 0;
    int factorizations_ = 0;
};

}  // namespace

ScaleFactors solve_scale_factors(IntrinsicTriangulation& triangulation, const ScaleFactorProblem& problem,
                                 Eigen::VectorXd u) {
    PlainSurface surface(triangulation);
    return solve_scale_factors(surface, problem, std::move(u));
}

ScaleFactors solve_scale_factors(ScaledSurface& surface, const ScaleFactorProblem& problem, Eigen::VectorXd u) {
    ScaleFactors result;
    Hessian hessian;
    State state, trial;
    result.flips = surface.make_delaunay(u);
    state.update(surface, problem, u);

    while (true) {
        const int released = surface.release(u);
        if (released > 0) {
            result.flips += released;
            hessian.forget_pattern();
            state.update(surface, problem, u);
        }
        const std::vector<char> free = free_vertices(surface, problem);
        if ((state.residual <= problem.tolerance && released == 0) ||
            std::find(free.begin(), free.end(), 1) == free.end()) {
            result.status = ScaleFactorStatus::converged;
            break;
        }
        if (problem.stop_when_degenerate && !state.degenerate.empty() && state.residual < kDegenerateBelow) {
            result.status = ScaleFactorStatus::degenerate;
            break;
        }
        if (result.iterations == problem.max_iterations) break;

        const Eigen::VectorXd direction = hessian.step(surface.triangulation(), free, state);
        const double slope = state.defect.dot(direction);
        const bool rounding = state.residual < kRoundingLevel && released == 0;
        // The energy is convex, so a slope that is still negative means descent; its value is never needed.
        bool accepted = false;
        double length = 1;
        for (int halving = 0; halving < kMostHalvings && !accepted; ++halving, length /= 2) {
            Eigen::VectorXd candidate = u + length * direction;
            const int flips = surface.make_delaunay(candidate);
            if (flips > 0) hessian.forget_pattern();
            result.flips += flips;
            trial.update(surface, problem, candidate);
            const double trial_slope = trial.defect.dot(direction);
            accepted = trial_slope <= -kSlopeAllowed * slope || trial.residual < 0.5 * state.residual;
            if (rounding) accepted = trial.residual < state.residual;
            if (accepted) {
                u = std::move(candidate);
                std::swap(state, trial);
            }
        }
        ++result.iterations;
        if (!accepted) {
            result.flips += surface.make_delaunay(u);
            state.update(surface, problem, u);
            result.status =
                state.residual < kRoundingLevel ? ScaleFactorStatus::stagnated : ScaleFactorStatus::out_of_steps;
            break;
        }
    }
    result.u = std::move(u);
    result.factorizations = hessian.factorizations();
    result.residual = state.residual;
    result.degenerate = std::move(state.degenerate);
    return result;
}

}  // namespace beltrami
