#include <beltrami/uniformize/conformal_equivalence.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/linear/graph_laplacian.h>

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
            const TriangleAngles triangle = surface.angles(t, u);
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
    void forget_pattern() { laplacian_.reset(); }

    /// @param free which vertices are, read where the pattern is rebuilt
    /// @return −H⁻¹ defect at the free vertices, 0 elsewhere
    Eigen::VectorXd step(const ScaledSurface& surface, const std::vector<char>& free, const State& state,
                         const Eigen::VectorXd& u) {
        const IntrinsicTriangulation& triangulation = surface.triangulation();
        if (!laplacian_) build_pattern(triangulation, free);
        weights_.resize(edges_.size());
        Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(u.size());
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const int h = edges_[e], twin = triangulation.twin(h);
            const double weight = 0.5 * (state.cotangents[h] + (twin >= 0 ? state.cotangents[twin] : 0.0));
            // w ((x − y)² + c (x + y)²) = w (1 − c) (x − y)² + 2 w c (x² + y²)
            const double share = surface.scale_share(h, u);
            weights_[e] = (1 - share) * weight;
            diagonal[triangulation.tail(h)] += 2 * share * weight;
            diagonal[triangulation.head(h)] += 2 * share * weight;
        }
        laplacian_->set(weights_);
        laplacian_->add_to_diagonal(diagonal);
        return solve(-state.defect);
    }

  private:
    void build_pattern(const IntrinsicTriangulation& triangulation, const std::vector<char>& free) {
        edges_.clear();
        std::vector<std::array<int, 2>> ends;
        for (int h = 0; h < triangulation.halfedge_count(); ++h) {
            if (h < triangulation.twin(h)) continue;
            edges_.push_back(h);
            ends.push_back({triangulation.tail(h), triangulation.head(h)});
        }
        std::vector<char> held(free.size());
        std::transform(free.begin(), free.end(), held.begin(), [](char f) { return !f; });
        laplacian_.emplace(std::move(ends), held, 2);
    }

    /// Degenerate triangles have no cotangents and may leave the matrix singular or nearly so: a shift of its diagonal
    /// then keeps the step finite, and a direction of descent.
    Eigen::VectorXd solve(const Eigen::VectorXd& right_side) {
        const double mean = laplacian_->mean_diagonal();
        for (double shift = 0;;) {
            const double next_shift = shift == 0 ? kFirstShift * mean : 100 * shift;
            const bool may_shift = next_shift <= kLargestShift * mean;
            ++factorizations_;
            try {
                laplacian_->factorize();
                Eigen::VectorXd solution = laplacian_->solve(right_side);
                if (solution.lpNorm<Eigen::Infinity>() <= kLongestStep || !may_shift) return solution;
            } catch (const Error&) {
                if (!may_shift) throw;
            }
            laplacian_->shift_diagonal(next_shift - shift);
            shift = next_shift;
        }
    }

    std::vector<int> edges_;  // the half-edge of every edge that its weight is read at
    std::vector<double> weights_;
    std::optional<GraphLaplacian> laplacian_;
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

        const Eigen::VectorXd direction = hessian.step(surface, free, state, u);
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
