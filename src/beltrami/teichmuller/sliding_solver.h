#pragma once

#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/teichmuller/finish.h>
#include <beltrami/teichmuller/hamilton.h>
#include <beltrami/teichmuller/problem_solver.h>
#include <beltrami/teichmuller/sliding_problem.h>

namespace beltrami {

/// Solves problems some or all of whose boundary slides: start, iteration, last steps of the boundary, finish, bounds.
class SlidingSolver final : public ProblemSolver {
  public:
    SlidingSolver(std::unique_ptr<SlidingProblem> problem, const ExtremalOptions& options);

    /// Called again, it begins where the last one ended.
    ExtremalMap solve() override;
    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) override;

  private:
    const Surface& source() const { return problem_->source(); }
    bool begun() const { return chart_ != nullptr; }
    ExtremalMap settled_or_instead();
    ExtremalMap described(ExtremalMap instead, const std::string& end) const;
    ExtremalMap settled();
    ExtremalMap settled_from_given_start();
    void begin_without_start();
    void begin();
    void move(const std::vector<Complex>& images);
    HamiltonIteration iterate(HamiltonIteration::Options how);
    FoundMap settle(ExtremalMap& result);
    void finish(FoundMap found, ExtremalMap& result);
    QuadraticDifferential differential(const FoundMap& found) const;
    void record_bounds(const FoundMap& found, const std::optional<FoundMap>& before_evening, ExtremalMap& result) const;
    bool settle_conformal(int max_steps, int& steps);
    void solve_conformal(ExtremalMap& result);
    void open_conformal_folds(ExtremalMap& result);
    std::optional<TargetCurve> free_circle() const;
    void record_conditions(ExtremalMap& result) const;

    ExtremalOptions options_;
    std::unique_ptr<SlidingProblem> problem_;
    // From the first call on:
    ExtremalMap begun_;        // what is known before the iteration
    std::vector<int> curves_;  // of every loop
    std::optional<SlidingBoundary> boundary_;
    std::optional<SlidingMapStep> step_;
    AdmissibleDifferentials phi_;                      // its space goes to the state
    std::shared_ptr<const Chart> chart_;               // of phi_
    std::optional<CoefficientStep> coefficient_step_;  // none: no differential is admissible, the map is conformal
    HamiltonState state_;
};

}  // namespace beltrami
