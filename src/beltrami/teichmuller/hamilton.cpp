#include <beltrami/teichmuller/hamilton.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/linear/anderson.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// k of the f-step stays below this.
constexpr double kLargest = 0.9999;
/// A change from which on a c-step need not be solved less precisely.
constexpr double kLargeChange = 0.1;
/// Changes of φ below this that do not become smaller for some iterations, while k stays, come from zeros of φ.
constexpr double kStalledBelow = 3e-4, kStalledChangeOfK = 1e-5;
constexpr int kStalledFor = 4;
/// k stays to this for so many steps, in which the change of φ has not halved: φ is settled as far as the data tell.
constexpr double kStillChangeOfK = 5e-6;
constexpr int kStillFor = 12;
/// φ changes by more than this while k changes by less than that, within so narrow a bracket of K.
constexpr double kQuietAbove = 1e-3, kQuietChangeOfK = 2e-4, kQuietGap = 0.02;
/// Steps taken in a preliminary space.
constexpr int kPreliminaryIterations = 2;
/// Newton step, as part of the whole, to which the first c-step with poles at corners is solved.
constexpr double kFirstStep = 0.15;
/// A c-step from nothing is solved to this change, where the bracket says what is worth while.
constexpr double kFirstStepWithin = 0.1;
/// Newton steps allowed in a c-step.
constexpr int kNewtonSteps = 40;
/// A larger space has so many steps to settle, and may lower the bound by this part.
constexpr int kGrownIterations = 15;
constexpr double kWorse = 1e-4;
/// A change above this that hardly falls is a φ that turns back and forth; the least part of a step that is then taken.
constexpr double kTurnsBack = 0.5, kLeastRelaxation = 0.125;

/// (direction of φ, k) as one real vector for the accelerated fixed-point iteration.
Eigen::VectorXd pack(const Eigen::VectorXcd& direction, double k) {
    Eigen::VectorXd x(2 * direction.size() + 1);
    x << direction.real(), direction.imag(), k;
    return x;
}

/// What tells that further steps would bring nothing.
class Settling {
  public:
    explicit Settling(const HamiltonIteration::Options& options) : options_(options) {}
    /// In a larger space all begins anew.
    void restart() {
        least_change_ = 1;
        since_least_ = quiet_ = still_ = 0;
    }
    /// Whether all has settled with a step, by which φ and k have changed.
    bool after(const CoefficientStep::Result& step, double change, double k_change, bool preliminary) {
        // Where k vanishes the direction of φ means nothing. Zeros of φ that wander across samples keep its direction
        // from settling entirely.
        if (change < 0.5 * least_change_) {
            least_change_ = change;
            since_least_ = 0;
        } else {
            ++since_least_;
        }
        // Where the data hardly tell two φ apart, φ wanders while k stays and the bound is as near as it will come.
        quiet_ = change > kQuietAbove && k_change < kQuietChangeOfK ? quiet_ + 1 : 0;
        still_ = k_change < kStillChangeOfK && change < kLargeChange ? still_ + 1 : 0;
        if (preliminary) return false;
        if (std::min(still_, since_least_) >= kStillFor) return true;
        const double gap = bracket(step);
        if (quiet_ >= options_.quiet_steps && gap < kQuietGap) return true;
        if (gap > options_.tight && change < kLargeChange &&
            std::max(change * change, k_change / step.k) < options_.within_bracket * gap)
            return true;
        if (gap - change * change > options_.widest) return true;
        if (!step.converged) return false;
        const bool stalled =
            least_change_ < kStalledBelow && since_least_ >= kStalledFor && k_change < kStalledChangeOfK;
        return stalled ||
               (k_change < options_.k_tolerance && (change < options_.tolerance || step.k < options_.k_tolerance));
    }

  private:
    const HamiltonIteration::Options& options_;
    double least_change_ = 1;
    int since_least_ = 0, quiet_ = 0, still_ = 0;
};

