#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/uniformize/conformal_equivalence.h>
#include <beltrami/uniformize/flatten.h>
#include <beltrami/uniformize/flatten_layout.h>

#include "support/meshes.h"
#include "support/real_mesh.h"

namespace beltrami {
namespace {

// ---- surfaces -------------------------------------------------------------------------------------------------------

/// A placed_disk of rings: 1 + 3·rings·(rings + 1) vertices, the boundary last, each at (radius ≤ 1, direction).
Mesh placed_disk(int rings, const std::function<Eigen::Vector3d(double, double)>& place) {
    Mesh mesh;
    mesh.positions.resize(1 + 3 * rings * (rings + 1), 3);
    mesh.positions.row(0) = place(0, 0);
    const auto index = [](int ring, int k) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring); };
    for (int ring = 1; ring <= rings; ++ring)
        for (int k = 0; k < 6 * ring; ++k)
            mesh.positions.row(index(ring, k)) = place(static_cast<double>(ring) / rings, k * kPi / (3 * ring));
    for (int ring = 1; ring <= rings; ++ring)
        for (int sector = 0; sector < 6; ++sector)
            for (int k = 0; k < ring; ++k) {
                const int outer = sector * ring + k, inner = sector * (ring - 1) + k;
                mesh.faces.add({index(ring - 1, inner), index(ring, outer), index(ring, outer + 1)});
                if (k + 1 < ring)
                    mesh.faces.add({index(ring - 1, inner), index(ring, outer + 1), index(ring - 1, inner + 1)});
            }
    return mesh;
}

/// A grid of (m+1)×(n+1) vertices over the unit square; quads or triangles.
Mesh grid(int m, int n, bool quads, const std::function<Eigen::Vector3d(double, double)>& place) {
    Mesh mesh;
    mesh.positions.resize((m + 1) * (n + 1), 3);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= m; ++i)
            mesh.positions.row(j * (m + 1) + i) = place(static_cast<double>(i) / m, static_cast<double>(j) / n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const int a = j * (m + 1) + i, b = a + 1, c = a + m + 2, d = a + m + 1;
            if (quads) {
                mesh.faces.add({a, b, c, d});
            } else {
                mesh.faces.add({a, b, c});
                mesh.faces.add({a, c, d});
            }
        }
    return mesh;
}

Eigen::Vector3d cap(double rho, double phi) {  // of the unit sphere, 100° from the pole
    const double theta = rho * 100 * kPi / 180;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Eigen::Vector3d bumps(double x, double y) {
    return {
        x, y,
        0.5 * std::exp(-12 * ((x - .4) * (x - .4) + (y - .6) * (y - .6))) + 0.08 * std::sin(9 * x) * std::cos(7 * y)};
}

// ---- measures -------------------------------------------------------------------------------------------------------

/// Largest difference of edge and diagonal lengths within faces, between the surface and its image.
double isometry_error(const Mesh& mesh, const Eigen::VectorXcd& image) {
    double worst = 0;
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f])
            for (const int w : mesh.faces[f])
                worst =
                    std::max(worst, std::abs((mesh.point(v) - mesh.point(w)).norm() - std::abs(image[v] - image[w])));
    return worst;
}

double signed_area(const Mesh& mesh, const Eigen::VectorXcd& image, int face) {
    const auto c = mesh.faces[face];
    double sum = 0;
    for (std::size_t i = 0; i < c.size(); ++i) sum += std::imag(std::conj(image[c[i]]) * image[c[(i + 1) % c.size()]]);
    return 0.5 * sum;
}

Eigen::VectorXcd plane(const Mesh& mesh) {
    Eigen::VectorXcd z(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) z[v] = {mesh.positions(v, 0), mesh.positions(v, 1)};
    return z;
}

std::vector<int> boundary(const Mesh& mesh) {
    return topology(mesh).boundary_loops[0];
}

/// Order of convergence from errors at halved mesh widths.
double order(double coarse, double fine) {
    return std::log2(coarse / fine);
}

FlattenOptions with_angles(const std::vector<double>& angles) {
    FlattenOptions options;
    options.boundary_angles = angles;
    return options;
}

FlattenOptions with_tolerance(double tolerance) {
    FlattenOptions options;
    options.tolerance = tolerance;
    return options;
}

FlattenOptions with_iterations(int iterations) {
    FlattenOptions options;
    options.max_iterations = iterations;
    return options;
}

