#include <beltrami/teichmuller/extremal_mixed.h>

#include <beltrami/teichmuller/mixed_in_chart.h>

namespace beltrami {

ExtremalMap mixed_extremal_map(const Surface& source, const MixedConditions& conditions,
                               const ExtremalOptions& options) {
    return mixed_solver(source, conditions, options)->solve();
}

}  // namespace beltrami
