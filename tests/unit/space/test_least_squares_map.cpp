#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include <beltrami/base/constants.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/space/reference_shapes.h>
#include <beltrami/space/uniform_map.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;
using Vector3 = Eigen::Vector3d;

Mesh in_space(const Mesh& planar, const std::function<double(double, double)>& height) {
    Mesh mesh = planar;
    mesh.positions.resize(planar.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = planar.positions(v, 0), y = planar.positions(v, 1);
        mesh.positions.row(v) << x, y, height(x, y);
    }
    return mesh;
}

Eigen::VectorXcd some_coefficients(int count) {
    Eigen::VectorXcd mu(count);
    for (int s = 0; s < count; ++s) mu[s] = std::polar(0.3 + 0.3 * std::sin(3.7 * s), 2.1 * s);
    return mu;
}

Positions some_map(const Mesh& mesh) {
    Positions map(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        for (int a = 0; a < 3; ++a) map(v, a) = mesh.point(v)[a] + 0.3 * std::sin(12.9 * v + 78.2 * a);
    return map;
}

/// Quaternions as (real, vector).
struct Quaternion {
    double w = 0;
    Vector3 v = Vector3::Zero();
    friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
        return {a.w * b.w - a.v.dot(b.v), a.w * b.v + b.w * a.v + a.v.cross(b.v)};
    }
    friend Quaternion operator+(const Quaternion& a, const Quaternion& b) { return {a.w + b.w, a.v + b.v}; }
    friend Quaternion operator-(const Quaternion& a, const Quaternion& b) { return {a.w - b.w, a.v - b.v}; }
    double squared() const { return w * w + v.squaredNorm(); }
};

/// Σ 2A |df⁻ − μ df⁺|², df^∓ = ½ (F₁ ± N F₂), μ = μ₁ + μ₂ N: Gruber and Aulisa's energy as they write it.
double quaternionic_energy(const CornerElements& elements, const Positions& normals, const Eigen::VectorXcd& mu,
                           const Positions& map) {
    double sum = 0;
    for (int s = 0; s < elements.operators.sample_count(); ++s) {
        const auto v = elements.operators.stencil(s);
        const auto g = elements.operators.gradient(s);
        Quaternion x, y;
        for (int k = 0; k < 3; ++k) {
            x.v += g[k].real() * map.row(v[k]).transpose();
            y.v += g[k].imag() * map.row(v[k]).transpose();
        }
        const Quaternion n{0, normals.row(s)}, ny = n * y, half{0.5, Vector3::Zero()};
        const Quaternion coefficient{mu[s].real(), mu[s].imag() * n.v};
        const Quaternion rest = half * (x + ny) - coefficient * (half * (x - ny));
        sum += 2 * elements.operators.weights[s] * rest.squared();
    }
    return sum;
}

double pairing(const Positions& a, const Positions& b) {
    return (a.array() * b.array()).sum();
}

std::vector<char> boundary_flags(const Mesh& mesh) {
    return topology(mesh).on_boundary;
}

TEST(LeastSquaresMap, BlocksAgreeWithQuaternions) {
    Mesh ellipsoid = icosahedral_sphere(1);
    ellipsoid.positions.col(1) *= 1.3;
    ellipsoid.positions.col(2) *= 0.7;
    for (const Mesh& mesh : {ellipsoid, in_space(test::mixed_square(5), [](double x, double y) {
                                 return std::sin(3 * x) * std::cos(2 * y);
                             })}) {
        const CornerElements elements = corner_elements(mesh);
        LeastSquaresMap problem(mesh, elements, mesh.positions, std::vector<char>(mesh.vertex_count(), 0),
                                Preserve::normals);
        const Eigen::VectorXcd mu = some_coefficients(elements.operators.sample_count());
        const Positions map = some_map(mesh);
        const double expected = quaternionic_energy(elements, corner_normals(mesh), mu, map);
        EXPECT_NEAR(pairing(map, problem.gradient(mu, map)) / expected, 1, 1e-12);
        EXPECT_NEAR(problem.energy(mu, map) / expected, 1, 1e-12);
        // The surface itself costs nothing.
        const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(mu.size());
        EXPECT_LT(pairing(mesh.positions, problem.gradient(none, mesh.positions)), 1e-12 * expected);
    }
}

