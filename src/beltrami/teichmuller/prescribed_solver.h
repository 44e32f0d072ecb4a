#pragma once

#include <beltrami/certificate/solution_bounds.h>
#include <beltrami/teichmuller/finish.h>
#include <beltrami/teichmuller/pole_choice.h>
#include <beltrami/teichmuller/prepared_problem.h>
#include <beltrami/teichmuller/problem_solver.h>

namespace beltrami {

/// Solves problems in which the whole boundary is prescribed.
class PrescribedSolver final : public ProblemSolver {
  public:
    /// @param source   kept by reference
    /// @param obstacle why pinned curves do not cut the surface although they would; else empty
    PrescribedSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                     PreparedProblem prepared, const std::string& obstacle);

    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) override;
    ExtremalMap solve() override;

  private:
    // Start.
    bool has_plain_start() const;
    void choose_start();
    void start_again();
    void take_slack(const Chart& chart);

    // Iteration.
    void run();
    void run_with_poles();
    void iterate_roughly();
    void iterate(const HamiltonIteration::Options& how);
    void iterate_once(const HamiltonIteration::Options& how);
    HamiltonIteration::Options adapted(HamiltonIteration::Options how) const;
    std::unique_ptr<DifferentialSpace> first_space() const;
    bool needs_poles() const;
    HamiltonIteration::Options rest_of_iteration() const;
    bool needs_degree() const;
    void raise_degree();

    // Finish.
    Finish finish();
    int evening_steps(const Finish& finish) const;
    int steps_where_uneven() const;
    bool even_out(Finish& finish, int steps);
    void compare_outlines();
    double estimate_with(const BoundaryCondition& other);

    // Record.
    ExtremalMap record() const;
    void record_homotopy(ExtremalMap& result) const;
    void record_bounds(ExtremalMap& result) const;
    void record_quadrilaterals(ExtremalMap& result) const;
    void narrow_by_quadratic_elements(ExtremalMap& result) const;
    SolutionBounds best_bounds(const Distortion& of_found) const;
    void record_corners(ExtremalMap& result) const;
    bool resolved(const BoundaryCorner& corner) const;

    ExtremalOptions options_;
    BoundaryCondition boundary_;
    Correspondence wanted_;
    PreparedProblem prepared_;
    const Surface& source_;
    ExtremalProblem problem_;
    std::vector<BoundaryCorner> corners_;
    PoleChoice poles_;
    std::vector<LoopPath> paths_;  // along which turns are counted
    Warnings warnings_;

    std::optional<SlackReport> slack_;
    BoundaryCondition given_boundary_;  // where there is slack
    std::optional<NoiseCost> noise_;

    HamiltonState state_;
    Eigen::VectorXcd start_;  // empty where φ is known from elsewhere
    FoundMap found_;
    std::optional<FoundMap> before_evening_;  // the last map before it was evened out, if it has no folds
    std::vector<Iteration> history_;
    bool converged_ = false, evened_ = false, folds_removed_ = false;
    int other_factorizations_ = 0;  // of the chart and the finish
    int earlier_iterations_ = 0;    // from a start that was given up
};

}  // namespace beltrami
