#include <gtest/gtest.h>

#include <beltrami/report/dendrogram.h>

namespace beltrami {
namespace {

Eigen::MatrixXd distances() {
    Eigen::MatrixXd d(4, 4);
    d << 0, 5, 2, 6,  //
        5, 0, 7, 1,   //
        2, 7, 0, 8,   //
        6, 1, 8, 0;
    return d;
}

TEST(Dendrogram, OrdersShapesSoThatClustersAreRuns) {
    EXPECT_EQ(cluster_order(cluster_by_distance(distances())), (std::vector<int>{1, 3, 0, 2}));
}

TEST(Dendrogram, HasEveryNameEveryDistanceAndEveryJoin) {
    const std::string svg =
        render_dendrogram({"a<b", "second", "third", "fourth"}, distances(), cluster_by_distance(distances()));
    EXPECT_NE(svg.find(">a&lt;b<"), std::string::npos);
    EXPECT_EQ(svg.find("a<b"), std::string::npos);
    for (const char* text : {">second<", ">third<", ">fourth<", ">5.000<", ">8.000<"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    std::size_t joins = 0;
    for (std::size_t at = svg.find("fill=\"none\""); at != std::string::npos; at = svg.find("fill=\"none\"", at + 1))
        ++joins;
    EXPECT_EQ(joins, 3u);
    EXPECT_EQ(svg,
              render_dendrogram({"a<b", "second", "third", "fourth"}, distances(), cluster_by_distance(distances())));
}

}  // namespace
}  // namespace beltrami
