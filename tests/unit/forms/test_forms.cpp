#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <beltrami/base/error.h>
#include <beltrami/forms/homology.h>
#include <beltrami/forms/period_matrix.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/linear/decomposition.h>

#include "support/cause_of.h"
#include "support/tori.h"
#include "support/voxels.h"

namespace beltrami {
namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXi;

/// The mesh without some faces.
Mesh without_faces(const Mesh& mesh, const std::set<int>& left_out) {
    Mesh part = mesh;
    part.faces = {};
    for (int f = 0; f < mesh.face_count(); ++f)
        if (left_out.count(f) == 0) part.faces.add(mesh.faces[f]);
    return part;
}

/// A torus whose faces are quads by rows of their cell and triangles else.
Mesh mixed_torus() {
    Mesh mesh = torus(2, 1, 12, 8, Cells::quads);
    FaceList faces;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        if (f % 3 == 0) {
            faces.add({v[0], v[1], v[2]});
            faces.add({v[0], v[2], v[3]});
        } else {
            faces.add(v);
        }
    }
    mesh.faces = std::move(faces);
    return mesh;
}

MatrixXi standard(int pairs, int size) {
    MatrixXi J = MatrixXi::Zero(size, size);
    for (int i = 0; i < pairs; ++i) J(i, pairs + i) = 1, J(pairs + i, i) = -1;
    return J;
}

struct Case {
    const char* name;
    Mesh mesh;
    int loops, genus;
};

std::vector<Case> cases() {
    return {{"sphere", icosahedral_sphere(1), 0, 0},
            {"disk", disk(4), 0, 0},
            {"annulus", annulus(0.5, 1, 12), 1, 0},
            {"torus", torus(2, 1, 11, 7), 2, 1},
            {"torus of quads and triangles", mixed_torus(), 2, 1},
            {"torus with a hole", without_faces(torus(2, 1, 11, 7), {3, 40}), 3, 1},
            {"torus with three holes", without_faces(torus(2, 1, 16, 12), {0, 100, 200}), 4, 1},
            {"double torus", double_torus(0.2), 4, 2},
            {"double torus with a hole", without_faces(double_torus(0.2), {17}), 4, 2},
            {"bar with three holes", test::bar_with_holes(3), 6, 3},
            {"bar with five holes", test::bar_with_holes(5), 10, 5}};
}

TEST(Homology, LoopsAndFormsAreDualClosedAndAsManyAsTheTopologySays) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const Surface surface(c.mesh);
        ASSERT_EQ(surface.topology.genus, c.genus);
        const HomologyBasis basis = homology_basis(surface);
        ASSERT_EQ(basis.size(), c.loops);
        ASSERT_EQ(basis.cochains.cols(), c.loops);
        for (int l = 0; l < c.loops; ++l) {
            const std::vector<int>& loop = basis.loops[l];
            EXPECT_EQ(std::set<int>(loop.begin(), loop.end()).size(), loop.size());
            EXPECT_EQ(homology_class(surface.topology, basis, loop), Eigen::VectorXi::Unit(c.loops, l));
            EXPECT_GT(basis.lengths[l], 0);
        }
        for (int f = 0; f < c.mesh.face_count(); ++f) {
            const auto face = c.mesh.faces[f];
            EXPECT_TRUE(homology_class(surface.topology, basis, face).isZero());
        }
    }
}

TEST(Homology, IntersectionsAreThoseOfTheFormsAndUnimodular) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        const Surface surface(c.mesh);
        const HomologyBasis basis = homology_basis(surface);
        const MatrixXi& N = basis.intersections;
        EXPECT_EQ(N, -N.transpose());
        const MatrixXi P = symplectic_basis(N);
        EXPECT_EQ(P.transpose() * N * P, standard(c.genus, c.loops));
        if (c.loops > 0) {
            EXPECT_EQ(std::lround(std::abs(P.cast<double>().determinant())), 1);
        }
        if (!surface.topology.boundary_loops.empty() || c.loops == 0) continue;
        const MatrixXd wedges = wedge_products(surface, basis.cochains.cast<double>());
        EXPECT_LT((wedges - matrix_inverse(N.cast<double>()).transpose()).cwiseAbs().maxCoeff(), 1e-12);
    }
}

