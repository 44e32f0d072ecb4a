#include <beltrami/baselines/t_map_scheme.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/operators/sample_neighbours.h>
#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/starts/sliding_loops.h>

namespace beltrami {

namespace {

constexpr int kExpectedFactorizations = 20;
/// |μ| counts as at most this, so that flipped faces do not spoil the mean.
constexpr double kMostSchemeMu = 0.95;
/// Of a linear solve, relative to the map.
constexpr double kSolveTolerance = 1e-10;

/// μ of a map, held below kMostSchemeMu.
Eigen::VectorXcd held_coefficient(const Surface& source, const Eigen::VectorXcd& map) {
    Eigen::VectorXcd mu = beltrami_coefficient(source.operators, map);
    for (Complex& value : mu) {
        const double size = std::abs(value);
        if (!std::isfinite(size)) {
            value = kMostSchemeMu;
        } else if (size > kMostSchemeMu) {
            value *= kMostSchemeMu / size;
        }
    }
    return mu;
}

std::vector<Freedom> held_boundary(const std::vector<Freedom>& freedoms) {
    std::vector<Freedom> result = freedoms;
    std::replace(result.begin(), result.end(), Freedom::sliding, Freedom::fixed);
    return result;
}

class Scheme {
  public:
    Scheme(const Surface& source, const SlidingStart& start, const TMapSchemeOptions& options)
        : source_(source),
          options_(options),
          neighbours_(source),
          boundary_(source, start.loops),
          sliding_(source, boundary_, start.map, kExpectedFactorizations),
          fixed_(source, held_boundary(boundary_.freedoms()), kExpectedFactorizations) {
        result_.map = start.map;
        boundary_.place(result_.map);
    }

    TMapSchemeResult run() {
        using Part = TMapSolve::Part;
        const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(source_.operators.sample_count());
        for (int i = 0; i < options_.initial_steps && left(); ++i) slide(none, Part::initial);
        mu_ = held_coefficient(source_, result_.map);
        project();
        result_.termination = Termination::iteration_limit;
        while (left()) {
            const Eigen::VectorXcd before = mu_;
            if (options_.damping > 0) {
                slide((1 - options_.damping) * mu_, Part::damping);
                mu_ = held_coefficient(source_, result_.map);
            }
            project();
            if ((mu_ - before).cwiseAbs().maxCoeff() < options_.tolerance) {
                result_.termination = Termination::converged;
                break;
            }
        }
        result_.factorizations = sliding_.factorization_count() + fixed_count_;
        return std::move(result_);
    }
    const SlidingBoundary& boundary() const { return boundary_; }

  private:
    bool left() const { return result_.solves < options_.max_solves; }

    /// P: Algorithm 2.
    void project() {
        for (int i = 0; i < options_.projection_steps && left(); ++i) {
            const Eigen::VectorXcd before = mu_, nu = evened();
            if (options_.projection == TMapSchemeOptions::Projection::sliding_boundary) {
                slide(nu, TMapSolve::Part::projection);
            } else {
                result_.map = fixed_.solve_near(nu, result_.map, result_.map, kSolveTolerance);
                fixed_count_ = fixed_.factorization_count();
                record(TMapSolve::Part::projection);
            }
            mu_ = held_coefficient(source_, result_.map);
            if ((mu_ - before).cwiseAbs().maxCoeff() < options_.tolerance) break;
        }
    }

    /// L(N(μ)): the mean of |μ| is a constant, so that only arg μ is left to smooth.
    Eigen::VectorXcd evened() const {
        double mean = 0;
        Eigen::VectorXcd phase(mu_.size()), smoothed(mu_.size());
        for (int s = 0; s < mu_.size(); ++s) {
            const double size = std::abs(mu_[s]);
            mean += source_.operators.weights[s] * size;
            phase[s] = size > 0 ? mu_[s] / size : Complex(1);
        }
        mean /= source_.operators.area();
        for (int pass = 0; pass < options_.smoothing_passes; ++pass) {
            neighbours_.smooth(phase, options_.smoothing, smoothed);
            phase.swap(smoothed);
        }
        return mean * phase;
    }

    void slide(const Eigen::VectorXcd& nu, TMapSolve::Part part) {
        sliding_.set_map(std::move(result_.map));
        sliding_.solve(nu, kSolveTolerance);
        result_.map = sliding_.map();
        record(part);
    }

    void record(TMapSolve::Part part) {
        ++result_.solves;
        const Distortion d = distortion(source_.operators, result_.map);
        result_.history.push_back({part, d.mean, d.standard_deviation, d.max, static_cast<int>(d.flipped.size())});
        if (options_.progress && !options_.progress(result_.solves, result_.history.back()))
            throw Error(Cause::cancelled, "cancelled after solve " + std::to_string(result_.solves));
    }

    const Surface& source_;
    const TMapSchemeOptions& options_;
    SampleNeighbours neighbours_;
    SlidingBoundary boundary_;
    SlidingMapStep sliding_;
    BeltramiSolver fixed_;
    int fixed_count_ = 0;
    Eigen::VectorXcd mu_;
    TMapSchemeResult result_;
};

}  // namespace

void TMapSchemeOptions::validate() const {
    if (!(damping >= 0 && damping < 1)) throw Error(Cause::bad_option, "the damping must be 0 or more and below 1");
    if (projection_steps < 1) throw Error(Cause::bad_option, "a projection needs at least one solve");
    if (!(smoothing >= 0 && smoothing <= 1)) throw Error(Cause::bad_option, "the smoothing must be from 0 to 1");
    if (smoothing_passes < 0) throw Error(Cause::bad_option, "the passes of smoothing must not be negative");
    if (initial_steps < 0) throw Error(Cause::bad_option, "the initial steps must not be negative");
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance must be positive");
    if (max_solves < 1) throw Error(Cause::bad_option, "there must be at least one solve");
}

TMapSchemeResult t_map_scheme(const Surface& source, const SlidingStart& start, const TMapSchemeOptions& options) {
    options.validate();
    require_genus_zero(source);
    require_start_of(source, start);
    Scheme scheme(source, start, options);
    TMapSchemeResult result = scheme.run();
    record_map(source, start, scheme.boundary(), result);
    try {
        require_not_collapsed(result.loops);
    } catch (const Error& error) {
        result.warnings.push_back({WarningKind::collapsed_loop, error.what(), error.where()});
    }
    warn_of_folds_and_limit(std::to_string(result.solves) + " solves before the coefficient settled", result);
    return result;
}

TMapSchemeResult t_map_scheme(const Surface& source, const TargetDomain& target, const TMapSchemeOptions& options,
                              const Correspondence& wanted, const FlowStartOptions& start) {
    options.validate();
    return t_map_scheme(source, flow_start(source, target, wanted, start), options);
}

}  // namespace beltrami
