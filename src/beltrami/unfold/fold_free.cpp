#include <beltrami/unfold/fold_free.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/solve/coupled_system.h>
#include <beltrami/unfold/distortion_energy.h>

namespace beltrami {

namespace {

using Curvature = DistortionEnergy::Curvature;

/// Least eigenvalue of a sample's projected Hessian in units of its weight, and its growth when a factorisation fails.
constexpr double kFloor = 1e-9, kFloorGrowth = 1e3, kHighestFloor = 1.0;
/// A step without folds goes at most this part of the way to the first collapse.
constexpr double kPartOfCollapse = 0.9;
constexpr double kArmijo = 1e-4;
constexpr int kHalvings = 40;
/// Below this decrement rounding hides whether a step lowers the energy.
constexpr double kRoundingDecrement = 1e-6;
/// Stages before the last power stop here.
constexpr double kStageTolerance = 1e-2;
/// Each step lowers ε by the first part at least, as far as folds allow; by the second where Newton's method has
/// settled.
constexpr double kLeastDecrease = 0.1, kSettledDecrease = 0.5, kSettled = 0.2;
/// The exact Hessian is tried where the decrement is below the first and falls by less than the second in a step.
constexpr double kNear = 0.1, kSlow = 0.4;
/// λ of the area term where the boundary does not fix the area.
constexpr double kAreaTerm = 0.1;
/// Untangling is given up when ε falls below the first, or the smallest determinant has not risen for so many steps.
constexpr double kLeastEpsilon = 1e-9;
constexpr int kPatience = 100;
constexpr int kExpectedFactorizations = 20;

/// Newton steps of the distortion energy.
class NewtonSystem {
  public:
    NewtonSystem(const Operators& operators, const std::vector<Freedom>& freedoms)
        : operators_(operators), system_(operators, freedoms, kExpectedFactorizations) {}

    using Step = CoupledSystem::Step;
    int factorization_count() const { return system_.factorization_count(); }

    /// With the projected Hessian; this cannot fail but by rounding.
    Step step(const DistortionEnergy& energy, const Eigen::VectorXcd& f, Regularisation regularisation,
              const DistortionEnergy::Value& at) {
        for (double floor = kFloor;; floor *= kFloorGrowth) {
            try {
                return solve(energy, f, regularisation, at, Curvature::projected, floor);
            } catch (const Error& error) {
                if (error.cause() != Cause::not_solved || floor * kFloorGrowth > kHighestFloor) throw;
            }
        }
    }

    /// With the exact Hessian, for quadratic convergence; nothing where it is not positive definite.
    std::optional<Step> exact_step(const DistortionEnergy& energy, const Eigen::VectorXcd& f,
                                   const DistortionEnergy::Value& at) {
        try {
            Step step = solve(energy, f, {}, at, Curvature::exact, 0);
            if (step.slope < 0) return step;
            return {};
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved) throw;
            return {};
        }
    }

  private:
    Step solve(const DistortionEnergy& energy, const Eigen::VectorXcd& f, Regularisation regularisation,
               const DistortionEnergy::Value& at, Curvature curvature, double floor) {
        system_.set_zero();
        for (int s = 0; s < operators_.sample_count(); ++s) {
            if (!energy.counts(s)) continue;
            const auto e = energy.element(s, f, regularisation, at, curvature, floor);
            system_.add(s, e.gradient.data(), e.hessian.data());
        }
        return system_.solve();
    }

    const Operators& operators_;
    CoupledSystem system_;
};

/// ε lowered by a part, less where folds are deep: Garanzha et al. 2021, section 4.
double lowered(double epsilon, double smallest_determinant, double part) {
    if (smallest_determinant >= 0) return (1 - part) * epsilon;
    const double root = std::hypot(smallest_determinant, epsilon);
    return epsilon * (1 - part * root / (std::abs(smallest_determinant) + root));
}

/// Untangles, then descends, raising the power in stages.
class Descent {
  public:
    /// @param area_term whether the energy must keep a folded map from shrinking
    Descent(DistortionEnergy& energy, NewtonSystem& system, bool area_term, const FoldFreeOptions& options,
            FoldFreeMap& result)
        : energy_(energy), system_(system), area_(area_term ? kAreaTerm : 0), options_(options), result_(result) {}

