#pragma once

#include <memory>

#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

class PiecewiseSolver;
class SlidingSolver;

/// The extremal map of one source for boundary values that change: pins are dragged, the boundary is moved, and the
/// map follows. The system's analysis, the chart and the space of differentials are kept; each new solve starts from
/// the last φ, k and factorisation.
///
///     ExtremalSolver solver(surface, boundary);
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
        int flipped;                  ///< samples that are turned over
        bool converged;
    };

    /// Moves the prescribed vertices and iterates a few times from where the solver stands.
    /// Edges that the first images nailed down have been split; others are not looked for.
    /// @param images         beside the vertices of the boundary condition
    /// @param max_iterations linear solves allowed, at least 1
    Update update(const std::vector<Complex>& images, int max_iterations = 4);

    /// Iterates until all has settled, finishes and measures. The record is that of extremal_map.
    ExtremalMap solve();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
    std::unique_ptr<PiecewiseSolver> pieces_;  ///< instead, where pinned curves cut the surface
    std::unique_ptr<SlidingSolver> sliding_;   ///< instead, where boundaries slide
};

}  // namespace beltrami
