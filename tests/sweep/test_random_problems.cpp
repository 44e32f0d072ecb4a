#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <beltrami/mesh/topology.h>

#include "problems/feasibility.h"
#include "problems/random_problem.h"

namespace beltrami::bench {
namespace {

class RandomProblems : public testing::TestWithParam<int> {};

TEST_P(RandomProblems, HaveAWitness) {
    for (int seed = 40 * GetParam(); seed < 40 * (GetParam() + 1); ++seed) {
        const Problem problem = random_problem(seed);
        EXPECT_EQ(infeasibility(problem), "") << seed;
        const MapQuality quality = map_quality(problem, *problem.witness);
        EXPECT_EQ(quality.flipped, 0) << seed;
        EXPECT_LT(quality.max_mu, 0.95) << seed;
        EXPECT_GT(quality.max_mu, 0.05) << seed << " " << problem.statement;
        EXPECT_EQ(quality.pin_error, 0) << seed;
    }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomProblems, testing::Range(0, 6));

TEST(RandomProblem, IsTheSameForTheSameSeed) {
    const Problem a = random_problem(7), b = random_problem(7), c = random_problem(8);
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.boundary.images, b.boundary.images);
    EXPECT_NE(a.statement + std::to_string(a.mesh.face_count()), c.statement + std::to_string(c.mesh.face_count()));
}

TEST(RandomProblem, CoversHolesMeshesAndDilatations) {
    std::set<std::size_t> holes;
    std::set<std::string> meshes;
    int wild = 0, mild = 0;
    for (int seed = 1000; seed < 1060; ++seed) {
        const Problem problem = random_problem(seed);
        holes.insert(topology(problem.mesh).boundary_loops.size() - 1);
        meshes.insert(problem.statement.substr(problem.statement.find(',')));
        const double mu = map_quality(problem, *problem.witness).max_mu;
        wild += mu > 0.8;
        mild += mu < 0.5;
    }
    EXPECT_EQ(holes.size(), 6u);
    EXPECT_EQ(meshes.size(), 6u);
    EXPECT_GT(wild, 5);
    EXPECT_GT(mild, 5);
}

}  // namespace
}  // namespace beltrami::bench