/// How φ and k of the next f-step follow from a c-step: they are its own, or led further by acceleration.
class Stride {
  public:
    /// @param known from elsewhere, or null
    Stride(const HamiltonIteration::Options& options, std::shared_ptr<AndersonAcceleration> known)
        : window_(options.anderson_window),
          begin_below_(options.accelerate_below),
          anderson_(known ? std::move(known) : std::make_shared<AndersonAcceleration>(window_)) {}
    /// What is known for another iteration of the kind.
    std::shared_ptr<AndersonAcceleration> known() {
        anderson_->leave_point();
        return anderson_;
    }
    /// In a larger space.
    void restart() {
        anderson_->reset();
        relaxation_ = 1;
    }
    void take(const CoefficientStep::Result& step, double change, HamiltonState& state) {
        // Acceleration can lead astray where the iteration is not smooth; a plain step then brings it back.
        const bool astray = accelerated_ && change > last_change_;
        if (astray) anderson_->reset();
        // Two φ that call for each other in turn are brought together by going half the way.
        if (change > kTurnsBack && change > 0.8 * last_change_)
            relaxation_ = std::max(0.5 * relaxation_, kLeastRelaxation);
        last_change_ = change;
        accelerated_ = window_ > 0 && change < begin_below_ && !astray;
        if (accelerated_) {
            const Eigen::VectorXd next = anderson_->next(pack(state.direction, state.k), pack(step.direction, step.k));
            const Eigen::Index m = state.direction.size();
            state.direction.real() = next.head(m);
            state.direction.imag() = next.segment(m, m);
            state.direction.normalize();
            state.k = std::clamp(next[2 * m], 0.0, kLargest);
        } else {
            state.direction =
                relaxation_ == 1
                    ? step.direction
                    : Eigen::VectorXcd(
                          (state.direction + relaxation_ * (step.direction - state.direction)).normalized());
            state.k = std::min(state.k + relaxation_ * (step.k - state.k), kLargest);
        }
    }

  private:
    int window_;
    double begin_below_;
    std::shared_ptr<AndersonAcceleration> anderson_;
    double last_change_ = 1, relaxation_ = 1;
    bool accelerated_ = false;
};

}  // namespace

double bracket(const CoefficientStep::Result& step) {
    return (1 + step.k) / ((1 - step.k) * step.merit) - 1;
}

Eigen::VectorXcd teichmueller_coefficient(double k, const Eigen::VectorXcd& phi) {
    Eigen::VectorXcd nu(phi.size());
    for (Eigen::Index s = 0; s < phi.size(); ++s) {
        const double size = std::sqrt(std::norm(phi[s]));
        nu[s] = size > 0 ? k * std::conj(phi[s]) / size : 0.0;
    }
    return nu;
}

HamiltonIteration::HamiltonIteration(MapStep& map_step, CoefficientStep& coefficient_step, Options options)
    : map_step_(map_step), coefficient_step_(coefficient_step), options_(std::move(options)) {}

/// k is exact to the square of these.
double HamiltonIteration::first_step() const {
    return std::max(options_.tolerance, options_.within_bracket > 0 ? kFirstStepWithin : 0.0) *
           options_.step_below_change;
}
double HamiltonIteration::growing_step() const {
    return options_.within_bracket > 0 ? options_.step_below_change * kFirstStepWithin : options_.growing_step;
}

/// Takes larger spaces while they raise k noticeably, or instead of a preliminary one; returns whether any did.
bool HamiltonIteration::grow(HamiltonState& state, const Eigen::VectorXcd& mu) {
    bool grown = false;
    if (state.space->preliminary()) {
        state.space = state.space->refined();
        coefficient_step_.set_space(*state.space);
        step_ = coefficient_step_.solve(mu, step_.direction, kFirstStep, kNewtonSteps);
        return true;
    }
    while (auto larger = state.space->refined()) {
        coefficient_step_.set_space(*larger);
        CoefficientStep::Result more = coefficient_step_.solve(mu, step_.direction, growing_step());
        if (!(more.k > step_.k * (1 + options_.growth))) {
            coefficient_step_.set_space(*state.space);
            break;
        }
        state.space = std::move(larger);
        step_ = std::move(more);
        grown = true;
    }
    return grown;
}