TEST(Homology, MeridianAndParallelOfATorusCrossOnce) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const int nu = 9, nv = 6;
        const Surface surface(torus(2, 1, nu, nv, cells));
        const HomologyBasis basis = homology_basis(surface);
        const auto [u, v] = test::parallel_and_meridian(nu, nv);
        const Eigen::VectorXi along_u = homology_class(surface.topology, basis, u),
                              along_v = homology_class(surface.topology, basis, v);
        EXPECT_EQ(along_u.dot(basis.intersections * along_v), 1);
        const std::vector<int> back(v.rbegin(), v.rend());
        EXPECT_EQ(homology_class(surface.topology, basis, back), -along_v);
        // The shortest loop of all goes round the tube.
        EXPECT_EQ(homology_class(surface.topology, basis, basis.loops[0]).cwiseAbs(), Eigen::Vector2i(1, 0));
        EXPECT_EQ(along_v.cwiseAbs(), Eigen::Vector2i(1, 0));
    }
}

TEST(Homology, BoundaryLoopsOfABorderedSurfaceCrossNothing) {
    const Surface surface(without_faces(torus(2, 1, 16, 12), {0, 100, 200}));
    const HomologyBasis basis = homology_basis(surface);
    Eigen::VectorXi sum = Eigen::VectorXi::Zero(basis.size());
    for (const auto& loop : surface.topology.boundary_loops) {
        const Eigen::VectorXi of_loop = homology_class(surface.topology, basis, loop);
        EXPECT_FALSE(of_loop.isZero());
        EXPECT_TRUE((basis.intersections * of_loop).isZero());
        sum += of_loop;
    }
    EXPECT_TRUE(sum.isZero());  // together they bound the surface
}

TEST(Homology, TheNormalFormIsFoundForAnyUnimodularChangeOfBasis) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 40; ++trial) {
        const int genus = 1 + trial % 4, size = 2 * genus + trial % 3;
        MatrixXi Q = MatrixXi::Identity(size, size);
        for (int step = 0; step < 12; ++step) {
            const auto i = static_cast<int>(random() % size), j = static_cast<int>(random() % size);
            if (i != j) Q.col(i) += (static_cast<int>(random() % 5) - 2) * Q.col(j);
        }
        const MatrixXi N = Q.transpose() * standard(genus, size) * Q;
        const MatrixXi P = symplectic_basis(N);
        EXPECT_EQ(P.transpose() * N * P, standard(genus, size));
        EXPECT_NEAR(std::abs(P.cast<double>().determinant()), 1, 1e-6);
    }
}

TEST(Homology, RefusesPathsWithoutEdgesAndSeveralComponents) {
    const Surface surface(torus(2, 1, 9, 6));
    const HomologyBasis basis = homology_basis(surface);
    EXPECT_EQ(test::cause_of([&] {
                  homology_class(surface.topology, basis, std::vector<int>{0, 25, 3});
              }),
              Cause::bad_option);
    Mesh two = torus(2, 1, 9, 6);
    const int n = two.vertex_count(), faces = two.face_count();
    two.positions.conservativeResize(2 * n, 3);
    two.positions.bottomRows(n) = two.positions.topRows(n).array() + 9;
    for (int f = 0; f < faces; ++f) {
        const auto v = two.faces[f];
        two.faces.add({v[0] + n, v[1] + n, v[2] + n});
    }
    EXPECT_EQ(test::cause_of([&] { homology_basis(Surface(two)); }), Cause::bad_mesh);
}

TEST(HarmonicBasis, FormsAreClosedCoclosedAndOfLeastEnergyInTheirClasses) {
    for (const Case& c : cases()) {
        if (c.loops == 0) continue;
        SCOPED_TRACE(c.name);
        const Surface surface(c.mesh);
        const HarmonicBasis basis = harmonic_basis(surface);
        const Topology& t = surface.topology;
        double largest = 0;
        for (int f = 0; f < c.mesh.face_count(); ++f) {
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(c.loops);
            for (int i = 0; i < c.mesh.faces.degree(f); ++i) {
                const int corner = c.mesh.faces.first_corner(f) + i, e = t.corner_edges[corner];
                sum += (t.edges[e][0] == c.mesh.faces.vertices()[corner] ? 1 : -1) * basis.forms.row(e);
            }
            largest = std::max(largest, sum.cwiseAbs().maxCoeff());
        }
        EXPECT_LT(largest, 1e-12);
        for (int l = 0; l < c.loops; ++l) {
            Eigen::RowVectorXd period = Eigen::RowVectorXd::Zero(c.loops);
            const auto& loop = basis.homology.loops[l];
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const int a = loop[i], b = loop[(i + 1) % loop.size()];
                const auto edge =
                    std::lower_bound(t.edges.begin(), t.edges.end(), std::array{std::min(a, b), std::max(a, b)}) -
                    t.edges.begin();
                period += (a < b ? 1 : -1) * basis.forms.row(edge);
            }
            EXPECT_LT((period - Eigen::RowVectorXd::Unit(c.loops, l)).cwiseAbs().maxCoeff(), 1e-11);
        }
        EXPECT_GT(symmetric_eigen(basis.energies).values[0], 0);
    }
}

