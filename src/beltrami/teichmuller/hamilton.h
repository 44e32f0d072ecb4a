#pragma once

#include <any>
#include <limits>
#include <memory>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/linear/anderson.h>
#include <beltrami/solve/map_step.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami {

/// Where the iteration stands: a space of differentials, φ in it, and k. No space: nothing is known yet.
struct HamiltonState {
    std::shared_ptr<const DifferentialSpace> space;
    Eigen::VectorXcd direction;  ///< coefficients of φ, of length 1
    double k = 0;
    /// What is known of how f-step and c-step together change them: on a finer mesh it is nearly the same. May be null.
    std::shared_ptr<AndersonAcceleration> acceleration = nullptr;
};

/// Hamilton's iteration, the one loop for every topology: the c-step finds φ and k of a map, the f-step the map with
/// the coefficient k conj(φ)/|φ|, until both settle. Anderson acceleration on (direction of φ, k).
class HamiltonIteration {
  public:
    struct Options {
        double tolerance = 1e-8;    ///< of φ's direction
        double k_tolerance = 1e-8;  ///< of k
        int max_iterations = 60;
        /// The c-step is solved to this part of the change of φ in the last iteration.
        double step_below_change = 0.01;
        /// … and the f-step to this part of it.
        double solve_below_change = 1e-3;
        /// All has settled too once the square of the change of φ and the part by which k changes are below this part
        /// of the bracket, which no further steps would narrow; unless the bracket is below `tight`, that of smooth
        /// data, for which k is wanted to all digits. 0: never.
        double within_bracket = 0, tight = 0;
        /// All has settled too once the bracket will stay wider than this, as part of K: of second order in φ, it can
        /// become narrower by the square of φ's change.
        double widest = std::numeric_limits<double>::infinity();
        double growth = 1e-5;
        /// The c-step in a larger space is solved to this change of φ, k then to its square.
        double growing_step = 0;
        /// All has settled too once k stays and the bracket is narrow for so many steps, though φ still moves.
        int quiet_steps = 6;
        int anderson_window = 5;
        /// Acceleration begins once φ changes by less than this. Near singular φ early steps lead astray.
        double accelerate_below = 0.1;
        /// When a larger space is tried, besides at a start from nothing: with the first map that comes from another
        /// problem's state, and once all has settled.
        bool grow_first = true, grow_last = true;
        Progress progress;
    };

    /// All are kept by reference.
    HamiltonIteration(MapStep& map_step, CoefficientStep& coefficient_step, Options options);

    /// Runs from @p state, or where that knows nothing from the c-step of the map as it stands in @p smallest, a first
    /// space. The map of the f-step is then the one found; state.space is the last space used; last_step() belongs to
    /// it.
    /// @throw Error cancelled, not_solved
    void run(HamiltonState& state, std::unique_ptr<DifferentialSpace> smallest);

    /// The c-step of the map found.
    const CoefficientStep::Result& last_step() const { return step_; }
    const std::vector<Iteration>& history() const { return history_; }
    int iterations() const { return iterations_; }
    bool converged() const { return converged_; }

  private:
    double first_step() const;
    double growing_step() const;
    bool grow(HamiltonState& state, const Eigen::VectorXcd& mu);
    void begin(HamiltonState& state, std::unique_ptr<DifferentialSpace> smallest);
    Eigen::VectorXcd step_from(const HamiltonState& state, double last_change);

    /// A c-step and the map that it was made of.
    struct Kept {
        CoefficientStep::Result step;
        std::any map;
    };
    void go_back_to(Kept kept, const HamiltonState& state);

    MapStep& map_step_;
    CoefficientStep& coefficient_step_;
    Options options_;
    CoefficientStep::Result step_;
    std::vector<Iteration> history_;
    int iterations_ = 0;
    bool converged_ = false;
};

/// Width of the bracket between the k of a c-step and its Reich-Strebel bound, as part of K.
double bracket(const CoefficientStep::Result& step);

/// ν = k conj(φ)/|φ|, 0 where φ says nothing.
Eigen::VectorXcd teichmueller_coefficient(double k, const Eigen::VectorXcd& phi);

}  // namespace beltrami
