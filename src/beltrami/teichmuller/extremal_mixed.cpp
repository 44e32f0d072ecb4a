#include <beltrami/teichmuller/extremal_mixed.h>

#include <beltrami/teichmuller/mixed_problem.h>
#include <beltrami/teichmuller/sliding_solver.h>

namespace beltrami {

ExtremalMap mixed_extremal_map(const Surface& source, const MixedConditions& conditions,
                               const ExtremalOptions& options) {
    return SlidingSolver(std::make_unique<MixedProblem>(source, conditions, options), options).solve();
}

}  // namespace beltrami
