#pragma once

#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

/// Freedoms of Dirichlet's problem: inner vertices are free, all others are fixed.
std::vector<Freedom> dirichlet_freedoms(const Surface& source);

/// A solver that fixes exactly the boundary, factorised for harmonic maps.
BeltramiSolver dirichlet_solver(const Surface& source);

}  // namespace beltrami
