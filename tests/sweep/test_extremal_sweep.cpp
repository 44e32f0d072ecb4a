#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>

#include "problems/feasibility.h"
#include "problems/random_problem.h"
#include "support/extremal.h"

namespace beltrami::bench {
namespace {

class ExtremalSweep : public testing::TestWithParam<int> {};

TEST_P(ExtremalSweep, FindsAMapNoWorseThanTheBoundsAllow) {
    const Problem problem = random_problem(GetParam());
    SCOPED_TRACE(problem.statement);
    const double K_witness = dilatation(map_quality(problem, *problem.witness).max_mu);
    const ExtremalMap found = extremal_map(problem.mesh, problem.boundary);
    test::expect_sound(found);
    // Either settled, or the record says why not.
    EXPECT_TRUE(found.termination == Termination::converged || !found.warnings.empty());
    // A bound of K* is one of every map of the class. A split edge changes neither the witness nor its class.
    const std::vector<int> turns =
        relative_turns(problem, found.map.head(problem.mesh.vertex_count()), *problem.witness);
    if (std::all_of(turns.begin(), turns.end(), [](int t) { return t == 0; })) {
        EXPECT_LE(found.K_lower, K_witness * (1 + 1e-6));
    }
    for (const HoleTurns& hole : found.homotopy.holes) EXPECT_TRUE(hole.meaningful);
}
INSTANTIATE_TEST_SUITE_P(Seeds, ExtremalSweep, testing::Range(0, 20));

}  // namespace
}  // namespace beltrami::bench
