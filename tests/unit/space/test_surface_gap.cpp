#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <beltrami/generate/grids.h>
#include <beltrami/space/corner_angles.h>
#include <beltrami/space/surface_gap.h>
#include <beltrami/targets/mesh_target.h>

namespace beltrami {
namespace {

TEST(CornerAngle, HasItsDerivative) {
    Positions points(3, 3);
    points << 0.1, -0.2, 0.3, 1.4, 0.2, -0.1, 0.3, 0.9, 0.8;
    const std::array<int, 3> stencil{0, 1, 2};
    double sum = 0;
    for (int corner = 0; corner < 3; ++corner) {
        const CornerAngle at = corner_angle(stencil, corner, points);
        sum += at.angle;
        for (int i = 0; i < 3; ++i)
            for (int a = 0; a < 3; ++a) {
                const double h = 1e-6;
                Positions more = points, less = points;
                more(i, a) += h;
                less(i, a) -= h;
                const double slope =
                    (corner_angle(stencil, corner, more).angle - corner_angle(stencil, corner, less).angle) / (2 * h);
                EXPECT_NEAR(at.by[i][a], slope, 1e-8) << corner << " " << i << " " << a;
            }
    }
    EXPECT_NEAR(sum, 3.14159265358979324, 1e-14);
}

/// Vertices that are to blame, without anything that is remembered.
std::vector<int> strayed_afresh(const Mesh& mesh, const MeshTarget& target, const Positions& image, double distance) {
    return SurfaceGap(mesh, target).strayed(image, distance);
}

// What is remembered from one image to the next changes no answer.
TEST(SurfaceGap, IsAskedAgainWithTheSameAnswers) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const Mesh mesh = torus(2, 0.7, 24, 12, cells);
        const MeshTarget target(mesh);
        SurfaceGap gap(mesh, target);
        std::size_t far = 0;
        for (int round = 0; round < 6; ++round) {
            Positions image = mesh.positions;
            for (int v = 0; v < mesh.vertex_count(); ++v)
                for (int a = 0; a < 3; ++a) image(v, a) += 0.02 * round * std::sin(37.0 * v + 11 * a + round);
            for (int v = 0; v < mesh.vertex_count(); ++v)
                image.row(v) = target.nearest(image.row(v).transpose()).position;
            const std::vector<int> vertices = gap.strayed(image, 0.03);
            EXPECT_EQ(vertices, strayed_afresh(mesh, target, image, 0.03));
            if (round == 0) {
                EXPECT_TRUE(vertices.empty());
            }
            far += vertices.size();
        }
        EXPECT_GT(far, 0U);
    }
}

TEST(SurfaceGap, NamesTheVerticesAroundWhatIsFarAway) {
    Mesh mesh = rectangle(4, 4, 4, 4, Cells::triangles);
    const MeshTarget target(mesh);
    SurfaceGap gap(mesh, target);
    Positions image = Positions::Zero(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) image.row(v) = mesh.point(v);
    EXPECT_TRUE(gap.strayed(image, 1e-9).empty());
    const int corner = 0;
    const Eigen::RowVector3d moved = image.row(corner) + Eigen::RowVector3d(0.3, 0.3, 0);
    image.row(corner) = moved;  // the mesh's own corner is now .42 from the image
    const std::vector<int> vertices = gap.strayed(image, 0.1);
    EXPECT_TRUE(std::set<int>(vertices.begin(), vertices.end()).contains(corner));
    EXPECT_LT(vertices.size(), 6U);
    EXPECT_TRUE(gap.strayed(image, 0.5).empty());
}

}  // namespace
}  // namespace beltrami