/// The state as it is given, or from nothing the c-step of the map as it stands.
void HamiltonIteration::begin(HamiltonState& state, std::unique_ptr<DifferentialSpace> smallest) {
    iterations_ = 0;
    converged_ = false;
    history_.clear();
    double largest = 0;
    if (!state.space) {
        state.space = std::move(smallest);
        coefficient_step_.set_space(*state.space);
        const Eigen::VectorXcd mu = beltrami_coefficient(map_step_.derivatives());
        largest = std::sqrt(mu.cwiseAbs2().maxCoeff());
        step_ = coefficient_step_.solve(mu, {}, first_step());
        if (!state.space->preliminary()) grow(state, mu);
        state.direction = step_.direction;
        state.k = step_.k;
    } else {
        coefficient_step_.set_space(*state.space);
    }
    history_.push_back({state.k, 1.0, state.space->size(), largest});
}

/// f-step and c-step, each as precise as the last change asks for.
/// @return μ of the map
Eigen::VectorXcd HamiltonIteration::step_from(const HamiltonState& state, double last_change) {
    const Eigen::VectorXcd& phi = coefficient_step_.values(state.direction);
    const Eigen::VectorXcd nu = coefficient_step_.coefficient(state.k, phi);
    map_step_.weigh(phi);
    const double change = std::min(last_change, kLargeChange);
    map_step_.solve(nu, options_.solve_below_change * change);
    ++iterations_;
    Eigen::VectorXcd mu = beltrami_coefficient(map_step_.derivatives());
    step_ = coefficient_step_.solve(mu, state.direction, options_.step_below_change * change, kNewtonSteps);
    return mu;
}

void HamiltonIteration::go_back_to(Kept kept, const HamiltonState& state) {
    map_step_.restore(kept.map);
    step_ = std::move(kept.step);
    step_.direction.conservativeResizeLike(Eigen::VectorXcd::Zero(state.space->size()));
}

void HamiltonIteration::run(HamiltonState& state, std::unique_ptr<DifferentialSpace> smallest) {
    const bool from_elsewhere = state.space != nullptr;
    begin(state, std::move(smallest));
    Settling settling(options_);
    Stride stride(options_, std::exchange(state.acceleration, nullptr));
    Kept best;      // is returned if nothing settles
    Kept fallback;  // had settled in a smaller space
    int grown_at = 0;
    double change = 1;
    while (iterations_ < options_.max_iterations) {
        const Eigen::VectorXcd mu = step_from(state, change);
        if (step_.merit > best.step.merit) best = {step_, map_step_.snapshot()};
        change = (step_.direction - state.direction).norm();
        const double k_change = std::abs(step_.k - state.k);
        history_.push_back({step_.k, change, state.space->size(), std::sqrt(mu.cwiseAbs2().maxCoeff())});
        if (options_.progress && !options_.progress(iterations_, step_.k))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(iterations_));

        const bool preliminary = state.space->preliminary();
        const bool settled = settling.after(step_, change, k_change, preliminary);
        // Growing is decided where the map is exact to rounding, which must not turn the decision: at the start
        // (begin()), at the first map that comes from another mesh's φ, and in the end.
        if ((from_elsewhere && options_.grow_first && iterations_ == 1) || (settled && options_.grow_last) ||
            (preliminary && iterations_ == kPreliminaryIterations)) {
            if (settled) {
                fallback = {step_, map_step_.snapshot()};
                grown_at = iterations_;
            }
            if (grow(state, mu)) {
                settling.restart();
                stride.restart();
                change = 1;
                state.direction = step_.direction;
                state.k = std::min(step_.k, kLargest);
                continue;
            }
        }
        if (settled) {
            converged_ = true;
            break;
        }
        if (grown_at > 0 && iterations_ - grown_at > kGrownIterations) break;
        stride.take(step_, change, state);
    }
    // A larger space in which nothing settles, or which makes the bound worse, was too large for the mesh.
    if (grown_at > 0 && (!converged_ || step_.merit < (1 - kWorse) * fallback.step.merit)) {
        converged_ = true;
        go_back_to(std::move(fallback), state);
    } else if (!converged_ && best.step.merit > step_.merit) {
        go_back_to(std::move(best), state);
    }
    state.direction = step_.direction;
    state.k = step_.k;
    state.acceleration = stride.known();
}

}  // namespace beltrami
