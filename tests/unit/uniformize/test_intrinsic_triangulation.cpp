#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <beltrami/base/constants.h>
#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {
namespace {

struct PlanarMesh {
    std::vector<Complex> points;
    FaceList triangles;

    std::vector<double> log_lengths() const {
        std::vector<double> result;
        for (int t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                result.push_back(std::log(std::abs(points[triangles[t][(k + 1) % 3]] - points[triangles[t][k]])));
        return result;
    }
    IntrinsicTriangulation intrinsic() const { return {triangles, static_cast<int>(points.size()), log_lengths()}; }
};

/// A sheared, jittered lattice: far from Delaunay.
PlanarMesh sheared_lattice(int n, double shear) {
    PlanarMesh mesh;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool inside = i > 0 && j > 0 && i < n && j < n;
            const double x = i + (inside ? jitter(random) : 0), y = j + (inside ? jitter(random) : 0);
            mesh.points.emplace_back(x + shear * y, y);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            mesh.triangles.add({a, b, c});
            mesh.triangles.add({a, c, d});
        }
    return mesh;
}

Eigen::VectorXd angle_sums(const IntrinsicTriangulation& t, const Eigen::VectorXd& u) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(t.vertex_count());
    for (int f = 0; f < t.triangle_count(); ++f)
        for (int k = 0; k < 3; ++k) sums[t.tail(t.previous(3 * f + k))] += t.angles(f, u).angles[k];
    return sums;
}

double area(const IntrinsicTriangulation& t) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(t.vertex_count());
    double sum = 0;
    for (int f = 0; f < t.triangle_count(); ++f)
        sum += 0.5 * std::exp(t.log_length(3 * f) + t.log_length(3 * f + 1)) * std::sin(t.angles(f, zero).angles[2]);
    return sum;
}

double worst_delaunay_violation(const IntrinsicTriangulation& t, const Eigen::VectorXd& u) {
    double worst = -kPi;
    for (int h = 0; h < t.halfedge_count(); ++h)
        if (t.twin(h) >= 0)
            worst = std::max(worst,
                             t.angles(h / 3, u).angles[h % 3] + t.angles(t.twin(h) / 3, u).angles[t.twin(h) % 3] - kPi);
    return worst;
}

void expect_consistent(const IntrinsicTriangulation& t) {
    for (int h = 0; h < t.halfedge_count(); ++h) {
        const int twin = t.twin(h);
        if (twin < 0) continue;
        EXPECT_EQ(t.twin(twin), h);
        EXPECT_EQ(t.tail(twin), t.head(h));
        EXPECT_EQ(t.log_length(twin), t.log_length(h));
    }
}

TEST(TriangleAngles, OfARightTriangle) {
    const TriangleAngles t = triangle_angles({std::log(3), std::log(4), std::log(5)});
    EXPECT_NEAR(t.angles[0], std::atan2(3, 4), 1e-15);
    EXPECT_NEAR(t.angles[1], std::atan2(4, 3), 1e-15);
    EXPECT_NEAR(t.angles[2], kPi / 2, 1e-15);
    EXPECT_NEAR(t.cotangents[0], 4.0 / 3, 1e-14);
    EXPECT_NEAR(t.cotangents[2], 0, 1e-15);
    EXPECT_FALSE(t.degenerate);
}

TEST(TriangleAngles, KeepTheirDigitsInANeedle) {
    const double narrow = 1e-7;  // isosceles, unit sides
    const TriangleAngles t = triangle_angles({std::log(2 * std::sin(narrow / 2)), 0, 0});
    EXPECT_NEAR(t.angles[0] / narrow, 1, 1e-13);
    EXPECT_NEAR(t.angles[0] + t.angles[1] + t.angles[2], kPi, 1e-15);
    EXPECT_NEAR(t.cotangents[0] * narrow, 1, 1e-13);
}

TEST(TriangleAngles, DependOnRatiosOnly) {
    const TriangleAngles small = triangle_angles({-5000, -5000.25, -4999.5});
    const TriangleAngles large = triangle_angles({5000, 4999.75, 5000.5});
    for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(small.angles[k], large.angles[k]);
    EXPECT_GT(small.angles[0], 0.1);
}

TEST(TriangleAngles, BeyondTheTriangleInequality) {
    const TriangleAngles t = triangle_angles({0, std::log(2.5), 0});
    EXPECT_TRUE(t.degenerate);
    EXPECT_EQ(t.angles[0], 0);
    EXPECT_EQ(t.angles[1], kPi);
    EXPECT_EQ(t.angles[2], 0);
    EXPECT_EQ(t.cotangents[1], 0);
}