TEST(HarmonicBasis, AnnulusHasTheEnergyOfItsAngle) {
    // The form of period 1 is dθ/2π: energy log(1/r)/2π.
    double before = 0;
    for (const int around : {24, 48, 96}) {
        const HarmonicBasis basis = harmonic_basis(Surface(annulus(0.5, 1, around)));
        ASSERT_EQ(basis.homology.size(), 1);
        const double error = std::abs(basis.energies(0, 0) - std::log(2.0) / (2 * std::numbers::pi));
        if (before > 0) {
            EXPECT_GT(std::log2(before / error), 1.9);
        }
        before = error;
    }
    EXPECT_LT(before, 1e-4);
}

/// τ of a marking by the parallel and the meridian.
Complex tau_in(const Surface& surface, const std::vector<int>& a, const std::vector<int>& b) {
    const HarmonicBasis basis = harmonic_basis(surface);
    const PeriodMatrix matrix = period_matrix(surface, basis);
    const MatrixXd to_basis = matrix_inverse(matrix.basis.cast<double>());
    const Eigen::Vector2d in_a = to_basis * homology_class(surface.topology, basis.homology, a).cast<double>(),
                          in_b = to_basis * homology_class(surface.topology, basis.homology, b).cast<double>();
    const Complex tau = matrix.periods(0, 0);
    return (in_b[0] + tau * in_b[1]) / (in_a[0] + tau * in_a[1]);
}

TEST(PeriodMatrix, TorusOfRevolutionToSecondOrder) {
    // (R, r, nv/nu): τ = i r/√(R² − r²), a along the parallel.
    struct Shape {
        double major, minor, bound;
    };
    for (const Shape& s : {Shape{2, 1, 1.3e-3}, Shape{std::sqrt(2.0), 1, 4e-3}, Shape{4, 1.7, 1e-3}}) {
        double before = 0;
        for (const int nu : {16, 32, 64}) {
            const int nv = nu / 2;
            const Surface surface(torus(s.major, s.minor, nu, nv));
            const auto [parallel, meridian] = test::parallel_and_meridian(nu, nv);
            const Complex exact(0, s.minor / std::sqrt(s.major * s.major - s.minor * s.minor));
            const double error = std::abs(tau_in(surface, parallel, meridian) - exact);
            if (before > 0) {
                EXPECT_GT(std::log2(before / error), 1.8) << nu;
            }
            before = error;
        }
        EXPECT_LT(before, s.bound);
    }
}

/// Renumbered and turned: vertices and faces in another order, faces starting elsewhere.
Mesh shuffled(const Mesh& mesh, std::vector<int>& new_number) {
    std::mt19937 random(11);
    new_number.resize(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(new_number.begin(), new_number.end(), 0);
    std::shuffle(new_number.begin(), new_number.end(), random);
    std::vector<int> order(static_cast<std::size_t>(mesh.face_count()));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    Mesh result = mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) result.positions.row(new_number[v]) = mesh.positions.row(v);
    result.faces = {};
    for (const int f : order) {
        std::vector<int> face;
        const auto v = mesh.faces[f];
        const auto n = static_cast<int>(v.size());
        for (int i = 0; i < n; ++i) face.push_back(new_number[v[(i + 1) % n]]);
        result.faces.add(face);
    }
    return result;
}

