#include <beltrami/differentials/sphere_space.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <beltrami/generate/sphere.h>
#include <beltrami/sphere/atlas.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {
namespace {

struct OnSphere {
    Surface surface;
    Chart chart;
    std::vector<int> landmarks{0, 3, 5, 8, 11};
    SamplePoints means;
    SphereSpace space;
    explicit OnSphere(int levels)
        : surface(icosahedral_sphere(levels)),
          chart(make_atlas(surface, atlas::corner_places(surface.mesh.faces, surface.mesh.positions))),
          means(conical_points(surface, chart, landmarks, 3)),
          space(surface, chart, surface.mesh.positions(landmarks, Eigen::all), means) {}
};

TEST(SphereSpace, IsTheSameDifferentialInBothCharts) {
    const OnSphere on(3);
    // ψ dz² = ψ' dζ², ζ = 1/z: at points near the equator.
    ChartPoints north{Eigen::VectorXcd(5), Eigen::VectorXcd::Ones(5)}, south = north;
    for (int i = 0; i < 5; ++i) {
        const Complex z = std::polar(0.9 + 0.05 * i, 0.4 + i);
        north.positions[i] = z;
        south.positions[i] = atlas::kSouth + 1.0 / z;
        south.derivatives[i] = -1.0 / (z * z);
    }
    const Eigen::MatrixXcd a = on.space.evaluate(north), b = on.space.evaluate(south);
    // Generators of a chart may differ by a factor that is the same for all points.
    for (int j = 0; j < a.cols(); ++j) EXPECT_LT((a.col(j) - b.col(j)).norm(), 1e-12 * a.col(j).norm());
    EXPECT_EQ(on.space.size(), 2);
}

TEST(SphereSpace, HasSimplePolesAtTheLandmarksAndIsHolomorphicElsewhere) {
    const OnSphere on(3);
    const auto residue = [&](Complex centre, double radius) {
        constexpr int kPoints = 64;
        ChartPoints circle{Eigen::VectorXcd(kPoints), Eigen::VectorXcd::Ones(kPoints)};
        for (int i = 0; i < kPoints; ++i)
            circle.positions[i] = centre + std::polar(radius, 2 * std::numbers::pi * i / kPoints);
        const Eigen::MatrixXcd values = on.space.evaluate(circle);
        Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(values.cols());
        for (int i = 0; i < kPoints; ++i)
            sum += (circle.positions[i] - centre) / static_cast<double>(kPoints) * values.row(i).transpose();
        return sum;
    };
    int poles = 0;
    for (const int v : on.landmarks) {
        const Eigen::Vector3d point = on.surface.mesh.point(v);
        const Complex at = atlas::place(point, point.z() < 0);
        const double small = residue(at, 1e-3).norm();
        EXPECT_GT(small, 1e-2);
        EXPECT_NEAR(residue(at, 1e-2).norm(), small, 1e-9 * small);
        ++poles;
    }
    EXPECT_EQ(poles, 5);
    EXPECT_LT(residue(atlas::place(on.surface.mesh.point(20), on.surface.mesh.point(20).z() < 0), 1e-2).norm(), 1e-12);
}

TEST(SphereSpace, IsOrthonormalInTheWeakenedProduct) {
    const OnSphere on(4);
    const int samples = on.surface.operators.sample_count();
    std::vector<char> divided(static_cast<std::size_t>(samples), 0);
    for (const int s : on.means.samples) divided[s] = 1;
    const Eigen::MatrixXcd values = on.space.evaluate({on.chart.positions, on.chart.derivatives}),
                           at_points = on.space.evaluate(on.means.points);
    Eigen::MatrixXcd gram = Eigen::MatrixXcd::Zero(values.cols(), values.cols());
    const auto add = [&](const auto& row, double weight) {
        gram += weight / row.cwiseAbs().sum() * row.adjoint() * row;
    };
    const std::vector<double>& areas = on.surface.operators.weights;
    for (int s = 0; s < samples; ++s)
        if (!divided[s]) add(values.row(s), areas[s]);
    for (std::size_t i = 0; i < on.means.samples.size(); ++i) {
        const auto point = static_cast<Eigen::Index>(i);
        add(at_points.row(point), on.means.weights[point] * areas[on.means.samples[i]]);
    }
    EXPECT_LT((gram - Eigen::MatrixXcd::Identity(2, 2)).norm(), 0.01);
}

TEST(ConicalPoints, IntegrateTheInverseDistanceFromALandmarkExactly) {
    // One triangle of a plane quad mesh stands for all: ∫ 1/|z − a| over the star of a vertex.
    const OnSphere on(2);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(on.surface.operators.sample_count());
    for (std::size_t i = 0; i < on.means.samples.size(); ++i)
        sums[on.means.samples[i]] += on.means.weights[static_cast<Eigen::Index>(i)];
    int with_points = 0;
    for (const double sum : sums) {
        if (sum == 0) continue;
        EXPECT_NEAR(sum, 1, 1e-14);
        ++with_points;
    }
    EXPECT_GT(with_points, 5 * 5);
    // On a triangle with its apex at a: ∫ 1/r = ∫∫ 2A x / (x |e(y)|) dx dy = 2A ∫ dy/|e(y)|.
    const int face = on.means.samples[0];
    const auto v = on.surface.mesh.faces[face];
    // In the chart with the face's middle in its centre the face is a straight triangle.
    ASSERT_LT(on.chart.corners[3 * face].real(), atlas::kSouth / 2);
    const Complex middle = on.chart.corners.segment<3>(3 * face).mean();
    const auto centred = [&](Complex z) { return (z - middle) / (1.0 + std::conj(middle) * z); };
    const auto at_corner = [&](int j) { return centred(on.chart.corners[3 * face + j % 3]); };
    Complex pole = 0;
    int corner = 0;
    for (int j = 0; j < 3; ++j)
        if (std::find(on.landmarks.begin(), on.landmarks.end(), v[j]) != on.landmarks.end()) {
            corner = j;
            pole = at_corner(j);
        }
    double rule = 0, exact = 0;
    bool has_pole = std::find(on.landmarks.begin(), on.landmarks.end(), v[corner]) != on.landmarks.end();
    ASSERT_TRUE(has_pole);
    for (std::size_t i = 0; i < on.means.samples.size() && on.means.samples[i] == face; ++i)
        rule += on.means.weights[static_cast<Eigen::Index>(i)] /
                std::abs(centred(on.means.points.positions[static_cast<Eigen::Index>(i)]) - pole);
    constexpr int kPieces = 2000;
    for (int i = 0; i < kPieces; ++i) {
        const double y = (i + 0.5) / kPieces;
        const Complex edge = (1 - y) * at_corner(corner + 1) + y * at_corner(corner + 2) - pole;
        exact += 2 / std::abs(edge) / kPieces;
    }
    EXPECT_NEAR(rule, exact, 2e-3 * exact);
}

TEST(ConicalPoints, OfQuadsBelongToTheirQuarter) {
    Mesh cube;
    cube.positions.resize(8, 3);
    for (int v = 0; v < 8; ++v) cube.positions.row(v) << (v & 1 ? 1 : -1), (v & 2 ? 1 : -1), (v & 4 ? 1 : -1);
    for (const auto& f : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        cube.faces.add(f);
    const Surface surface(cube);
    Positions points = cube.positions;
    points.rowwise().normalize();
    const Chart chart = make_atlas(surface, atlas::corner_places(cube.faces, points));
    const std::vector<int> landmarks{0};
    const SamplePoints means = conical_points(surface, chart, landmarks, 0);
    EXPECT_EQ(means.samples.size(), 3u * 4 * 18);
    // Their mean is near the sample.
    for (int s : {0, 1, 2, 3}) {
        Complex mean = 0;
        for (std::size_t i = 0; i < means.samples.size(); ++i)
            if (means.samples[i] == s)
                mean +=
                    means.weights[static_cast<Eigen::Index>(i)] * means.points.positions[static_cast<Eigen::Index>(i)];
        EXPECT_LT(std::abs(mean - chart.positions[s]), 0.1);
    }
}

}  // namespace
}  // namespace beltrami
