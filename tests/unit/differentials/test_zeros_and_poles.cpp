#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/differentials/zeros_and_poles.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/sphere/atlas.h>

#include "support/meshes.h"
#include "support/onto.h"

namespace beltrami {
namespace {

using Expected = std::vector<std::pair<Complex, int>>;

/// Exactly these, at these places of the plane.
void expect_points(const Eigen::VectorXcd& z, const std::vector<CriticalPoint>& found, const Expected& expected,
                   double tolerance) {
    EXPECT_EQ(found.size(), expected.size());
    for (const auto& [at, order] : expected) {
        SCOPED_TRACE(at);
        const auto near = std::find_if(found.begin(), found.end(), [&](const CriticalPoint& point) {
            return std::abs(point.place.interpolate(z) - at) < tolerance;
        });
        ASSERT_NE(near, found.end());
        EXPECT_EQ(near->order, order);
        for (const double weight : near->place.barycentric) EXPECT_GE(weight, 0);
    }
}

/// 2 (orders inside) + (orders on the boundary).
int doubled(const std::vector<CriticalPoint>& points) {
    int sum = 0;
    for (const CriticalPoint& point : points) sum += point.order * (point.on_boundary ? 1 : 2);
    return sum;
}

int vertex_at(const CriticalPoint& point) {
    const auto& weights = point.place.barycentric;
    return point.place.vertices[std::max_element(weights.begin(), weights.end()) - weights.begin()];
}

Mesh moved(Mesh mesh, Complex a, Complex b) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z = a * Complex(mesh.positions(v, 0), mesh.positions(v, 1)) + b;
        mesh.positions.row(v) << z.real(), z.imag();
    }
    return mesh;
}

Mesh counted_backwards(const Mesh& mesh) {
    Mesh result;
    const int n = mesh.vertex_count();
    result.positions = mesh.positions.colwise().reverse();
    for (int f = mesh.face_count() - 1; f >= 0; --f) {
        std::vector<int> face;
        for (const int v : mesh.faces[f]) face.push_back(n - 1 - v);
        result.faces.add(face);
    }
    return result;
}

TEST(ZerosAndPoles, OfPolynomialsOnTheDisk) {
    const Complex a(0.43, -0.2), b(-0.5, 0.31);
    for (const Mesh& mesh : {disk(9), test::quad_disk(6)})
        for (const int n : {1, 2, 4}) {
            SCOPED_TRACE(n);
            const Surface source(mesh);
            const QuadraticDifferential phi =
                differential_of(source, [&](Complex z) { return std::pow(z, n) * (z - a) * (z - b) * (z - 3.0); });
            const std::vector<CriticalPoint> found = zeros_and_poles(source, phi);
            expect_points(test::complex_positions(mesh), found, {{0, n}, {a, 1}, {b, 1}}, n > 2 ? 1e-3 : 1e-6);
            for (const CriticalPoint& point : found) EXPECT_FALSE(point.on_boundary);
            for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LE(found[i - 1].place.face, found[i].place.face);
        }
}

TEST(ZerosAndPoles, DoNotDependOnScaleSimilaritiesAndNumbers) {
    const Mesh mesh = test::jittered_square(7);
    const Complex a(0.37, 0.61), p = test::complex_positions(mesh)[27], c = std::polar(40.0, 1.0), d(3, 8);
    const auto phi_of = [&](Complex z) { return 1e-9 * (z - a) * (z - a) / (z - p); };
    const Expected expected{{a, 2}, {p, -1}};
    const Surface source(mesh), back(counted_backwards(mesh)), elsewhere(moved(mesh, c, d));
    expect_points(test::complex_positions(mesh), zeros_and_poles(source, differential_of(source, phi_of, {27})),
                  expected, 1e-5);
    expect_points(test::complex_positions(back.mesh),
                  zeros_and_poles(back, differential_of(back, phi_of, {mesh.vertex_count() - 1 - 27})), expected, 1e-5);
    const auto there = [&](Complex w) { return phi_of((w - d) / c) / (c * c); };
    expect_points(test::complex_positions(elsewhere.mesh),
                  zeros_and_poles(elsewhere, differential_of(elsewhere, there, {27})),
                  {{c * a + d, 2}, {c * p + d, -1}}, 4e-4);
}