// With the weight A/(1−|μ|²) the energy is the Dirichlet energy in the metric |dz + μ dz̄|² and a sum over edges that
// does not depend on μ, ½ Σ f_a · ((N_L − N_R) × f_b).
TEST(LeastSquaresMap, IsADirichletEnergyAndJumpsOfTheNormals) {
    Mesh mesh = icosahedral_sphere(1);
    mesh.positions.col(1) *= 1.3;
    CornerElements elements = corner_elements(mesh);
    const Eigen::VectorXcd mu = some_coefficients(elements.operators.sample_count());
    for (int s = 0; s < elements.operators.sample_count(); ++s) elements.operators.weights[s] /= 1 - std::norm(mu[s]);
    const LeastSquaresMap problem(mesh, elements, mesh.positions, std::vector<char>(mesh.vertex_count(), 0),
                                  Preserve::normals);
    const Positions map = some_map(mesh), normals = corner_normals(mesh);
    double expected = 0;
    for (int s = 0; s < elements.operators.sample_count(); ++s) {
        const auto g = elements.operators.gradient(s);
        Eigen::Vector3cd sum = Eigen::Vector3cd::Zero();
        for (int k = 0; k < 3; ++k)
            sum += 0.5 * (g[k] - mu[s] * std::conj(g[k])) * map.row(elements.operators.stencil(s)[k]).transpose();
        expected += 2 * elements.operators.weights[s] * sum.squaredNorm();
    }
    const Topology combinatorics = topology(mesh);
    for (int e = 0; e < combinatorics.edge_count(); ++e) {
        const auto [a, b] = combinatorics.edges[e];
        const auto [left, right] = combinatorics.edge_faces[e];
        const Vector3 jump = normals.row(left) - normals.row(right), fa = map.row(a), fb = map.row(b);
        expected += 0.5 * fa.dot(jump.cross(fb));
    }
    EXPECT_NEAR(pairing(map, problem.gradient(mu, map)) / expected, 1, 1e-12);
}

TEST(LeastSquaresMap, AffineMapsAreExact) {
    const Complex k = std::polar(0.4, 0.7);
    for (const Mesh& planar : {test::jittered_square(8), test::quad_square(8, 0.25), test::mixed_square(8)})
        for (const bool regular : {false, true}) {
            const Mesh mesh = in_space(planar, [](double, double) { return 0; });
            const CornerElements elements =
                regular ? corner_elements(mesh, regular_shapes(mesh.faces)) : corner_elements(mesh);
            const Eigen::VectorXcd z = complex_positions(planar), wanted = z + k * z.conjugate();
            Positions exact(mesh.vertex_count(), 3);
            exact << wanted.real(), wanted.imag(), Eigen::VectorXd::Zero(mesh.vertex_count());
            LeastSquaresMap problem(mesh, elements, exact, boundary_flags(mesh), Preserve::nothing);
            Eigen::VectorXcd mu = beltrami_coefficient(elements.operators, wanted);
            if (!regular)
                mu = face_values_at_samples(elements.operators, face_means(elements.operators, mu));  // one a face
            EXPECT_LT((problem.solve(mu) - exact).cwiseAbs().maxCoeff(), 1e-12);
        }
}

/// A curved patch whose boundary is moved, as quads or as triangles.
Positions moved_patch(int n, bool quads) {
    const Mesh planar = quads ? test::quad_square(n, 0) : test::square(n, 0, [](int, int) { return false; });
    const Mesh mesh = in_space(planar, [](double x, double y) { return 0.3 * std::sin(3 * x) * std::cos(2 * y); });
    Positions places = mesh.positions;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        places.row(v) += 0.15 * Eigen::RowVector3d(std::sin(kPi * y), std::cos(2 * x), std::sin(3 * x + y));
    }
    const CornerElements elements = corner_elements(mesh);
    LeastSquaresMap problem(mesh, elements, places, boundary_flags(mesh), Preserve::nothing);
    return problem.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
}

TEST(LeastSquaresMap, QuadsAgreeWithTheirTrianglesToSecondOrder) {
    double last = 0;
    for (const int n : {8, 16, 32}) {
        const double difference = (moved_patch(n, true) - moved_patch(n, false)).rowwise().norm().maxCoeff();
        if (n > 8) {
            EXPECT_GT(last / difference, 3.2) << n;
        }
        EXPECT_LT(difference, 0.4 / (n * n));
        last = difference;
    }
}

TEST(LeastSquaresMap, NormalConstraintHoldsAndIsStationary) {
    Mesh mesh = icosahedral_sphere(2);
    mesh.positions.col(0) *= 1.4;
    const CornerElements elements = corner_elements(mesh, regular_shapes(mesh.faces));
    LeastSquaresMap problem(mesh, elements, mesh.positions, std::vector<char>(mesh.vertex_count(), 0),
                            Preserve::normals);
    const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(elements.operators.sample_count());
    const Positions map = problem.solve(none), normals = vertex_normals(mesh), rest = problem.gradient(none, map);
    EXPECT_LT(((map - mesh.positions).array() * normals.array()).rowwise().sum().abs().maxCoeff(), 1e-12);
    for (int v = 0; v < mesh.vertex_count(); ++v) {  // nothing is left but along the normals
        const Vector3 force = rest.row(v), normal = normals.row(v);
        EXPECT_LT((force - force.dot(normal) * normal).norm(), 1e-9);
    }
    EXPECT_LT(problem.energy(none, map), problem.energy(none, mesh.positions));
}

