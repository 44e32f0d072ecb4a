#pragma once

#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/teichmuller/onto_differentials.h>
#include <beltrami/teichmuller/prepared_problem.h>
#include <beltrami/teichmuller/sliding_start.h>

namespace beltrami {

/// A source made ready for extremal maps whose boundary slides: no edge across it joins two boundary vertices, and it
/// has its circle domain.
class OntoProblem {
  public:
    /// @param source, options kept by reference
    /// @throw Error bad_mesh, bad_boundary, bad_option, not_solved
    OntoProblem(const Surface& source, const OntoOptions& options);
    OntoProblem(const OntoProblem&) = delete;

    /// The extremal map onto a target: start, iteration, bounds.
    ExtremalMapOnto solve(const TargetModel& target);

  private:
    static PreparedProblem prepare(const Surface& source, const OntoOptions& options);

    SlidingStart start(const TargetModel& target) const;
    void iterate(OntoDifferentials phi, SlidingBoundary& boundary, SlidingMapStep& step, ExtremalMapOnto& result) const;
    void settle_conformal(SlidingMapStep& step, ExtremalMapOnto& result) const;
    void record_loops(const std::vector<int>& curves, const SlidingBoundary& boundary, ExtremalMapOnto& result) const;
    void record_warnings(ExtremalMapOnto& result) const;

    const OntoOptions& options_;
    PreparedProblem prepared_;
    const Surface& source_;
    CircleDomainChart domain_;
    std::vector<int> marked_;  ///< in the order of the loops
};

}  // namespace beltrami
