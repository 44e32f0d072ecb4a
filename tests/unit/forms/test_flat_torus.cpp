#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <beltrami/forms/flat_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/texture_map.h>

#include "support/cause_of.h"
#include "support/real_mesh.h"
#include "support/tori.h"
#include "support/voxels.h"

namespace beltrami {
namespace {

using test::parallel_and_meridian;

TorusMarking matrix(int a, int b, int c, int d) {
    TorusMarking m;
    m << a, b, c, d;
    return m;
}

TEST(TorusMarking, ReducedTauLiesInTheFundamentalDomain) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> real(-40, 40), log_imaginary(-6, 6);
    for (int trial = 0; trial < 300; ++trial) {
        const Complex tau(real(random), std::exp(log_imaginary(random)));
        const TorusMarking basis = reducing_basis(tau);
        EXPECT_EQ(basis.determinant(), 1);
        const Complex reduced = tau_in_basis(tau, basis);
        EXPECT_LE(std::abs(reduced.real()), 0.5 + 1e-9);
        EXPECT_GE(std::abs(reduced), 1 - 1e-9);
    }
}

TEST(TorusMarking, NearestOfAllIsNotBeatenBySearch) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> real(-2, 2), log_imaginary(-2, 2);
    for (int trial = 0; trial < 60; ++trial) {
        const Complex from(real(random), std::exp(log_imaginary(random))),
            to(real(random), std::exp(log_imaginary(random)));
        const TorusMarking nearest = nearest_marking(from, to);
        ASSERT_EQ(nearest.determinant(), 1);
        EXPECT_GT(nearest(0, 0) != 0 ? nearest(0, 0) : nearest(1, 0), 0);
        const double least = hyperbolic_distance(from, tau_in_basis(to, nearest));
        for (int a = -6; a <= 6; ++a)
            for (int b = -6; b <= 6; ++b)
                for (int c = -6; c <= 6; ++c)
                    for (int d = -6; d <= 6; ++d)
                        if (a * d - b * c == 1) {
                            EXPECT_GE(hyperbolic_distance(from, tau_in_basis(to, matrix(a, b, c, d))), least - 1e-9);
                        }
    }
    EXPECT_EQ(nearest_marking({0.2, 1.4}, {0.2, 1.4}), TorusMarking::Identity());
    EXPECT_EQ(nearest_marking({0, 1}, {0, 1}), TorusMarking::Identity());
}

TEST(FlatTorus, TauOfTorusOfRevolutionToSecondOrderWithinItsError) {
    double before = 0;
    for (const int nu : {16, 32, 64}) {
        const Surface surface(torus(2, 1, nu, nu / 2));
        const FlatTorus flat = flat_torus(surface);
        const Complex exact(0, std::sqrt(3.0));  // reduced: −1/(i/√3)
        const double error = std::abs(flat.tau - exact);
        if (before > 0) {
            EXPECT_GT(std::log2(before / error), 1.8);
        }
        before = error;
        EXPECT_GE(flat.tau_error, 0);
        EXPECT_TRUE(flat.distortion.flipped.empty());
        EXPECT_EQ(flat.generators.determinant() * flat.homology.intersections(0, 1), 1);
        // a goes round the tube, b along it.
        const auto paths = parallel_and_meridian(nu, nu / 2);
        EXPECT_EQ(torus_class(surface, flat, paths[1]).cwiseAbs(), Eigen::Vector2i(1, 0));
        EXPECT_EQ(std::abs(torus_class(surface, flat, paths[0])[1]), 1);
    }
}

TEST(FlatTorus, AFlatTorusIsItsOwnAndTheErrorVanishes) {
    // Corner points of a sheared rectangle as the metric of a grid that closes up: linear forms are exact.
    const int nu = 9, nv = 7;
    Mesh mesh = torus(2, 1, nu, nv);
    const Complex wanted(0.3, 1.7);
    Positions corners(mesh.faces.corner_count(), 2);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        for (int i = 0; i < 3; ++i) {
            const auto steps = [](int from, int to, int n) { return (to - from + n + n / 2) % n - n / 2; };
            const double u = static_cast<double>(steps(v[0] / nv, v[i] / nv, nu)) / nu,
                         w = static_cast<double>(steps(v[0] % nv, v[i] % nv, nv)) / nv;
            const Complex z = u + wanted * w;
            corners.row(3 * f + i) << z.real(), z.imag();
        }
    }
    const Surface surface(mesh, corners);
    const FlatTorus flat = flat_torus(surface);
    EXPECT_LT(std::abs(flat.tau - wanted), 1e-12);
    EXPECT_LT(flat.tau_error, 1e-12);
    EXPECT_LT(flat.distortion.max, 1e-11);
}

TEST(FlatTorus, TheLayoutCoversThePlaneOnce) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const Surface surface(torus(3, 1, 30, 12, cells));
        const FlatTorus flat = flat_torus(surface);
        double area = 0;
        for (int f = 0; f < surface.mesh.face_count(); ++f) {
            double face = 0;
            Complex middle = 0;
            const int first = surface.mesh.faces.first_corner(f), n = surface.mesh.faces.degree(f);
            const auto point = [&](int i) {
                const auto p = flat.layout.points.row(flat.layout.corners[first + i % n]);
                return Complex(p[0], p[1]);
            };
            for (int i = 0; i < n; ++i) {
                face += 0.5 * std::imag(std::conj(point(i)) * point(i + 1));
                middle += point(i) / static_cast<double>(n);
            }
            EXPECT_GT(face, 0);
            area += face;
            const double beta = middle.imag() / flat.tau.imag(), alpha = middle.real() - flat.tau.real() * beta;
            EXPECT_TRUE(alpha > -1e-12 && alpha < 1 + 1e-12 && beta > -1e-12 && beta < 1 + 1e-12);
        }
        EXPECT_NEAR(area, flat.tau.imag(), 1e-10);
        const Topology cut = topology(cut_along_seams(surface.mesh, flat.layout));
        EXPECT_EQ(cut.genus, 0);
        EXPECT_EQ(cut.components, 1);
        EXPECT_EQ(cut.boundary_loops.size(), 1U);
    }
}