TEST(LeastSquaresMap, AreaConstraintHasTheRightSign) {
    Mesh mesh = torus(2, 1, 20, 10);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double a = 2 * kPi * (v / 10) / 20 + 0.08 * std::sin(5.0 * v),
                     b = 2 * kPi * (v % 10) / 10 + 0.12 * std::cos(3.0 * v);
        mesh.positions.row(v) << (2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b);
    }
    const CornerElements elements = corner_elements(mesh, regular_shapes(mesh.faces));
    LeastSquaresMap problem(mesh, elements, mesh.positions, std::vector<char>(mesh.vertex_count(), 0), Preserve::area);
    const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(elements.operators.sample_count());
    const Positions map = problem.solve(none);
    const auto area = [&](const Positions& at) {
        double sum = 0;
        for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area({at, mesh.faces, {}}, f).norm();
        return sum;
    };
    EXPECT_NEAR(area(map) / area(mesh.positions), 1, 0.06);  // to first order
    EXPECT_LT(problem.energy(none, map), problem.energy(none, mesh.positions));
    Mesh image{map, mesh.faces, {}};
    const Distortion before = distortion(elements.operators, mesh.positions, vertex_normals(mesh)),
                     after = distortion(elements.operators, map, vertex_normals(image));
    EXPECT_LT(after.mean, before.mean);
}

TEST(LeastSquaresMap, RefusesToCollapse) {
    const Mesh mesh = icosahedral_sphere(1);
    const CornerElements elements = corner_elements(mesh);
    std::vector<char> fixed(mesh.vertex_count(), 0);
    const auto attempt = [&] { LeastSquaresMap(mesh, elements, mesh.positions, fixed, Preserve::nothing); };
    EXPECT_EQ(test::cause_of(attempt), Cause::bad_boundary);
    fixed[3] = 1;
    EXPECT_EQ(test::cause_of(attempt), Cause::bad_boundary);
    fixed[7] = 1;
    EXPECT_EQ(test::cause_of(attempt), Cause::unreadable);  // not refused
}

// The cylinder whose upper rim goes down to a fifth of its height on one side, by vertices that stay on the cylinder.
// Expected numbers: an independent implementation.
TEST(UniformMap, EvensOutTheDilatationOfALoweredCylinder) {
    const int around = 48, along = 16;
    Mesh mesh;
    mesh.positions.resize(around * (along + 1), 3);
    Positions places(mesh.positions.rows(), 3);
    std::vector<char> fixed(static_cast<std::size_t>(mesh.positions.rows()), 0);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j <= along; ++j) {
            const double t = 2 * kPi * i / around, z = 2.0 * j / along;
            const int v = i * (along + 1) + j;
            mesh.positions.row(v) << std::cos(t), std::sin(t), z;
            places.row(v) = mesh.positions.row(v);
            if (j == along) places(v, 2) -= 0.8 * (1 - std::cos(t));
            fixed[v] = j == 0 || j == along;
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < along; ++j) {
            const int a = i * (along + 1) + j, b = (i + 1) % around * (along + 1) + j, c = b + 1, d = a + 1;
            if ((i + j) % 2 == 0) {
                mesh.faces.add({a, b, c});
                mesh.faces.add({a, c, d});
            } else {
                mesh.faces.add({a, b, d});
                mesh.faces.add({b, c, d});
            }
        }
    const CornerElements elements = corner_elements(mesh);
    LeastSquaresMap problem(mesh, elements, places, fixed, Preserve::normals);
    UniformOptions options;
    options.max_iterations = 80;
    options.tolerance = 0;
    const UniformMap result = uniform_map(problem, mesh, options);
    // Judged by the cylinder's own normals, which the image keeps.
    const Positions normals = vertex_normals(mesh);
    const Distortion first = distortion(elements.operators, result.first, normals),
                     last = distortion(elements.operators, result.map, normals);
    EXPECT_NEAR(first.mean, 0.354, 0.01);
    EXPECT_EQ(first.flipped.size(), 46u);
    EXPECT_NEAR(last.mean, 0.557, 0.01);
    EXPECT_LT(last.standard_deviation, 0.04);
    EXPECT_LT(last.max, 0.66);
    EXPECT_EQ(last.flipped.size(), 0u);
}

}  // namespace
}  // namespace beltrami