TEST(PeriodMatrix, SymmetricPositiveAndInvariantUnderScaleAndNumbering) {
    for (const Case& c : cases()) {
        const Surface surface(c.mesh);
        if (c.genus == 0 || !surface.topology.boundary_loops.empty()) continue;
        SCOPED_TRACE(c.name);
        const HarmonicBasis basis = harmonic_basis(surface);
        const PeriodMatrix matrix = period_matrix(surface, basis);
        const int g = c.genus;
        ASSERT_EQ(matrix.periods.rows(), g);
        EXPECT_LT((matrix.periods - matrix.periods.transpose()).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_GT(symmetric_eigen(matrix.periods.imag()).values[0], 0.05);

        Mesh larger = c.mesh;
        larger.positions *= 1e9;
        const Surface scaled(larger);
        const PeriodMatrix of_scaled = period_matrix(scaled, harmonic_basis(scaled));
        EXPECT_EQ(of_scaled.basis, matrix.basis);
        EXPECT_LT((of_scaled.periods - matrix.periods).cwiseAbs().maxCoeff(), 1e-10);

        // The loops of the other numbering, in the basis of this one: an integer symplectic matrix of blocks.
        std::vector<int> number;
        const Mesh other_mesh = shuffled(c.mesh, number);
        std::vector<int> old(number.size());
        for (std::size_t v = 0; v < number.size(); ++v) old[number[v]] = static_cast<int>(v);
        const Surface other(other_mesh);
        const HarmonicBasis other_basis = harmonic_basis(other);
        const PeriodMatrix other_matrix = period_matrix(other, other_basis);
        MatrixXi classes(2 * g, 2 * g);
        for (int l = 0; l < 2 * g; ++l) {
            std::vector<int> path;
            for (const int v : other_basis.homology.loops[l]) path.push_back(old[v]);
            classes.col(l) = homology_class(surface.topology, basis.homology, path);
        }
        const MatrixXd R = matrix_inverse(matrix.basis.cast<double>()) * (classes * other_matrix.basis).cast<double>();
        const Eigen::MatrixXcd around_a = R.topLeftCorner(g, g) + matrix.periods * R.bottomLeftCorner(g, g),
                               around_b = R.topRightCorner(g, g) + matrix.periods * R.bottomRightCorner(g, g);
        EXPECT_LT((around_a.inverse() * around_b - other_matrix.periods).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(PeriodMatrix, TheDefectFallsWithTheSquareOfTheEdges) {
    double before = 0;
    for (const double edge : {0.2, 0.1, 0.05}) {
        const Surface surface(double_torus(edge));
        const double defect = period_matrix(surface, harmonic_basis(surface)).defect;
        if (before > 0) {
            EXPECT_GT(std::log2(before / defect), 1.7);
        }
        before = defect;
    }
}

TEST(PeriodMatrix, HolomorphicFormsHaveThesePeriods) {
    const Surface surface(double_torus(0.15));
    const HarmonicBasis basis = harmonic_basis(surface);
    const PeriodMatrix matrix = period_matrix(surface, basis);
    // ½ i ∫ ω_i ∧ conj ω_j = Im Π (Riemann's bilinear relation), and ∫ ω_i ∧ ω_j = 0.
    MatrixXd parts(surface.topology.edge_count(), 4);
    parts << matrix.forms.real(), matrix.forms.imag();
    const MatrixXd wedges = wedge_products(surface, parts);
    const MatrixXd xx = wedges.topLeftCorner(2, 2), xy = wedges.topRightCorner(2, 2),
                   yx = wedges.bottomLeftCorner(2, 2), yy = wedges.bottomRightCorner(2, 2);
    EXPECT_LT((0.5 * (xy - yx) - matrix.periods.imag()).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((xx + yy).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((xx - yy).cwiseAbs().maxCoeff() + (xy + yx).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(PeriodMatrix, QuadsAndTrianglesOfOneTorusAgree) {
    const auto [parallel, meridian] = test::parallel_and_meridian(48, 32);
    const Complex triangles = tau_in(Surface(torus(2, 1, 48, 32)), parallel, meridian),
                  quads = tau_in(Surface(torus(2, 1, 48, 32, Cells::quads)), parallel, meridian);
    EXPECT_LT(std::abs(triangles - quads), 2e-3);
}

TEST(PeriodMatrix, RefusesSpheresAndBoundaries) {
    for (const Mesh& mesh : {icosahedral_sphere(1), without_faces(torus(2, 1, 11, 7), {3})}) {
        const Surface surface(mesh);
        const HarmonicBasis basis = harmonic_basis(surface);
        EXPECT_EQ(test::cause_of([&] { period_matrix(surface, basis); }), Cause::bad_mesh);
    }
}

}  // namespace
}  // namespace beltrami
