#include <gtest/gtest.h>

#include <beltrami/charts/greens_function.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

Complex plane_map(Complex z) {
    return z + 0.25 * z * z + Complex(0, 0.08) * z * z * z;
}

/// The image of the unit disk under plane_map, put on the sphere by inverse stereographic projection.
Mesh part_of_sphere(Mesh mesh) {
    const Eigen::VectorXcd z = complex_positions(mesh);
    mesh.positions.resize(z.size(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex w = plane_map(z[v]);
        const double n = std::norm(w);
        mesh.positions.row(v) << 2 * w.real() / (1 + n), 2 * w.imag() / (1 + n), (n - 1) / (1 + n);
    }
    return mesh;
}

BeltramiSolver dirichlet_solver(const Surface& source) {
    std::vector<Freedom> freedom(source.mesh.vertex_count(), Freedom::free);
    for (const int v : source.topology.boundary_loops[0]) freedom[v] = Freedom::fixed;
    BeltramiSolver solver(source, freedom, 1);
    solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()));
    return solver;
}

Eigen::VectorXcd disk_map(const Surface& source, ConjugateBy way) {
    int factorizations = 0;
    const auto g = disk_map_by_greens_function(source, dirichlet_solver(source), way, &factorizations);
    EXPECT_EQ(factorizations, way == ConjugateBy::system);
    return g.value_or(Eigen::VectorXcd());
}

/// Largest distance of g from the Möbius map of z that vanishes where g does.
double error_of(const Eigen::VectorXcd& g, const Eigen::VectorXcd& z) {
    int pole = 0;
    for (int v = 0; v < g.size(); ++v)
        if (std::abs(g[v]) < std::abs(g[pole])) pole = v;
    EXPECT_EQ(g[pole], Complex(0));
    const Eigen::VectorXcd exact = z.unaryExpr([a = z[pole]](Complex p) { return (p - a) / (1.0 - std::conj(a) * p); });
    const Complex turn = exact.dot(g);
    return (g - turn / std::abs(turn) * exact).cwiseAbs().maxCoeff();
}

TEST(GreensFunction, ConvergesToTheRiemannMapWithSecondOrder) {
    for (const ConjugateBy way : {ConjugateBy::flux, ConjugateBy::system}) {
        std::vector<double> errors;
        for (const int triangles : {8'000, 32'000}) {
            const Mesh flat = disk(disk_rings_for_triangles(triangles));
            const Surface surface(part_of_sphere(flat));
            const Eigen::VectorXcd g = disk_map(surface, way);
            ASSERT_EQ(g.size(), flat.vertex_count());
            errors.push_back(error_of(g, complex_positions(flat)));
            const Distortion measured = distortion(surface.operators, g);
            EXPECT_TRUE(measured.flipped.empty());
            EXPECT_LT(measured.mean, 0.75 / std::sqrt(triangles));
            for (const int v : surface.topology.boundary_loops[0]) EXPECT_NEAR(std::abs(g[v]), 1, 1e-12);
        }
        EXPECT_LT(errors[1], 5e-4);
        EXPECT_GT(std::log2(errors[0] / errors[1]), 1.5);
    }
}

TEST(GreensFunction, TakesTheSurfacesOwnMetric) {
    // The same shapes of faces, given as a metric of a mesh that lies otherwise.
    const Mesh flat = disk(disk_rings_for_triangles(8'000)), mesh = part_of_sphere(flat);
    Positions corners(mesh.faces.corner_count(), 3);
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = mesh.positions.row(mesh.faces.vertices()[c]);
    const Eigen::VectorXcd g = disk_map(Surface(flat, corners), ConjugateBy::flux),
                           expected = disk_map(Surface(mesh), ConjugateBy::flux);
    ASSERT_EQ(g.size(), expected.size());
    const Complex turn = expected.dot(g);
    EXPECT_LT((g - turn / std::abs(turn) * expected).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(GreensFunction, MapsQuads) {
    const int side = 70;
    Mesh mesh;
    mesh.positions.resize((side + 1) * (side + 1), 3);
    for (int i = 0; i <= side; ++i)
        for (int j = 0; j <= side; ++j) {
            const double x = 2.0 * i / side - 1, y = 2.0 * j / side - 1;
            mesh.positions.row(i * (side + 1) + j) << x, y, 0.3 * std::exp(-3 * (x * x + y * y)) + 0.2 * x * x;
        }
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const int a = i * (side + 1) + j;
            mesh.faces.add(std::array<int, 4>{a, a + side + 1, a + side + 2, a + 1});
        }
    const Surface surface(std::move(mesh));
    for (const ConjugateBy way : {ConjugateBy::flux, ConjugateBy::system}) {
        const Eigen::VectorXcd g = disk_map(surface, way);
        ASSERT_EQ(g.size(), surface.mesh.vertex_count());
        EXPECT_LT(distortion(surface.operators, g).mean, 0.02);
    }
}

TEST(GreensFunction, LeavesTinySurfacesToOthers) {
    const Surface surface(part_of_sphere(disk(2)));
    int factorizations = 0;
    EXPECT_FALSE(disk_map_by_greens_function(surface, dirichlet_solver(surface), ConjugateBy::flux, &factorizations));
    EXPECT_FALSE(round_disk_chart(surface).exact);
}

}  // namespace
}  // namespace beltrami
