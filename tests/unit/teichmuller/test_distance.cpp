#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/effort.h>
#include <beltrami/base/error.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/distance.h>

namespace beltrami {
namespace {

TEST(Distance, OfTwoRingsIsHalfTheLogarithmOfTheirModuli) {
    const Surface a(annulus(0.5, 1, 40)), b(annulus(0.3, 1, 40));
    const Distance d = teichmueller_distance(a, b);
    const double exact = 0.5 * std::log(std::log(0.3) / std::log(0.5));
    EXPECT_NEAR(d.distance, exact, 1e-3);
    EXPECT_LE(d.lower, d.distance);
    EXPECT_LE(d.distance, d.upper);
    EXPECT_TRUE(d.settled);
    const Distance one_way = teichmueller_distance(a, b, {}, {}, 0, false);
    EXPECT_NEAR(one_way.distance, exact, 2e-3);
}

TEST(Distance, OfAShapeToItsImageUnderASimilarityIsZero) {
    const Mesh mesh = annulus(0.5, 1, 40);
    Mesh moved = mesh;
    moved.positions = 3 * mesh.positions;
    const Distance d = teichmueller_distance(Surface(mesh), Surface(moved));
    EXPECT_LT(d.distance, 1e-6);
}

TEST(DistanceMatrix, OfAMeshToItselfIsZero) {
    Mesh mesh = annulus(0.2, 1, 24);
    const Surface ring(mesh);
    mesh.positions(0, 0) += 1e-3;
    const DistanceMatrix matrix = distance_matrix({ring, ring, Surface(mesh)});
    EXPECT_EQ(matrix.distance(0, 1), 0);
    EXPECT_EQ(matrix.upper(0, 1), 0);
    EXPECT_EQ(matrix.distance(0, 2), matrix.distance(1, 2));
    EXPECT_TRUE(matrix.unsettled.empty());
}

TEST(Distance, TakesMarksInOneDirectionOnly) {
    const Surface a(annulus(0.5, 1, 24)), b(annulus(0.3, 1, 24));
    Correspondence wanted;
    wanted.loops = {{0, 0}, {1, 1}};
    EXPECT_THROW(teichmueller_distance(a, b, wanted), Error);
    EXPECT_NO_THROW(teichmueller_distance(a, b, wanted, {}, 0, false));
}

TEST(DistanceMatrix, NamesShapesThatAreNotAlike) {
    std::vector<Surface> surfaces;
    surfaces.emplace_back(annulus(0.5, 1, 24));
    surfaces.emplace_back(disk(4));
    try {
        distance_matrix(surfaces);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), (std::vector<int>{0, 1}));
    }
}

TEST(DistanceMatrix, ChartsEveryShapeOnce) {
    std::vector<Surface> surfaces;
    DomainOptions options;
    options.edge_length = 0.15;
    for (const double radius : {0.15, 0.2, 0.25})
        surfaces.emplace_back(circle_domain({}, {{{0.45, 0}, radius}, {{-0.4, 0.1}, 0.2}}, options));
    const std::int64_t before = effort(Work::circle_chart);
    const DistanceMatrix matrix = distance_matrix(surfaces);
    EXPECT_EQ(effort(Work::circle_chart) - before, 3);
    for (int i = 0; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j) {
            const Distance alone = teichmueller_distance(surfaces[i], surfaces[j]);
            EXPECT_EQ(matrix.distance(i, j), alone.distance);
            EXPECT_EQ(matrix.lower(i, j), alone.lower);
        }
}

TEST(DistanceMatrix, OfRingsNeedsNoMap) {
    std::vector<Surface> surfaces;
    const std::vector<double> inner{0.3, 0.4, 0.6};
    for (const double radius : inner) surfaces.emplace_back(annulus(radius, 1, 40));
    const std::int64_t before = effort(Work::circle_chart);
    const DistanceMatrix matrix = distance_matrix(surfaces);
    EXPECT_EQ(effort(Work::circle_chart), before);
    for (int i = 0; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j) {
            EXPECT_NEAR(matrix.distance(i, j), 0.5 * std::log(std::log(inner[i]) / std::log(inner[j])), 2e-3);
            EXPECT_LE(matrix.lower(i, j), matrix.distance(i, j));
            EXPECT_LE(matrix.distance(i, j), matrix.upper(i, j));
            EXPECT_LT(matrix.upper(i, j) - matrix.lower(i, j), 0.02);
            EXPECT_EQ(matrix.distance(i, j), teichmueller_distance(surfaces[i], surfaces[j]).distance);
        }
    EXPECT_EQ(teichmueller_distance(Surface(disk(3)), Surface(disk(5))).upper, 0);
}

TEST(DistanceMatrix, NamesTheShapeThatHasNoChart) {
    std::vector<Surface> surfaces;
    surfaces.emplace_back(annulus(0.5, 1, 24));
    surfaces.emplace_back(annulus(0.4, 1, 24));
    Correspondence wanted;
    wanted.outer_loop = 7;
    try {
        distance_matrix(surfaces, wanted, {}, {}, {"one", "two"});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), (Where{Things::shapes, {0}}));
        EXPECT_EQ(std::string(error.what()).find("one: "), 0u);
    }
}

TEST(ClusterByDistance, MergesByMeanDistances) {
    // 0 and 2 are near, 1 and 3 are nearer; the mean of the four cross distances joins them.
    Eigen::MatrixXd d(4, 4);
    d << 0, 5, 2, 6,  //
        5, 0, 7, 1,   //
        2, 7, 0, 8,   //
        6, 1, 8, 0;
    const std::vector<Merge> merges = cluster_by_distance(d);
    ASSERT_EQ(merges.size(), 3u);
    EXPECT_EQ(merges[0].a, 1);
    EXPECT_EQ(merges[0].b, 3);
    EXPECT_EQ(merges[0].height, 1);
    EXPECT_EQ(merges[1].a, 0);
    EXPECT_EQ(merges[1].b, 2);
    EXPECT_EQ(merges[1].height, 2);
    EXPECT_EQ(merges[2].a, 4);
    EXPECT_EQ(merges[2].b, 5);
    EXPECT_DOUBLE_EQ(merges[2].height, (5 + 6 + 7 + 8) / 4.0);
    EXPECT_EQ(merges[2].size, 4);
}

TEST(ClusterByDistance, WeighsClustersByTheirSizes) {
    // {0, 1} joins 2 at the mean of 4 and 6; then 3 at the mean of three distances, not of two.
    Eigen::MatrixXd d(4, 4);
    d << 0, 1, 4, 9,  //
        1, 0, 6, 9,   //
        4, 6, 0, 12,  //
        9, 9, 12, 0;
    const std::vector<Merge> merges = cluster_by_distance(d);
    EXPECT_DOUBLE_EQ(merges[1].height, 5);
    EXPECT_DOUBLE_EQ(merges[2].height, 10);
}

TEST(ClusterByDistance, RefusesWhatIsNoMatrixOfDistances) {
    EXPECT_THROW(cluster_by_distance(Eigen::MatrixXd::Zero(2, 3)), Error);
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(2, 2);
    d(0, 1) = 1;
    EXPECT_THROW(cluster_by_distance(d), Error);
}

}  // namespace
}  // namespace beltrami