Cause cause_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(": "), std::string::npos) << "no next step: " << error.what();
        return error.cause();
    }
    ADD_FAILURE() << "nothing was thrown";
    return Cause::cancelled;
}

// ---- contract -------------------------------------------------------------------------------------------------------

TEST(Flatten, RefusesImpossibleInput) {
    const Mesh sound = placed_disk(2, cap);
    EXPECT_EQ(cause_of([&] { flatten(sound, with_tolerance(0)); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { flatten(sound, with_iterations(0)); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { flatten(sound, with_angles({1, 1, 1})); }), Cause::bad_boundary);
    std::vector<double> angles(12, 10 * kPi / 12);
    angles[3] += 1e-3;
    EXPECT_EQ(cause_of([&] { flatten(sound, with_angles(angles)); }), Cause::bad_boundary);
    angles[3] = -1e-3;
    EXPECT_EQ(cause_of([&] { flatten(sound, with_angles(angles)); }), Cause::bad_boundary);

    EXPECT_EQ(cause_of([] { flatten(Mesh{Positions::Zero(3, 3), {}, {}}); }), Cause::bad_mesh);
    Mesh closed = placed_disk(1, cap);  // the hexagon's boundary pulled to a point
    closed.positions.conservativeResize(8, 3);
    closed.positions.row(7) << 0, 0, -1;
    for (int k = 0; k < 6; ++k) closed.faces.add({1 + (k + 1) % 6, 1 + k, 7});
    EXPECT_EQ(cause_of([&] { flatten(closed); }), Cause::bad_mesh);
    Mesh ring = placed_disk(3, cap), holed = ring;
    holed.faces = {};
    for (int f = 6; f < ring.face_count(); ++f) holed.faces.add(ring.faces[f]);
    EXPECT_EQ(cause_of([&] { flatten(holed); }), Cause::bad_mesh);
    Mesh pair = placed_disk(1, cap);
    pair.positions.conservativeResize(14, 3);
    pair.positions.bottomRows(7) = pair.positions.topRows(7);
    for (int k = 0; k < 6; ++k) pair.faces.add({7, 8 + k, 8 + (k + 1) % 6});
    EXPECT_EQ(cause_of([&] { flatten(pair); }), Cause::bad_mesh);
    Mesh undefined = placed_disk(2, cap);
    undefined.positions(4, 1) = std::nan("");
    EXPECT_EQ(cause_of([&] { flatten(undefined); }), Cause::bad_mesh);
}

TEST(Flatten, SaysWhenItDoesNotConverge) {
    EXPECT_EQ(cause_of([] { flatten(placed_disk(10, cap), with_iterations(1)); }), Cause::not_solved);
}

TEST(Flatten, APlanarMeshIsItsOwnFlattening) {
    // A horseshoe: an outline that is far from convex, in quads, with a vertex that no face names.
    Mesh mesh = grid(30, 6, true, [](double s, double t) {
        return Eigen::Vector3d((1 + t) * std::cos(5 * s), (1 + t) * std::sin(5 * s), 0);
    });
    for (int f = 0; f < mesh.face_count(); ++f) ASSERT_LT(signed_area(mesh, plane(mesh), f), 0) << "seen from below";
    mesh.positions.conservativeResize(mesh.vertex_count() + 1, 3);
    mesh.positions.bottomRows(1) << 17, 18, 0;
    const Flattening below = flatten(mesh);
    mesh.positions.col(1) *= -1;
    const Flattening above = flatten(mesh);
    for (const Flattening& f : {below, above}) {
        for (int v = 0; v + 1 < mesh.vertex_count(); ++v) EXPECT_EQ(f.positions[v], plane(mesh)[v]);
        EXPECT_EQ(f.positions[mesh.vertex_count() - 1], Complex(0));
        EXPECT_EQ(f.log_scale, Eigen::VectorXd::Zero(mesh.vertex_count()));
        EXPECT_EQ(f.iterations, 0);
        EXPECT_TRUE(f.flipped.empty());
        EXPECT_LT(f.residual, 1e-12);
    }
    mesh.positions.conservativeResize(mesh.vertex_count(), 2);
    EXPECT_EQ(flatten(mesh).positions, above.positions);
}

TEST(Flatten, DevelopableSurfacesAreUnrolledExactly) {
    const Eigen::Matrix3d turn = Eigen::Quaterniond(0.3, 0.5, -0.7, 0.4).normalized().toRotationMatrix();
    const Mesh tilted = grid(9, 7, false, [&](double s, double t) -> Eigen::Vector3d {
        return turn * Eigen::Vector3d(s + t, 2 * t * t, 0);
    });
    // Facets between the rulings are flat, so these are developable as meshes, quads included.
    const Mesh cylinder = grid(20, 9, true, [](double s, double t) {
        return Eigen::Vector3d(std::cos(4 * s), std::sin(4 * s), 3 * t * t + t);
    });
    const Mesh cone = grid(25, 8, true, [](double s, double t) {
        const double r = 1 + 2 * t;
        return Eigen::Vector3d(r * std::cos(6 * s), r * std::sin(6 * s), -0.5 * r);
    });
    for (const Mesh* mesh : {&tilted, &cylinder, &cone}) {
        const Flattening f = flatten(*mesh);
        EXPECT_EQ(f.iterations, 0);
        EXPECT_LT(isometry_error(*mesh, f.positions), 1e-12);
        EXPECT_LT(f.layout_error, 1e-13);
        EXPECT_TRUE(f.flipped.empty());
        for (int q = 0; q < mesh->face_count(); ++q) EXPECT_GT(signed_area(*mesh, f.positions, q), 0);
    }
}

TEST(Flatten, AngleSumsAndLengthsAreWhatTheResultSays) {
    const Mesh mesh = grid(20, 20, false, bumps);
    const Flattening f = flatten(mesh);
    EXPECT_LT(f.residual, 1e-10);
    EXPECT_LT(f.layout_error, 1e-12);
    EXPECT_TRUE(f.flipped.empty());
    // Scaled lengths, for every edge that is intrinsically Delaunay before and after (all but the flipped ones).
    int agree = 0, edges = 0;
    for (int t = 0; t < mesh.face_count(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.faces[t][k], w = mesh.faces[t][(k + 1) % 3];
            const double scaled =
                (mesh.point(v) - mesh.point(w)).norm() * std::exp(0.5 * (f.log_scale[v] + f.log_scale[w]));
            agree += std::abs(scaled - std::abs(f.positions[v] - f.positions[w])) < 1e-12;
            ++edges;
        }
    EXPECT_GE(agree, edges - 2 * f.flips);
    EXPECT_GT(agree, edges / 2);
    for (const int v : boundary(mesh)) EXPECT_EQ(f.log_scale[v], 0);
}

TEST(Flatten, IsDeterministic) {
    const Mesh mesh = grid(30, 30, false, bumps);
    const Flattening a = flatten(mesh), b = flatten(mesh);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.log_scale, b.log_scale);
}

// ---- accuracy -------------------------------------------------------------------------------------------------------

TEST(Flatten, SurfacesOfRevolutionConvergeWithSecondOrder) {
    const auto paraboloid = [](double rho, double phi) {
        return Eigen::Vector3d(1.5 * rho * std::cos(phi), 1.5 * rho * std::sin(phi), -2.25 * rho * rho);
    };
    // Conformal radii: d log R = ds/r along a meridian; of the sphere this is stereographic projection.
    const auto cap_radius = [](double rho) { return std::tan(rho * 50 * kPi / 180); };
    const auto paraboloid_radius = [](double rho) {
        const double r = 1.5 * rho, s = std::sqrt(1 + 4 * r * r);
        return r / (1 + s) * std::exp(s);
    };
    const auto error = [](int rings, const auto& surface, const auto& radius) {
        const Mesh mesh = placed_disk(rings, surface);
        const Mesh exact = placed_disk(rings, [&](double rho, double phi) {
            return Eigen::Vector3d(radius(rho) * std::cos(phi), radius(rho) * std::sin(phi), 0);
        });
        const Flattening f = flatten(mesh);
        EXPECT_LT(f.residual, 1e-10);
        EXPECT_LE(f.iterations, 8);
        EXPECT_TRUE(f.flipped.empty());
        // The boundary keeps its lengths, so the scale is right as well: conformal radius 1 at the boundary.
        const Complex outer = f.positions[mesh.vertex_count() - 1] - f.positions[0];
        EXPECT_NEAR(std::abs(outer), mesh.positions.bottomRows(1).leftCols(2).norm(), 2.0 / (rings * rings));
        return test::distance_up_to_similarity(f.positions, plane(exact));
    };
    // Stereographic projection scales chords exactly by factors at their ends: nothing is left to discretise.
    EXPECT_LT(error(16, cap, cap_radius), 1e-8);
    const double coarse = error(32, paraboloid, paraboloid_radius), fine = error(64, paraboloid, paraboloid_radius);
    EXPECT_LT(fine, 2e-5);
    EXPECT_GT(order(coarse, fine), 1.85);
}

TEST(ScaleFactors, UndoAMoebiusTransformationExactly) {
    // Chords of the sphere are stereographic images of plane distances times vertex factors: 2|z − w| /
    // √((1+|z|²)(1+|w|²)). So the lifted Delaunay mesh is discretely conformal to the flat one; the factors on the
    // boundary determine the others.
    const int n = 14;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> jitter(-0.01, 0.01), noise(-1, 1);
    const Mesh flat = grid(n, n, false, [&](double s, double t) {  // nearly equilateral, so Delaunay
        return Eigen::Vector3d(2 * s - t + jitter(random), std::sqrt(3) * t - 0.4 + jitter(random), 0);
    });
    const Eigen::VectorXcd z = plane(flat);
    std::vector<double> log_lengths;
    for (int f = 0; f < flat.face_count(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Complex a = z[flat.faces[f][k]], b = z[flat.faces[f][(k + 1) % 3]];
            log_lengths.push_back(std::log(2 * std::abs(a - b) / std::sqrt((1 + std::norm(a)) * (1 + std::norm(b)))));
        }
    IntrinsicTriangulation triangulation(flat.faces, flat.vertex_count(), log_lengths);
    ScaleFactorProblem problem;
    problem.target_angles = Eigen::VectorXd::Constant(flat.vertex_count(), 2 * kPi);
    problem.free.assign(static_cast<std::size_t>(flat.vertex_count()), 1);
    Eigen::VectorXd exact(flat.vertex_count()), start(flat.vertex_count());
    for (int v = 0; v < flat.vertex_count(); ++v) {
        exact[v] = std::log((1 + std::norm(z[v])) / 2);
        start[v] = exact[v] + noise(random);
    }
    for (const int v : boundary(flat)) {
        problem.target_angles[v] = std::nan("");
        problem.free[static_cast<std::size_t>(v)] = 0;
        start[v] = exact[v];
    }
    const ScaleFactors found = solve_scale_factors(triangulation, problem, start);
    EXPECT_EQ(found.status, ScaleFactorStatus::converged);
    EXPECT_GT(found.flips, 100);
    EXPECT_LE(found.iterations, 10);
    EXPECT_LT((found.u - exact).lpNorm<Eigen::Infinity>(), 1e-10);
    EXPECT_LT(test::distance_up_to_similarity(lay_out(triangulation, found.u).positions, z), 1e-11);
}

TEST(Flatten, EqualAnglesGiveARegularPolygon) {
    const Mesh mesh = placed_disk(6, cap);
    const std::size_t n = 36;
    const Flattening f = flatten(mesh, with_angles(std::vector<double>(n, (n - 2) * kPi / n)));
    EXPECT_LT(f.residual, 1e-10);
    EXPECT_TRUE(f.flipped.empty());
    // By the symmetry of the mesh, the corners lie on a circle to the accuracy of the mesh, exactly in its six mirrors.
    double length = 0, source = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const int v = 91 + static_cast<int>(k), w = 91 + static_cast<int>((k + 1) % n);
        length += std::abs(f.positions[w] - f.positions[v]);
        source += (mesh.point(w) - mesh.point(v)).norm();
        EXPECT_NEAR(std::abs(f.positions[v] - f.positions[0]) / 0.985, 1, 0.03);
        const int turned = 91 + static_cast<int>((k + 6) % n);
        EXPECT_NEAR(std::abs((f.positions[turned] - f.positions[0]) / (f.positions[v] - f.positions[0]) -
                             std::polar(1.0, kPi / 3)),
                    0, 1e-11);
        const int before = 91 + static_cast<int>((k + n - 1) % n);
        const double angle = std::arg((f.positions[before] - f.positions[v]) / (f.positions[w] - f.positions[v]));
        EXPECT_NEAR(angle, (n - 2) * kPi / n, 1e-9);
    }
    EXPECT_NEAR(length, source, 1e-11);
}

TEST(Flatten, FourRightAnglesGiveTheRectangleOfTheRightModulus) {
    // An annular sector is the image of a rectangle of aspect 1.7 under exp.
    const double aspect = 1.7;
    const auto error = [&](int n) {
        const Mesh sector = grid(n, n, false, [&](double s, double t) {
            const Complex z = std::exp(Complex(aspect * s, t + 0.1 * std::sin(kPi * t)));
            return Eigen::Vector3d(z.real(), z.imag(), 0);
        });
        const std::vector<int> loop = boundary(sector);
        const std::vector<int> corners = {0, n, (n + 1) * (n + 1) - 1, n * (n + 1)};
        std::vector<double> angles(loop.size(), kPi);
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (std::find(corners.begin(), corners.end(), loop[i]) != corners.end()) angles[i] = kPi / 2;
        const Flattening f = flatten(sector, with_angles(angles));
        EXPECT_LT(f.residual, 1e-10);
        EXPECT_TRUE(f.flipped.empty());
        const Complex origin = f.positions[corners[0]], x = f.positions[corners[1]] - origin;
        const double width = std::abs(x), height = std::abs(f.positions[corners[3]] - origin);
        for (const int v : loop) {  // the outline is this rectangle
            const Complex z = (f.positions[v] - origin) / x * width;
            const double side = std::min(
                {std::abs(z.real()), std::abs(z.real() - width), std::abs(z.imag()), std::abs(z.imag() - height)});
            EXPECT_LT(side, 1e-9);
        }
        return std::abs(width / height - aspect);
    };
    const double e16 = error(16), e32 = error(32);
    EXPECT_LT(e32, 2e-3);
    EXPECT_GT(order(e16, e32), 1.8);
    RecordProperty("aspect_error", std::to_string(e32));
}

// ---- invariance -----------------------------------------------------------------------------------------------------

TEST(Flatten, DoesNotDependOnPlaceSizeOrNumbering) {
    const Mesh mesh = grid(18, 15, false, bumps);
    const Flattening original = flatten(mesh);
    const Eigen::Matrix3d turn = Eigen::Quaterniond(0.3, 0.5, -0.7, 0.4).normalized().toRotationMatrix();
    for (const double scale : {1e-6, 1.0, 1e6}) {
        Mesh moved = mesh;
        moved.positions = (scale * mesh.positions * turn.transpose()).rowwise() + scale * Eigen::RowVector3d(3, -8, 5);
        const Flattening f = flatten(moved);
        EXPECT_LT(test::distance_up_to_similarity(f.positions, original.positions), 1e-9);
        EXPECT_LT((f.log_scale - original.log_scale).lpNorm<Eigen::Infinity>(), 1e-9);
        EXPECT_NEAR(std::abs(f.positions[40] - f.positions[7]) / scale,
                    std::abs(original.positions[40] - original.positions[7]), 1e-9);
        EXPECT_EQ(f.iterations, original.iterations);
    }
    std::mt19937 random(5);
    std::vector<int> renamed(mesh.vertex_count()), face_order(mesh.face_count());
    std::iota(renamed.begin(), renamed.end(), 0);
    std::iota(face_order.begin(), face_order.end(), 0);
    std::shuffle(renamed.begin(), renamed.end(), random);
    std::shuffle(face_order.begin(), face_order.end(), random);
    Mesh shuffled;
    shuffled.positions.resize(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) shuffled.positions.row(renamed[v]) = mesh.positions.row(v);
    for (const int f : face_order)
        shuffled.faces.add({renamed[mesh.faces[f][2]], renamed[mesh.faces[f][0]], renamed[mesh.faces[f][1]]});
    const Flattening f = flatten(shuffled);
    Eigen::VectorXcd back(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) back[v] = f.positions[renamed[v]];
    EXPECT_LT(test::distance_up_to_similarity(back, original.positions), 1e-9);
}

/// A faceted roof on an n×n lattice, whose facets hold many coplanar triangles; `flips` random flips inside the facets
/// leave the surface as it is and wreck its triangulation.
Mesh roof(int n, int flips) {
    Mesh mesh = grid(n, n, false, [](double x, double y) {
        return Eigen::Vector3d(x, y, 0.6 * std::min({x, 1 - x, y, 1 - y}) + 0.3 * std::abs(x - 0.5));
    });
    std::vector<std::array<int, 3>> faces;
    for (int f = 0; f < mesh.face_count(); ++f) faces.push_back({mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]});
    std::mt19937 random(11);
    for (int done = 0; done < flips;) {
        const std::size_t f = random() % faces.size(), k = random() % 3;
        const int i = faces[f][k], j = faces[f][(k + 1) % 3], apex = faces[f][(k + 2) % 3];
        for (std::array<int, 3>& other : faces)
            for (std::size_t m = 0; m < 3; ++m) {
                if (other[m] != j || other[(m + 1) % 3] != i) continue;
                const int opposite = other[(m + 2) % 3];
                const auto normal = [&](int a, int b, int c) {
                    return Eigen::Vector3d((mesh.point(b) - mesh.point(a)).cross(mesh.point(c) - mesh.point(a)));
                };
                const Eigen::Vector3d old = normal(i, j, apex), new1 = normal(opposite, apex, i),
                                      new2 = normal(apex, opposite, j);
                const bool flat = std::abs(old.dot(mesh.point(opposite) - mesh.point(i))) < 1e-14;
                if (!flat || new1.dot(old) <= 1e-9 || new2.dot(old) <= 1e-9) continue;
                faces[f] = {opposite, apex, i};
                other = {apex, opposite, j};
                ++done;
                m = 3;
            }
    }
    mesh.faces = {};
    for (const auto& face : faces) mesh.faces.add({face[0], face[1], face[2]});
    return mesh;
}

TEST(Flatten, DependsOnTheSurfaceAndNotOnItsTriangles) {
    const Flattening good = flatten(roof(12, 0)), bad = flatten(roof(12, 400));
    EXPECT_GT(bad.flips, good.flips + 50);
    EXPECT_LT(bad.residual, 1e-10);
    EXPECT_LT(test::distance_up_to_similarity(bad.positions, good.positions), 1e-9);
    EXPECT_LT((bad.log_scale - good.log_scale).lpNorm<Eigen::Infinity>(), 1e-9);
}

TEST(Flatten, AFlatQuadIsTheSameAsItsTriangles) {
    const auto prism = [](double x, double y) {
        return Eigen::Vector3d(x, 2 * y + 0.3 * x, std::abs(x - 0.5) + 0.2 * x * x);
    };
    EXPECT_LT(test::distance_up_to_similarity(flatten(grid(8, 5, true, prism)).positions,
                                              flatten(grid(8, 5, false, prism)).positions),
              1e-12);
}

// ---- hard cases -----------------------------------------------------------------------------------------------------

TEST(Flatten, JitterAndNeedlesConverge) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> jitter(-0.45, 0.45);
    const Mesh mesh = grid(60, 6, false, [&](double s, double t) -> Eigen::Vector3d {
        return bumps(s, t) + Eigen::Vector3d(0, 0, 0.02 * jitter(random));
    });
    const Flattening f = flatten(mesh);
    EXPECT_LT(f.residual, 1e-10);
    EXPECT_LE(f.iterations, 15);
    EXPECT_GT(f.flips, 50);
}

