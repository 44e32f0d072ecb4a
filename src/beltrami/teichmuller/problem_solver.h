#pragma once

#include <beltrami/teichmuller/extremal_solver.h>

namespace beltrami {

/// What stands behind ExtremalSolver, one for each kind of problem; each keeps where it stands from call to call.
class ProblemSolver {
  public:
    ProblemSolver() = default;
    ProblemSolver(const ProblemSolver&) = delete;
    virtual ~ProblemSolver() = default;

    /// As those of ExtremalSolver; a refused update changes nothing.
    /// @pre max_iterations ≥ 1
    virtual ExtremalSolver::Update update(const std::vector<Complex>& images, int max_iterations) = 0;
    virtual ExtremalMap solve() = 0;
};

}  // namespace beltrami
