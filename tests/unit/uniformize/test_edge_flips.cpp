#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <beltrami/uniformize/edge_flips.h>

namespace beltrami {
namespace {

struct Lattice {
    std::vector<Complex> points;
    FaceList triangles;

    /// Sheared, and its inner points moved: far from Delaunay.
    Lattice(int n, double shear) {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> jitter(-0.3, 0.3);
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const bool inside = i > 0 && j > 0 && i < n && j < n;
                const double x = i + (inside ? jitter(random) : 0), y = j + (inside ? jitter(random) : 0);
                points.emplace_back(x + shear * y, y);
            }
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
                triangles.add({a, b, c});
                triangles.add({a, c, d});
            }
    }
    IntrinsicTriangulation intrinsic() const {
        std::vector<double> lengths;
        for (int t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                lengths.push_back(std::log(std::abs(points[triangles[t][(k + 1) % 3]] - points[triangles[t][k]])));
        return {triangles, static_cast<int>(points.size()), lengths};
    }
    Complex place(const IntrinsicTriangulation& t, const IntrinsicPoint& p) const {
        Complex sum = 0;
        for (int k = 0; k < 3; ++k) sum += p.weights[k] * points[t.tail(3 * p.triangle + k)];
        return sum;
    }
};

TEST(EdgeFlips, UndoneInReverseTheyGiveTheTriangulationBack) {
    const Lattice lattice(9, 1.7);
    const IntrinsicTriangulation before = lattice.intrinsic();
    IntrinsicTriangulation t = before;
    const std::vector<EdgeFlip> flips = t.delaunay_flips();
    ASSERT_GT(flips.size(), 50U);
    for (auto flip = flips.rbegin(); flip != flips.rend(); ++flip) t.undo(*flip);
    for (int h = 0; h < t.halfedge_count(); ++h) {
        EXPECT_EQ(t.tail(h), before.tail(h));
        EXPECT_EQ(t.twin(h), before.twin(h));
        EXPECT_EQ(t.log_length(h), before.log_length(h));
    }
}

TEST(EdgeFlips, ClosedFormsAreCarriedAlong) {
    const Lattice lattice(9, 1.7);
    IntrinsicTriangulation t = lattice.intrinsic();
    const auto differences = [&](const IntrinsicTriangulation& of) {
        Eigen::MatrixXd forms(of.halfedge_count(), 2);
        for (int h = 0; h < of.halfedge_count(); ++h) {
            const Complex d = lattice.points[of.head(h)] - lattice.points[of.tail(h)];
            forms.row(h) << d.real(), d.imag();
        }
        return forms;
    };
    Eigen::MatrixXd forms = differences(t);
    carry_forms(t.delaunay_flips(), forms);
    EXPECT_LT((forms - differences(t)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(EdgeFlips, PointsStayWhereTheyAre) {
    const Lattice lattice(9, 1.7);
    const IntrinsicTriangulation before = lattice.intrinsic();
    IntrinsicTriangulation t = before;
    const std::vector<EdgeFlip> flips = t.delaunay_flips();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<IntrinsicPoint> points;
    for (int triangle = 0; triangle < t.triangle_count(); ++triangle) {
        points.push_back({triangle, {1, 0, 0}});
        points.push_back({triangle, {0, 0.5, 0.5}});
        for (int i = 0; i < 5; ++i) {
            double a = share(random), b = share(random);
            if (a + b > 1) a = 1 - a, b = 1 - b;
            points.push_back({triangle, {a, b, 1 - a - b}});
        }
    }
    const std::vector<IntrinsicPoint> found = before_flips(t, flips, points);
    int moved = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        EXPECT_LT(std::abs(lattice.place(before, found[p]) - lattice.place(t, points[p])), 1e-11);
        for (const double weight : found[p].weights) EXPECT_GE(weight, 0);
        moved += found[p].triangle != points[p].triangle;
    }
    EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace beltrami
