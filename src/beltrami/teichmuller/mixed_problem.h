#pragma once

#include <beltrami/differentials/singularities.h>
#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/teichmuller/mixed_start.h>
#include <beltrami/teichmuller/prepared_problem.h>

namespace beltrami {

/// The admissible differentials of a mixed problem, and the chart in which they are written down.
struct MixedDifferentials {
    Chart chart;  ///< to the circle domain of the source, or its own coordinates where it slides along straight sides
    std::unique_ptr<DifferentialSpace> space;  ///< null where there are none: the map is conformal
    Singularities singularities;               ///< where they vary quickly
    std::optional<int> expected_dimension;     ///< where theory says it and the space does not grow
    std::vector<std::string> warnings;
};

/// @param start of which the derivative says where vertices may move that are held to lines
/// @throw Error not_solved
MixedDifferentials mixed_differentials(const Surface& source, const CircleDomainChart& domain,
                                       const MixedBoundary& boundary, const Eigen::VectorXcd& start);

/// A source with mixed conditions made ready for its extremal map: no edge across it joins two boundary vertices, and
/// it has its circle domain.
class MixedProblem {
  public:
    /// @param source, options kept by reference
    /// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
    MixedProblem(const Surface& source, const MixedConditions& conditions, const ExtremalOptions& options);
    MixedProblem(const MixedProblem&) = delete;

    /// Start, iteration, bounds.
    MixedExtremalMap solve();

  private:
    static PreparedProblem prepare(const Surface& source, const MixedConditions& conditions,
                                   const ExtremalOptions& options);

    MixedStart start() const;
    std::vector<int> poles() const;
    void iterate(MixedDifferentials phi, SlidingBoundary& boundary, SlidingMapStep& step,
                 MixedExtremalMap& result) const;
    void settle_conformal(SlidingMapStep& step, MixedExtremalMap& result) const;
    void remove_folds(const SlidingBoundary& boundary, const Eigen::VectorXcd& nu, MixedExtremalMap& result) const;
    void record(const SlidingBoundary& boundary, MixedExtremalMap& result) const;

    const ExtremalOptions& options_;
    int outer_loop_;
    PreparedProblem prepared_;
    const Surface& source_;
    MixedBoundary boundary_;
    CircleDomainChart domain_;
};

}  // namespace beltrami
