#pragma once

#include <beltrami/teichmuller/pieces.h>
#include <beltrami/teichmuller/prepared_problem.h>
#include <beltrami/teichmuller/problem_solver.h>

namespace beltrami {

/// Solves problems whose pinned curves cut the surface into pieces: a solver for each, and one record of the whole.
class PiecewiseSolver final : public ProblemSolver {
  public:
    /// @param source kept by reference
    /// @param pieces of the prepared surface, at least one
    PiecewiseSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                    PreparedProblem prepared, std::vector<ProblemPiece> pieces);

    ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) override;
    ExtremalMap solve() override;

  private:
    std::string name(std::size_t piece) const;
    void merge(std::vector<ExtremalMap>& parts, ExtremalMap& whole) const;
    QuadraticDifferential differential_of_pieces(const std::vector<ExtremalMap>& parts,
                                                 const Eigen::VectorXcd& phi) const;
    void merge_bounds(const std::vector<ExtremalMap>& parts, ExtremalMap& whole) const;

    ExtremalOptions options_;
    BoundaryCondition boundary_;
    int outer_loop_;
    PreparedProblem prepared_;
    const Surface& source_;
    std::vector<ProblemPiece> pieces_;
    std::vector<ExtremalSolver> solvers_;
    std::vector<LoopPath> paths_;  // along which turns are counted
    int chart_factorizations_ = 0;
    int iterations_before_ = 0;  // those that progress has seen
    Eigen::VectorXcd map_;
};

}  // namespace beltrami
