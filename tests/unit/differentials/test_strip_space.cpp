#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/charts/chart.h>
#include <beltrami/differentials/strip_space.h>
#include <beltrami/generate/grids.h>

namespace beltrami {
namespace {

// Of a cylinder of radius R and height H the strip is the plane into which it is unrolled, by 1/R.
TEST(StripSpace, TheStripOfACylinderIsExact) {
    const double radius = 1.5, height = 2;
    const Surface surface(cylinder(radius, height, 40, 9));
    const AnnulusStrip strip = annulus_strip(surface, 0);
    const double chord = 40 * 2 * radius * std::sin(kTurn / 80);  // of the prism's whole turn
    EXPECT_NEAR(strip.height, height * kTurn / chord, 1e-10);
    const Chart chart = make_atlas(surface, strip.corners);
    EXPECT_EQ(chart.excluded_faces, 0);
    for (const Complex derivative : chart.derivatives) EXPECT_NEAR(std::abs(derivative), kTurn / chord, 1e-9);
    const FaceList& faces = surface.mesh.faces;
    const double up = surface.mesh.point(surface.topology.boundary_loops[0][0]).z() < 1 ? 1 : -1;
    for (int f = 0; f < faces.size(); ++f)
        for (int j = 0; j < 3; ++j) {
            const double z = surface.mesh.point(faces[f][j]).z();
            EXPECT_NEAR(strip.corners[faces.first_corner(f) + j].imag(), (up > 0 ? z : height - z) * kTurn / chord,
                        1e-9);
        }
}

TEST(StripSpace, IsOrthonormalOnTheStrip) {
    const double height = 1.3;
    const int along = 60, across = 400;
    Eigen::VectorXcd points(along * across);
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < across; ++j) points[i * across + j] = {kTurn * i / along, height * (j + 0.5) / across};
    const StripSpace space(5, height);
    ASSERT_EQ(space.size(), 11);
    const Eigen::MatrixXcd values = space.evaluate({points, Eigen::VectorXcd::Ones(points.size())});
    const Eigen::MatrixXcd gram = values.adjoint() * values * (kTurn * height / (along * across));
    EXPECT_LT((gram - Eigen::MatrixXcd::Identity(11, 11)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(StripSpace, ItsFunctionsAreHolomorphicAndPeriodic) {
    const StripSpace space(4, 0.8);
    const auto at = [&](Complex w) -> Eigen::RowVectorXcd {
        return space.evaluate({Eigen::VectorXcd::Constant(1, w), Eigen::VectorXcd::Ones(1)});
    };
    const Complex w(0.3, 0.2);
    EXPECT_LT((at(w + kTurn) - at(w)).cwiseAbs().maxCoeff(), 1e-12);
    const double h = 1e-5;
    const Eigen::RowVectorXcd across = at(w + h) - at(w - h), up = at(w + h * kI) - at(w - h * kI);
    EXPECT_LT((up - kI * across).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace beltrami