    FoldFreeStatus run(Eigen::VectorXcd& f) {
        at_ = energy_.value(f, {});
        if (!at_.finite()) {
            epsilon_ = std::max(1.0, -at_.smallest_determinant);
            at_ = energy_.value(f, regularisation());
        }
        record();
        int best_step = 0;  // when the smallest determinant last rose, while there are folds
        double best_determinant = at_.smallest_determinant;
        for (;;) {
            if (result_.iterations >= options_.max_iterations) return FoldFreeStatus::iteration_limit;
            const bool last_stage = epsilon_ == 0 && power_ == options_.power;
            NewtonSystem::Step step;
            try {
                step = next_step(f, last_stage);
            } catch (const Error& error) {
                if (error.cause() != Cause::not_solved) throw;
                return FoldFreeStatus::stuck;
            }
            const double decrement = std::sqrt(std::max(0.0, -step.slope) / at_.mean);
            slow_ = was_exact_ || (decrement < kNear && decrement > kSlow * previous_decrement_);
            previous_decrement_ = decrement;
            if (last_stage && decrement <= options_.tolerance) return FoldFreeStatus::converged;

            const Taken taken = take(step, f);
            ++result_.iterations;
            if (taken.length == 0 && last_stage)
                return decrement < kRoundingDecrement ? FoldFreeStatus::converged : FoldFreeStatus::stuck;
            if (epsilon_ > 0) {
                if (at_.smallest_determinant > best_determinant) {
                    best_determinant = at_.smallest_determinant;
                    best_step = result_.iterations;
                }
                const bool settled = taken.length == 1 && decrement < kSettled;
                epsilon_ = at_.smallest_determinant > 0
                               ? 0
                               : lowered(epsilon_, at_.smallest_determinant,
                                         std::max(taken.fallen, settled ? kSettledDecrease : kLeastDecrease));
                if (epsilon_ > 0 && (epsilon_ < kLeastEpsilon || result_.iterations - best_step > kPatience))
                    return FoldFreeStatus::stuck;
                at_ = energy_.value(f, regularisation());
            } else if (power_ < options_.power && (taken.length == 0 || decrement <= kStageTolerance)) {
                power_ = std::min(2 * power_, options_.power);
                energy_.set_power(power_);
                at_ = energy_.value(f, {});
            }
            record();
            if (options_.progress && !options_.progress(result_.iterations, at_.mean))
                throw Error(Cause::cancelled, "cancelled after step " + std::to_string(result_.iterations));
        }
    }

  private:
    struct Taken {
        double length = 0;  ///< 0 if no step lowered the energy
        double fallen = 0;  ///< part of the energy
    };

    Regularisation regularisation() const { return epsilon_ > 0 ? Regularisation{epsilon_, area_} : Regularisation{}; }
    void record() { result_.history.push_back({at_.mean, epsilon_, power_, at_.smallest_determinant}); }

    /// With the exact Hessian where the projected one has become slow, seldom again after it was indefinite.
    NewtonSystem::Step next_step(const Eigen::VectorXcd& f, bool last_stage) {
        was_exact_ = false;
        if (last_stage && slow_ && projected_steps_ >= wait_) {
            projected_steps_ = 0;
            if (auto exact = system_.exact_step(energy_, f, at_)) {
                wait_ = 0;
                was_exact_ = true;
                return *exact;
            }
            wait_ = 2 * wait_ + 1;
        }
        ++projected_steps_;
        return system_.step(energy_, f, regularisation(), at_);
    }

    /// Backtracks from the full step, or from short of the first collapse, until the energy falls enough.
    Taken take(const NewtonSystem::Step& step, Eigen::VectorXcd& f) {
        double length = 1;
        if (epsilon_ == 0) length = std::min(1.0, kPartOfCollapse * energy_.step_to_fold(f, step.direction));
        for (int halving = 0; halving < kHalvings; ++halving, length *= 0.5) {
            const Eigen::VectorXcd trial = f + length * step.direction;
            const DistortionEnergy::Value there = energy_.value(trial, regularisation());
            if (!there.finite() || !(there.mean <= at_.mean + kArmijo * length * step.slope)) continue;
            const double fallen = 1 - there.mean / at_.mean;
            f = trial;
            at_ = there;
            return {length, fallen};
        }
        return {};
    }

    DistortionEnergy& energy_;
    NewtonSystem& system_;
    double area_;
    const FoldFreeOptions& options_;
    FoldFreeMap& result_;
    double epsilon_ = 0, power_ = 1;
    DistortionEnergy::Value at_;
    double previous_decrement_ = 0;
    bool slow_ = false, was_exact_ = false;
    int projected_steps_ = 0, wait_ = 0;
};

}  // namespace

void FoldFreeOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(power >= 1 && std::isfinite(power), "power must be at least 1");
    demand(max_iterations >= 0, "max_iterations must not be negative");
    demand(tolerance > 0, "tolerance must be positive");
}