TEST(IntrinsicTriangulation, UnfoldingFlipsMakeALatticeDelaunayAndLeaveTheSurface) {
    const PlanarMesh mesh = sheared_lattice(12, 3.7);
    IntrinsicTriangulation t = mesh.intrinsic();
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(t.vertex_count());
    ASSERT_GT(worst_delaunay_violation(t, zero), 0.5);
    const double area_before = area(t);
    const Eigen::VectorXd sums_before = angle_sums(t, zero);
    EXPECT_GT(t.make_delaunay(), 100);
    expect_consistent(t);
    EXPECT_LT(worst_delaunay_violation(t, zero), 1e-8);
    EXPECT_NEAR(area(t), area_before, 1e-11 * area_before);
    EXPECT_LT((angle_sums(t, zero) - sums_before).lpNorm<Eigen::Infinity>(), 1e-11);
    for (int h = 0; h < t.halfedge_count(); ++h) {  // a convex planar outline: lengths are distances
        const double distance = std::abs(mesh.points[t.head(h)] - mesh.points[t.tail(h)]);
        EXPECT_NEAR(std::exp(t.log_length(h)) / distance, 1, 1e-11);
    }
    EXPECT_EQ(t.make_delaunay(), 0);
}

TEST(IntrinsicTriangulation, PtolemyFlipsCommuteWithScaling) {
    const PlanarMesh mesh = sheared_lattice(10, 0.4);
    IntrinsicTriangulation t = mesh.intrinsic();
    t.make_delaunay();
    const IntrinsicTriangulation original = t;
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 1);
    Eigen::VectorXd u(t.vertex_count());
    for (double& value : u) value = normal(random);
    EXPECT_GT(t.make_delaunay(u), 20);
    expect_consistent(t);
    // The way back: the Delaunay triangulation of u = 0 is unique here, so the very lengths must return.
    EXPECT_GT(t.make_delaunay(Eigen::VectorXd::Zero(t.vertex_count())), 20);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(t.vertex_count());
    EXPECT_LT((angle_sums(t, zero) - angle_sums(original, zero)).lpNorm<Eigen::Infinity>(), 1e-11);
    for (int h = 0; h < t.halfedge_count(); ++h) {
        const double distance = std::abs(mesh.points[t.head(h)] - mesh.points[t.tail(h)]);
        EXPECT_NEAR(std::exp(t.log_length(h)) / distance, 1, 1e-11);
    }
}

TEST(IntrinsicTriangulation, PtolemyFlipHasTheLengthOfTheOtherDiagonal) {
    // A cyclic quadrilateral, barely on the side where the flip is due.
    FaceList triangles;
    triangles.add({0, 1, 2});
    triangles.add({0, 2, 3});
    const double sides[4] = {1.0, 1.3, 0.8, 1.1};
    const double p = sides[0] * sides[2] + sides[1] * sides[3];
    const double ab = sides[0] * sides[1] + sides[2] * sides[3], ad = sides[0] * sides[3] + sides[1] * sides[2];
    const double first = std::sqrt(p * ad / ab), second = std::sqrt(p * ab / ad);  // Ptolemy's second theorem
    const double diagonal = first * (1 + 1e-7);
    IntrinsicTriangulation t(triangles, 4,
                             {std::log(sides[0]), std::log(sides[1]), std::log(diagonal),  //
                              std::log(diagonal), std::log(sides[2]), std::log(sides[3])});
    ASSERT_EQ(t.make_delaunay(Eigen::VectorXd::Zero(4)), 1);
    bool found = false;
    for (int h = 0; h < 6; ++h) {
        if (t.twin(h) < 0) continue;
        EXPECT_EQ(t.tail(h) + t.head(h), 4);  // vertices 1 and 3
        EXPECT_NEAR(std::exp(t.log_length(h)), second * first / diagonal, 1e-14);
        found = true;
    }
    EXPECT_TRUE(found);
}

TEST(IntrinsicTriangulation, SplittingABoundaryEdgeDropsAPerpendicular) {
    PlanarMesh mesh;
    mesh.points = {{0, 0}, {4, 0}, {1, 0.5}, {2, -3}};
    mesh.triangles.add({0, 1, 2});
    mesh.triangles.add({1, 0, 3});
    IntrinsicTriangulation t = mesh.intrinsic();
    int boundary = -1;
    for (int h = 0; h < 6; ++h)
        if (t.tail(h) == 3 && t.head(h) == 1) boundary = h;
    ASSERT_GE(boundary, 0);
    ASSERT_LT(t.twin(boundary), 0);
    const double area_before = area(t);
    EXPECT_EQ(t.split_boundary(boundary), 4);
    EXPECT_EQ(t.vertex_count(), 5);
    EXPECT_EQ(t.triangle_count(), 3);
    EXPECT_EQ(t.tail(boundary), 3);
    EXPECT_EQ(t.head(boundary), 4);
    expect_consistent(t);
    EXPECT_NEAR(area(t), area_before, 1e-13);
    // The foot of vertex 0 on the line from 3 to 1.
    const Complex direction = (mesh.points[1] - mesh.points[3]) / std::abs(mesh.points[1] - mesh.points[3]);
    const double along = std::real(std::conj(direction) * (mesh.points[0] - mesh.points[3]));
    EXPECT_NEAR(std::exp(t.log_length(boundary)), along, 1e-13);
    const Eigen::VectorXd sums = angle_sums(t, Eigen::VectorXd::Zero(5));
    EXPECT_NEAR(sums[4], kPi, 1e-13);
    EXPECT_NEAR(t.angles(boundary / 3, Eigen::VectorXd::Zero(5)).angles[t.previous(boundary) % 3], kPi / 2, 1e-13);
}

}  // namespace
}  // namespace beltrami