TEST(Flatten, ExtremeScalesConverge) {
    // A finger thirty times as long as thick: e^u falls like exp(−2 length/radius · ...) towards its tip.
    const Mesh finger = placed_disk(48, [](double rho, double phi) {
        const double r = rho < 0.5 ? 0.1 * std::min(1.0, 16 * rho) : 0.1 + 1.8 * (rho - 0.5);
        const double z = rho < 0.5 ? 6 * (0.5 - rho) : 0;
        return Eigen::Vector3d(r * std::cos(phi), r * std::sin(phi), z);
    });
    const Flattening f = flatten(finger);
    EXPECT_LT(f.residual, 1e-10);
    EXPECT_LT(f.log_scale[0], -20);
    EXPECT_LE(f.iterations, 20);
    EXPECT_LT(f.layout_error, 1e-12);
}

TEST(Flatten, BoundaryEdgesAreSplitWhereTrianglesWouldDegenerate) {
    // An octahedron, each face n×n small triangles, put on the sphere: without one triangle, all of it has to pass
    // between three boundary edges. A lattice point (i, j, k), |i|+|j|+|k| = n, is a vertex.
    const int n = 8;
    std::vector<std::array<int, 3>> lattice;
    for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j)
            for (const int sign : {-1, 1})
                if (const int k = n - std::abs(i) - std::abs(j); k > 0 || (k == 0 && sign > 0))
                    lattice.push_back({i, j, sign * k});
    const auto vertex = [&](int i, int j, int k) {
        const std::array<int, 3> point = {i, j, k};
        return static_cast<int>(std::find(lattice.begin(), lattice.end(), point) - lattice.begin());
    };
    Mesh sphere;
    sphere.positions.resize(static_cast<Eigen::Index>(lattice.size()), 3);
    for (std::size_t v = 0; v < lattice.size(); ++v)
        sphere.positions.row(static_cast<Eigen::Index>(v)) =
            Eigen::RowVector3d(lattice[v][0], lattice[v][1], lattice[v][2]).normalized();
    for (int octant = 0; octant < 8; ++octant) {
        const int x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
        const auto add = [&](std::array<int, 3> a, std::array<int, 3> b, std::array<int, 3> c) {
            if (x * y * z < 0) std::swap(b, c);
            const auto at = [&](const std::array<int, 3>& p) { return vertex(x * p[0], y * p[1], z * p[2]); };
            sphere.faces.add({at(a), at(b), at(c)});
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                const int k = n - i - j;
                if (octant > 0 || i != 2 || j != 3) add({i, j, k}, {i + 1, j, k - 1}, {i, j + 1, k - 1});
                if (k > 1) add({i + 1, j, k - 1}, {i + 1, j + 1, k - 2}, {i, j + 1, k - 1});
            }
    }
    const std::vector<int> loop = boundary(sphere);
    ASSERT_EQ(loop.size(), 3U);
    const Flattening natural = flatten(sphere);
    const Flattening triangle = flatten(sphere, with_angles({0.4 * kPi, 0.3 * kPi, 0.3 * kPi}));
    for (const Flattening& f : {natural, triangle}) {
        EXPECT_LT(f.residual, 1e-10);
        EXPECT_GT(f.boundary_splits, 0);
        EXPECT_EQ(f.positions.size(), sphere.vertex_count());
        EXPECT_EQ(f.log_scale.size(), sphere.vertex_count());
        EXPECT_LT(f.layout_error, 1e-10);
        EXPECT_LE(f.flipped.size(), 3U);
    }
    const Complex a = triangle.positions[loop[0]], b = triangle.positions[loop[1]], c = triangle.positions[loop[2]];
    EXPECT_NEAR(std::arg((c - a) / (b - a)), 0.4 * kPi, 1e-9);
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) length += (sphere.point(loop[k]) - sphere.point(loop[(k + 1) % 3])).norm();
    EXPECT_NEAR(std::abs(a - b) + std::abs(b - c) + std::abs(c - a), length, 1e-9);
}