/// A torus of long thin triangles by a sheared grid: diagonals that go around three cells.
Mesh sheared_torus(int nu, int nv) {
    Mesh mesh = torus(2, 1, nu, nv);
    FaceList faces;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const auto at = [&](int u, int v) { return (u % nu) * nv + (v % nv + nv) % nv; };
            // The lattice spanned by (1, 2) and (0, 1).
            const int a = at(i, j), b = at(i + 1, j + 2), c = at(i + 1, j + 3), d = at(i, j + 1);
            faces.add({a, b, c});
            faces.add({a, c, d});
        }
    mesh.faces = faces;
    return mesh;
}

TEST(FlatTorus, PlacesAreThoseOfTheLatticePointsAlsoThroughFlips) {
    for (const Mesh& mesh : {torus(2, 1, 24, 16), torus(2, 1, 24, 16, Cells::quads), sheared_torus(40, 24)}) {
        const Surface surface(mesh);
        const FlatTorus flat = flat_torus(surface);
        // Vertices come back to themselves, whatever lift they are asked at.
        Positions wanted = flat.lattice;
        for (Eigen::Index v = 0; v < wanted.rows(); ++v)
            wanted.row(v) += Eigen::RowVector2d(static_cast<double>(v % 5) - 2, static_cast<double>(v % 3));
        const std::vector<MeshPoint> places = places_on_torus(flat, wanted);
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            double at_itself = 0;
            for (int i = 0; i < 3; ++i)
                if (places[v].vertices[i] == v) at_itself += places[v].barycentric[i];
            EXPECT_NEAR(at_itself, 1, 1e-9) << v;
        }
        // Points that are carried back lie in faces whose corners are near them: no farther than the faces reach.
        std::mt19937 random(8);
        std::uniform_real_distribution<double> share(0, 1);
        Positions points(200, 2);
        for (Eigen::Index p = 0; p < points.rows(); ++p) points.row(p) << share(random), share(random);
        for (const MeshPoint& place : places_on_torus(flat, points)) {
            double sum = 0;
            for (int i = 0; i < 3; ++i) {
                EXPECT_GE(place.barycentric[i], 0);
                sum += place.barycentric[i];
                const auto face = mesh.faces[place.face];
                EXPECT_NE(std::find(face.begin(), face.end(), place.vertices[i]), face.end());
            }
            EXPECT_NEAR(sum, 1, 1e-12);
        }
    }
    EXPECT_GT(flat_torus(Surface(sheared_torus(40, 24))).flips, 100);
}

TEST(FlatTorus, DoesNotDependOnTheTriangulation) {
    // The polyhedron of a sheared grid is another one, but a cube torus is the same in any triangles.
    const Mesh quads = test::bar_with_holes(1);
    Mesh triangles = quads;
    FaceList faces;
    for (int f = 0; f < quads.face_count(); ++f) {
        const auto v = quads.faces[f];
        const int s = f % 2;
        faces.add({v[s], v[s + 1], v[s + 2]});
        faces.add({v[s + 2], v[(s + 3) % 4], v[s]});
    }
    triangles.faces = faces;
    EXPECT_LT(std::abs(flat_torus(Surface(quads)).tau - flat_torus(Surface(triangles)).tau), 1e-12);
}

TEST(FlatTorus, RealMesh) {
    const std::filesystem::path path = test::real_mesh("torus.obj");
    if (path.empty()) GTEST_SKIP() << "the real meshes are not here";
    const FlatTorus flat = flat_torus(Surface(read_mesh(path).mesh));
    EXPECT_NEAR(flat.tau.real(), 0, 2e-3);
    EXPECT_NEAR(flat.tau.imag(), 3.88448, 2e-3);
    EXPECT_TRUE(flat.distortion.flipped.empty());
}

TEST(FlatTorus, RefusesOtherSurfaces) {
    for (const Mesh& mesh : {icosahedral_sphere(1), test::bar_with_holes(2), cylinder(1, 1, 8, 2)})
        EXPECT_EQ(test::cause_of([&] { flat_torus(Surface(mesh)); }), Cause::bad_mesh);
}

TEST(FlatTorus, MarkingsByPaths) {
    const Surface a(torus(2, 1, 18, 12)), b(torus(2, 1, 20, 15));
    const FlatTorus flat_a = flat_torus(a), flat_b = flat_torus(b);
    const auto paths_a = parallel_and_meridian(18, 12), paths_b = parallel_and_meridian(20, 15);
    const TorusMarking natural = marking_of_paths(a, flat_a, paths_a, b, flat_b, paths_b);
    EXPECT_EQ(natural.determinant(), 1);
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(natural * torus_class(a, flat_a, paths_a[i]), torus_class(b, flat_b, paths_b[i]));
    // Meridian to parallel and back turns the orientation round.
    EXPECT_EQ(test::cause_of([&] {
                  marking_of_paths(a, flat_a, paths_a, b, flat_b, {paths_b[1], paths_b[0]});
              }),
              Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] {
                  marking_of_paths(a, flat_a, {paths_a[0], paths_a[0]}, b, flat_b, paths_b);
              }),
              Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
