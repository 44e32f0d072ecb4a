#include <beltrami/teichmuller/extremal_mixed.h>

#include <beltrami/teichmuller/mixed_problem.h>

namespace beltrami {

MixedExtremalMap mixed_extremal_map(const Surface& source, const MixedConditions& conditions,
                                    const ExtremalOptions& options) {
    return MixedProblem(source, conditions, options).solve();
}

}  // namespace beltrami
