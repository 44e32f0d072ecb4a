#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

TEST(RoundDisk, ARoundDiskIsItsOwnChart) {
    Mesh mesh = disk(12);
    mesh.positions = (3e5 * mesh.positions).rowwise() + Eigen::RowVector2d(7e5, -2e5);
    const Chart chart = round_disk_chart(Surface(mesh));
    EXPECT_TRUE(chart.exact);
    EXPECT_LT((chart.vertices - complex_positions(disk(12))).cwiseAbs().maxCoeff(), 1e-9);
    for (const Complex d : chart.derivatives) EXPECT_NEAR(std::abs(d - 1 / 3e5), 0, 1e-14);
}

/// The disk's image under F must come back to the disk up to a Möbius map; returns the largest error after the best
/// one.
double error_of(int triangles, bool in_space, int sliding_steps) {
    const Mesh flat = disk(disk_rings_for_triangles(triangles));
    const Eigen::VectorXcd z = complex_positions(flat);
    const auto F = [](Complex w) { return w + 0.25 * w * w + Complex(0, 0.08) * w * w * w; };
    Mesh mesh = flat;
    if (in_space) mesh.positions.resize(flat.vertex_count(), 3);
    for (int v = 0; v < flat.vertex_count(); ++v) {
        const Complex w = F(z[v]);
        if (in_space) {  // inverse stereographic projection: conformal
            const double n = std::norm(w);
            mesh.positions.row(v) << 2 * w.real() / (1 + n), 2 * w.imag() / (1 + n), (n - 1) / (1 + n);
        } else {
            mesh.positions.row(v) << w.real(), w.imag();
        }
    }
    // Faces seen from outside the sphere are counter-clockwise for the lower half only if mirrored: keep the disk's
    // own.
    RoundDiskOptions options;
    options.sliding_steps = sliding_steps;
    const Surface surface(mesh);
    const Chart chart = round_disk_chart(surface, options);
    EXPECT_EQ(chart.excluded_faces, 0);
    EXPECT_FALSE(chart.exact);
    for (const int v : surface.topology.boundary_loops[0]) EXPECT_NEAR(std::abs(chart.vertices[v]), 1, 1e-12);
    // g(z) = e^{it}(z−a)/(1−āz): a from where g vanishes, t from the boundary.
    int nearest = 0;
    for (int v = 0; v < flat.vertex_count(); ++v)
        if (std::abs(chart.vertices[v]) < std::abs(chart.vertices[nearest])) nearest = v;
    Complex a = z[nearest];
    for (int step = 0; step < 60; ++step) {  // Gauss-Newton on a by the mean of the residual at all vertices
        Complex t = 0, mean = 0;
        for (int v = 0; v < flat.vertex_count(); ++v)
            t += chart.vertices[v] * std::conj((z[v] - a) / (1.0 - std::conj(a) * z[v]));
        t /= std::abs(t);
        for (int v = 0; v < flat.vertex_count(); ++v)
            mean += chart.vertices[v] * std::conj(t) - (z[v] - a) / (1.0 - std::conj(a) * z[v]);
        a -= mean / static_cast<double>(flat.vertex_count());
    }
    Complex t = 0;
    for (int v = 0; v < flat.vertex_count(); ++v)
        t += chart.vertices[v] * std::conj((z[v] - a) / (1.0 - std::conj(a) * z[v]));
    t /= std::abs(t);
    double error = 0;
    for (int v = 0; v < flat.vertex_count(); ++v)
        error = std::max(error, std::abs(chart.vertices[v] - t * (z[v] - a) / (1.0 - std::conj(a) * z[v])));
    return error;
}

TEST(RoundDisk, ConvergesToTheRiemannMapWithSecondOrder) {
    for (const bool in_space : {false, true}) {
        // Both below the size from which Green's function is taken, whose order has a test of its own.
        const double coarse = error_of(1500, in_space, 0), fine = error_of(6000, in_space, 0);
        EXPECT_LT(fine, 5e-4) << in_space;
        EXPECT_GT(std::log2(coarse / fine), 1.5) << in_space;
        EXPECT_LT(error_of(24000, in_space, 0), 5e-4) << in_space;
    }
}

TEST(RoundDisk, SlidingStepsReachTheSameMap) {
    EXPECT_LT(error_of(6000, false, 5), 6e-3);
    EXPECT_LT(error_of(6000, true, 5), 6e-3);
}

TEST(RoundDisk, RefusesOtherTopologies) {
    EXPECT_THROW(round_disk_chart(Surface(annulus(0.3, 1.0, 30))), Error);
}

TEST(CentreInDisk, BringsTheMeanToZeroByAMoebiusMap) {
    Eigen::VectorXcd points = complex_positions(disk(6));
    points = points.unaryExpr([](Complex z) { return (z + Complex(0.5, 0.3)) / (1.0 + Complex(0.5, -0.3) * z); });
    centre_in_disk(points, Eigen::VectorXd::Ones(points.size()));
    EXPECT_LT(std::abs(points.mean()), 1e-12);
    for (int v = 0; v < 36; ++v) EXPECT_NEAR(std::abs(points[points.size() - 1 - v]), 1, 1e-12);
}

}  // namespace
}  // namespace beltrami