TEST(ZerosAndPoles, AVertexWithoutAResidueIsNoPole) {
    const Surface source(test::jittered_square(5));
    EXPECT_TRUE(zeros_and_poles(source, differential_of(source, [](Complex) { return Complex(2, 1); }, {14})).empty());
}

/// φ = Π s(zero) / Π s(pole) dζ² in the atlas of the sphere, s vanishing at a point; four more poles than zeros.
class ProductOnSphere final : public DifferentialSpace {
  public:
    ProductOnSphere(std::vector<Eigen::Vector3d> zeros, std::vector<Eigen::Vector3d> poles)
        : zeros_(std::move(zeros)), poles_(std::move(poles)) {}
    int size() const override { return 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override {
        Eigen::MatrixXcd values(points.positions.size(), 1);
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
            const auto [xi, eta] = atlas::spinor(points.positions[i]);
            Complex value = points.derivatives[i] * points.derivatives[i];
            const auto at = [&, a = xi, b = eta](const Eigen::Vector3d& point) {
                const auto [u, v] = atlas::unit_spinor(point);
                return a * v - u * b;
            };
            for (const Eigen::Vector3d& zero : zeros_) value *= at(zero);
            for (const Eigen::Vector3d& pole : poles_) value /= at(pole);
            values(i, 0) = value;
        }
        return values;
    }
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    std::vector<Eigen::Vector3d> zeros_, poles_;
};

TEST(ZerosAndPoles, OnTheSphereAreAllFoundWhereverTheAtlasIsCut) {
    const Mesh upright = icosahedral_sphere(3);
    const std::vector<int> poles{0, 1, 2, 3, 50, 100, 200};
    const Eigen::Vector3d once = Eigen::Vector3d(0.3, -0.8, 0.1).normalized(),
                          twice = Eigen::Vector3d(-0.2, 0.5, 0.9).normalized();
    for (int turn = 0; turn < 16; ++turn) {
        SCOPED_TRACE(turn);
        // The last ones put a zero onto the equator, where the parts of the atlas meet, and one to the south pole.
        Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.4 * turn, Eigen::Vector3d(1, 0.3, -0.5).normalized()));
        if (turn == 14) rotation = Eigen::Quaterniond::FromTwoVectors(once, Eigen::Vector3d::UnitX());
        if (turn == 15) rotation = Eigen::Quaterniond::FromTwoVectors(twice, -Eigen::Vector3d::UnitZ());
        Mesh mesh = upright;
        mesh.positions = upright.positions * rotation.toRotationMatrix().transpose();
        const Surface source(mesh);
        std::vector<Eigen::Vector3d> places;
        for (const int v : poles) places.push_back(mesh.point(v));
        const std::vector<Eigen::Vector3d> zeros{rotation * once, rotation * twice, rotation * twice};
        const QuadraticDifferential phi{
            std::make_shared<ProductOnSphere>(zeros, places),
            std::make_shared<Chart>(make_atlas(source, atlas::corner_places(mesh.faces, mesh.positions))),
            Eigen::VectorXcd::Ones(1),
            poles,
            {}};
        const std::vector<CriticalPoint> found = zeros_and_poles(source, phi);
        ASSERT_EQ(found.size(), poles.size() + 2);
        std::vector<int> at_vertices;
        for (const CriticalPoint& point : found) {
            EXPECT_FALSE(point.on_boundary);
            if (point.order == -1) {
                at_vertices.push_back(vertex_at(point));
                continue;
            }
            Eigen::Vector3d at = Eigen::Vector3d::Zero();
            for (int j = 0; j < 3; ++j) at += point.place.barycentric[j] * mesh.point(point.place.vertices[j]);
            ASSERT_TRUE(point.order == 1 || point.order == 2);
            EXPECT_LT((at.normalized() - rotation * (point.order == 1 ? once : twice)).norm(), 0.01);  // edges of 0.15
        }
        std::sort(at_vertices.begin(), at_vertices.end());
        EXPECT_EQ(at_vertices, poles);
    }
}