FoldFreeMap fold_free_map(const Surface& source, const std::vector<Freedom>& freedoms, const Eigen::VectorXcd& nu,
                          const Eigen::VectorXcd& start, const FoldFreeOptions& options) {
    options.validate();
    const Operators& operators = source.operators;
    if (static_cast<int>(freedoms.size()) != operators.vertex_count || start.size() != operators.vertex_count)
        throw Error(Cause::bad_option, "freedoms and start need one entry per vertex");
    if (nu.size() != operators.sample_count()) throw Error(Cause::bad_option, "nu needs one entry per sample");
    for (Eigen::Index s = 0; s < nu.size(); ++s)
        if (!(std::abs(nu[s]) < 1))
            throw Error(Cause::bad_option, "|nu| is not below 1 on face " + std::to_string(operators.faces[s]), "",
                        {Things::faces, {operators.faces[s]}});
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (freedoms[v] == Freedom::sliding)
            throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " slides",
                        "a fold-free solve knows only free and fixed vertices",
                        {Things::vertices, {static_cast<int>(v)}});
    if (!start.allFinite()) throw Error(Cause::bad_boundary, "the start map is not finite");

    std::vector<Freedom> held = freedoms;
    std::vector<char> referenced(freedoms.size(), 0);
    for (const int v : operators.vertices) referenced[v] = 1;
    bool nothing_fixed = true;
    for (std::size_t v = 0; v < held.size(); ++v)
        nothing_fixed = nothing_fixed && (!referenced[v] || held[v] == Freedom::free);
    fix_similarity(source, start, held);

    FoldFreeMap result;
    result.map = start;
    std::vector<char> left_out(operators.sample_count(), 0);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        left_out[s] = std::all_of(stencil.begin(), stencil.end(), [&](int v) { return held[v] == Freedom::fixed; });
    }
    DistortionEnergy energy(operators, nu, 1, left_out);

    const Complex centre = start.mean();
    Eigen::VectorXcd f = start.array() - centre;
    double determinant = 0, size = 0, total = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto [a, b] = energy.derivatives(s, f);
        const double w = operators.weights[s] * (1 - std::norm(nu[s]));
        determinant += w * (std::norm(a) - std::norm(b));
        size += w * (std::norm(a) + std::norm(b));
        total += w;
        const int face = operators.faces[s];
        if (left_out[s] && std::norm(a) <= std::norm(b) &&
            (result.unrepairable.empty() || result.unrepairable.back() != face))
            result.unrepairable.push_back(face);
    }
    if (!(size > 0))
        throw Error(Cause::bad_boundary, "the start map sends everything to one point",
                    "give a start with an image of positive area");
    bool whole_boundary = true;
    for (std::size_t v = 0; v < held.size(); ++v)
        whole_boundary = whole_boundary && (!source.topology.on_boundary[v] || freedoms[v] == Freedom::fixed);
    if (whole_boundary && !(determinant > 0)) {
        result.status = FoldFreeStatus::impossible;
        return result;
    }
    if (std::find(left_out.begin(), left_out.end(), 0) == left_out.end()) {
        result.fold_free = result.unrepairable.empty();
        result.status = result.fold_free ? FoldFreeStatus::converged : FoldFreeStatus::impossible;
        return result;
    }

    // From here on the mean determinant (the mean size, if that is not positive) is 1.
    const double unit = std::sqrt((determinant > 0 ? determinant : size) / total);
    f /= unit;
    const bool turned_over = nothing_fixed && determinant < 0;
    if (turned_over) f = f.conjugate().eval();

    NewtonSystem system(operators, held);
    Descent descent(energy, system, !whole_boundary, options, result);
    result.status = descent.run(f);
    result.factorizations = system.factorization_count();

    for (int v = 0; v < operators.vertex_count; ++v)
        if (held[v] == Freedom::free || turned_over) result.map[v] = centre + unit * f[v];
    result.fold_free = result.unrepairable.empty();
    for (int s = 0; s < operators.sample_count() && result.fold_free; ++s) {
        const auto [d_z, d_zbar] = operators.derivatives(s, result.map);
        result.fold_free = std::norm(d_z) > std::norm(d_zbar);
    }
    if (!result.unrepairable.empty())
        result.status = FoldFreeStatus::impossible;
    else if (!result.fold_free && result.status == FoldFreeStatus::converged)
        result.status = FoldFreeStatus::stuck;
    return result;
}

}  // namespace beltrami