TEST(Flatten, TrianglesWithoutAreaAreTakenWithANote) {
    Mesh mesh = grid(8, 8, false, bumps);
    mesh.positions.row(40) = 0.5 * (mesh.positions.row(39) + mesh.positions.row(41));
    mesh.positions.row(31) = mesh.positions.row(40);  // two vertices in one place
    const Flattening f = flatten(mesh);
    EXPECT_GT(f.lengthened, 0);
    EXPECT_LT(f.lengthened, 1e-8);
    EXPECT_LT(f.residual, 1e-6);
    EXPECT_TRUE(f.positions.allFinite());
}

// ---- real surfaces --------------------------------------------------------------------------------------------------

class FlattenRealMesh : public testing::TestWithParam<const char*> {};

TEST_P(FlattenRealMesh, Converges) {
    const std::filesystem::path file = test::real_mesh(GetParam());
    if (file.empty()) GTEST_SKIP() << "set BELTRAMI_TEST_MESHES to the folder of " << GetParam();
    const Mesh mesh = read_mesh(file).mesh;
    const std::size_t n = boundary(mesh).size();
    for (const bool regular : {false, true}) {
        FlattenOptions options;
        if (regular) options.boundary_angles.assign(n, static_cast<double>(n - 2) * kPi / static_cast<double>(n));
        const Flattening f = flatten(mesh, options);
        EXPECT_LT(f.residual, 1e-9);
        EXPECT_LT(f.layout_error, 1e-10);
        EXPECT_LE(f.iterations, 15);
        EXPECT_TRUE(f.flipped.empty());
    }
}

INSTANTIATE_TEST_SUITE_P(Disks, FlattenRealMesh, testing::Values("human_face.obj", "hand_disk.obj"),
                         [](const auto& instance) { return std::string(instance.param).substr(0, 4); });

}  // namespace
}  // namespace beltrami