TEST(ZerosAndPoles, AtTheRimAreOnTheBoundary) {
    // On the circle, just outside the polygon; in the hole; outside.
    const Surface source(annulus(0.4, 1, 40));
    const auto at = [](double angle) { return std::polar(1.0, angle); };
    const QuadraticDifferential phi =
        differential_of(source, [&](Complex z) { return (z - at(0.3)) * (z - 0.1) * (z - 1.4) * (z - at(2) * 0.7); });
    const std::vector<CriticalPoint> found = zeros_and_poles(source, phi);
    expect_points(test::complex_positions(source.mesh), found, {{at(0.3), 1}, {at(2) * 0.7, 1}}, 0.004);
    for (const CriticalPoint& point : found)
        EXPECT_EQ(point.on_boundary,
                  std::abs(point.place.interpolate(test::complex_positions(source.mesh)) - at(0.3)) < 0.1);
}

TEST(ZerosAndPoles, OfDifferentialsRealAlongTheBoundaryAddUp) {
    struct RealDomain {
        std::vector<test::Hole> holes;
        std::vector<double> marks;  // angles on the outer circle
    };
    for (const auto& [holes, marks] : {RealDomain{{}, {0.1, 1, 2.5, 4}}, RealDomain{{}, {0.1, 1, 2.5, 3.5, 4, 5}},
                                       RealDomain{{{-0.4, 0, 0.2}, {0.4, 0.1, 0.15}}, {}},
                                       RealDomain{{{-0.45, 0, 0.2}, {0.4, 0.35, 0.15}, {0.2, -0.5, 0.2}}, {}},
                                       RealDomain{{{-0.3, 0.1, 0.25}}, {1, 3}}}) {
        SCOPED_TRACE(std::to_string(holes.size()) + " holes, " + std::to_string(marks.size()) + " marks");
        const Surface source(test::disk_with_holes(holes, 0.08));
        const Chart chart = circle_domain_chart(source).chart;
        const auto& loop = source.topology.boundary_loops[chart.outer_loop];
        std::vector<int> marked;
        for (const double angle : marks)
            marked.push_back(*std::min_element(loop.begin(), loop.end(), [&](int a, int b) {
                const auto away = [&](int v) { return std::abs(chart.vertices[v] - std::polar(1.0, angle)); };
                return away(a) < away(b);
            }));
        std::sort(marked.begin(), marked.end());
        const auto space = std::make_shared<LaurentSpace>(*round_domain(source, chart, marked));
        const int euler = source.topology.euler_characteristic;
        for (int trial = 0; trial < 4; ++trial) {
            SCOPED_TRACE(trial);
            Eigen::VectorXcd coefficients(space->size());
            for (int i = 0; i < space->size(); ++i) coefficients[i] = std::cos(1.0 + 3.7 * trial + 2.1 * i);
            const QuadraticDifferential phi{space, std::make_shared<Chart>(chart), coefficients, marked, {}};
            const std::vector<CriticalPoint> found = zeros_and_poles(source, phi);
            EXPECT_EQ(doubled(found), -4 * euler);
            int poles = 0;
            for (const CriticalPoint& point : found) {
                if (point.order < 0) {
                    EXPECT_TRUE(point.on_boundary);
                    ++poles;
                }
            }
            EXPECT_EQ(poles, static_cast<int>(marked.size()));

            // The same, known at the samples only.
            QuadraticDifferential table = differential_of(source, phi.at_samples(source), marked);
            table.space = std::make_shared<TabulatedSpace>(phi.at_samples(source), Coefficients::real);
            const std::vector<CriticalPoint> seen = zeros_and_poles(source, table);
            EXPECT_EQ(doubled(seen), -4 * euler);
            for (const CriticalPoint& point : seen)
                if (point.order < 0) {
                    EXPECT_TRUE(std::binary_search(marked.begin(), marked.end(), vertex_at(point)));
                }
        }
    }
}

