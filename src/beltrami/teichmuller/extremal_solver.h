#pragma once

#include <memory>

#include <beltrami/base/public.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

class ProblemSolver;

/// The extremal map of one source for constraints that change: pins are dragged, also while the boundary slides, the
/// boundary is moved, and the map follows. The system's analysis, the charts and the space of differentials are kept,
/// for the vertices of the source that are prescribed stay the same; each new solve starts from the last φ, k and
/// factorisation.
///
///     ExtremalSolver solver(surface, constraints);
///     ExtremalMap first = solver.solve();
///     while (dragging) draw(solver.update(images, 4).map);
///     ExtremalMap last = solver.solve();
class ExtremalSolver {
  public:
    /// @param source  kept by reference
    /// @throw Error as extremal_map
    ExtremalSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options = {});
    ExtremalSolver(Surface&&, const Constraints&, const ExtremalOptions& = {}) = delete;
    ~ExtremalSolver();
    ExtremalSolver(ExtremalSolver&&) noexcept;

    /// What an update has reached.
    struct Update {
        const Eigen::VectorXcd& map;  ///< #V, valid until the next call
        double k;                     ///< of the last c-step
        double change;                ///< of the direction of φ in the last iteration
        int flipped;                  ///< samples that are flipped
        bool converged;
    };

    /// Moves the prescribed vertices and iterates a few times from where the solver stands. Vertices that slide stay on
    /// their curves, between the same prescribed ones; marks stay where they are.
    /// Edges that the first images nailed down have been split; others are not looked for.
    /// @param images         beside Constraints::prescribed.vertices; of what is inside arcs that slide not read
    /// @param max_iterations linear solves allowed, at least 1
    /// @throw Error bad_boundary for images that no one-to-one map has; the solver then stands where it stood
    Update update(const std::vector<Complex>& images, int max_iterations = 4);

    /// Iterates until all has settled, finishes and measures. The record is that of extremal_map.
    ExtremalMap solve();

  private:
    std::unique_ptr<ProblemSolver> solver_;
};

}  // namespace beltrami
