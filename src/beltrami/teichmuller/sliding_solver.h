#pragma once

#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/starts/sliding_start.h>
#include <beltrami/teichmuller/admissible_differentials.h>
#include <beltrami/teichmuller/extremal_solver.h>
#include <beltrami/teichmuller/hamilton.h>
#include <beltrami/teichmuller/prepared_problem.h>

namespace beltrami {

/// ExtremalSolver of a source whose boundary slides: no edge across it joins two boundary vertices, and it has its
/// circle domain.
class SlidingSolver {
  public:
    /// @param source kept by reference
    /// @param target the model of the constraints' target, kept by reference; null: made here
    /// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
    SlidingSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                  const TargetModel* target = nullptr);
    SlidingSolver(const SlidingSolver&) = delete;

    /// The extremal map onto the target: start, iteration, bounds. Called again, it begins where the last one ended.
    ExtremalMap solve();
    /// As that of ExtremalSolver: iterates a few times, the start first.
    /// @param images of what is prescribed: nothing
    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations);

  private:
    static PreparedProblem prepare(const Surface& source, const Constraints& constraints,
                                   const ExtremalOptions& options);

    SlidingStart start() const;
    void begin();
    HamiltonIteration iterate(const HamiltonIteration::Options& how);
    void settle(ExtremalMap& result);
    void settle_conformal(ExtremalMap& result);
    void record_loops(ExtremalMap& result) const;
    void record_warnings(ExtremalMap& result) const;
    void record_places(ExtremalMap& result) const;

    ExtremalOptions options_;
    PreparedProblem prepared_;
    const Surface& source_;
    const Surface* target_surface_ = nullptr;          // where the target is one
    std::optional<CircleDomainChart> target_circles_;  // of it
    Correspondence wanted_;                            // with curves
    std::unique_ptr<TargetModel> own_target_;
    const TargetModel* target_;
    CircleDomainChart domain_;
    std::vector<int> marked_;  // in the order of the loops
    // From the first call on:
    ExtremalMap begun_;        // what is known before the iteration
    std::vector<int> curves_;  // of every loop
    std::optional<SlidingBoundary> boundary_;
    std::optional<SlidingMapStep> step_;
    AdmissibleDifferentials phi_;  // its space goes to the state
    std::optional<CoefficientStep> coefficient_step_;
    HamiltonState state_;
};

}  // namespace beltrami