TEST(ZerosAndPoles, OfASurfaceInSpaceAreThoseInItsChart) {
    const Surface source(test::bump(3000));
    Eigen::VectorXcd coefficients(4);
    coefficients << 0.05, Complex(0.1, 0.2), 0.6, 1.0;
    const auto chart = std::make_shared<Chart>(domain_chart(source));
    const QuadraticDifferential phi{std::make_shared<PolynomialSpace>(3, 3), chart, coefficients, {}, {}};
    const std::vector<CriticalPoint> found = zeros_and_poles(source, phi);
    EXPECT_EQ(found.size(), 3u);
    for (const CriticalPoint& point : found) {
        const Complex w = point.place.interpolate(chart->vertices);
        const ChartPoints there{Eigen::VectorXcd::Constant(1, w), Eigen::VectorXcd::Ones(1)};
        EXPECT_LT(std::abs(phi.at(there)[0]), 1e-11);
    }
    // Its table has them in the same places, up to an edge.
    const std::vector<CriticalPoint> seen = zeros_and_poles(source, differential_of(source, phi.at_samples(source)));
    Expected expected;
    for (const CriticalPoint& point : found)
        expected.push_back({point.place.interpolate(chart->vertices), point.order});
    expect_points(chart->vertices, seen, expected, 0.01);
}

TEST(ZerosAndPoles, OfATableConverge) {
    double last = 0;
    for (const int rings : {8, 16, 32}) {
        const Mesh mesh = disk(rings);
        const Surface source(mesh);
        const Eigen::VectorXcd z = test::complex_positions(mesh), at = at_samples(source.operators, z);
        double sum = 0;
        for (int i = 0; i < 12; ++i) {
            const Complex a = std::polar(0.75, 1.3 * i), b = std::polar(0.35, 0.5 + 0.9 * i);
            const auto phi_of = [&](Complex p) { return (p - a) * (p - b) * std::exp(p); };
            const std::vector<CriticalPoint> found =
                zeros_and_poles(source, differential_of(source, Eigen::VectorXcd(at.unaryExpr(phi_of))));
            ASSERT_EQ(found.size(), 2u);
            for (const CriticalPoint& point : found) {
                EXPECT_EQ(point.order, 1);
                const Complex place = point.place.interpolate(z);
                sum += std::min(std::norm(place - a), std::norm(place - b));
            }
        }
        const double error = std::sqrt(sum / 24);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.7) << error;
        }
        last = error;
    }
    EXPECT_LT(last, 7e-4);
}

TEST(ZerosAndPoles, OfATableOnQuadsWithAPole) {
    const Mesh mesh = test::quad_square(12, 0.2);
    const Surface source(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const Complex p = z[13 * 6 + 6], a(0.25, 0.3);
    const auto phi_of = [&](Complex at) { return (at - a) / (at - p); };
    const std::vector<CriticalPoint> found = zeros_and_poles(
        source, differential_of(source, Eigen::VectorXcd(at_samples(source.operators, z).unaryExpr(phi_of)), {78 + 6}));
    expect_points(z, found, {{a, 1}, {p, -1}}, 0.01);
}

TEST(ZerosAndPoles, OfNothing) {
    const Surface source(disk(4)), other(disk(5));
    EXPECT_TRUE(zeros_and_poles(source, QuadraticDifferential()).empty());
    EXPECT_THROW(
        zeros_and_poles(
            other, differential_of(source, Eigen::VectorXcd(Eigen::VectorXcd::Ones(source.operators.sample_count())))),
        Error);
}

}  // namespace
}  // namespace beltrami
