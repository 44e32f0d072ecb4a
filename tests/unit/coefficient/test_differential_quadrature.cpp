#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/parallel.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/coefficient/differential_quadrature.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// One function: (z − centre)^power.
class Power final : public DifferentialSpace {
  public:
    Power(Complex centre, int power) : centre_(centre), power_(power) {}
    int size() const override { return 1; }
    bool complex_coefficients() const override { return true; }
    Eigen::MatrixXcd generators(const ChartPoints& points) const override {
        Eigen::MatrixXcd values(points.positions.size(), 1);
        for (Eigen::Index i = 0; i < values.rows(); ++i)
            values(i, 0) =
                std::pow(points.positions[i] - centre_, power_) * points.derivatives[i] * points.derivatives[i];
        return values;
    }
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

  private:
    Complex centre_;
    int power_;
};

Mesh triangle(Complex a, Complex b, Complex c) {
    Mesh mesh;
    mesh.positions.resize(3, 2);
    mesh.positions << a.real(), a.imag(), b.real(), b.imag(), c.real(), c.imag();
    mesh.faces.add({0, 1, 2});
    return mesh;
}

struct Sums {
    double abs = 0, area = 0;
    Complex phi = 0;
    int points = 0;
    double unresolved = 0;
};

Sums integrate(const Surface& surface, const Chart& chart, const DifferentialSpace& space,
               const QuadratureOptions& options = {}) {
    Sums sums;
    sums.unresolved = visit_quadrature(
        surface, chart, space, Eigen::VectorXcd::Ones(1),
        [&](const FacePoint& p) {
            sums.abs += p.weight * std::abs(p.phi);
            sums.phi += p.weight * p.phi;
            sums.area += p.weight;
            ++sums.points;
        },
        options);
    return sums;
}

Sums integrate(const Mesh& mesh, const DifferentialSpace& space, const QuadratureOptions& options = {}) {
    const Surface surface(mesh);
    return integrate(surface, make_chart(surface, test::complex_positions(mesh), true), space, options);
}

// Over the triangle 0, b, c in polar coordinates with t against the height of length d: r runs to d/cos t.
struct Wedge {
    double distance, from, to;
    Complex height;  ///< direction
    Wedge(Complex b, Complex c) {
        const Complex along = (c - b) / std::abs(c - b);
        height = Complex(0, -1) * along;
        distance = std::real(b * std::conj(height));
        from = std::arg(b / height);
        to = std::arg(c / height);
    }
    static double log_tan(double t) { return std::log(std::tan(std::numbers::pi / 4 + t / 2)); }
    /// ∫∫ 1/r · r dr dt
    double of_inverse() const { return distance * (log_tan(to) - log_tan(from)); }
    /// ∫∫ r · r dr dt = d³/3 ∫ sec³
    double of_length() const {
        const auto primitive = [](double t) { return 0.5 * (std::tan(t) / std::cos(t) + log_tan(t)); };
        return std::pow(distance, 3) / 3 * (primitive(to) - primitive(from));
    }
    /// ∫∫ 1/z dA = d conj(height) ∫ e^{−it}/cos t dt
    Complex of_reciprocal() const {
        return distance * std::conj(height) * Complex(to - from, std::log(std::cos(to) / std::cos(from)));
    }
};

TEST(DifferentialQuadrature, ClosedFormsWithAPoleOrAZeroAtAVertex) {
    for (const auto& [b, c] : {std::pair{Complex(1, 0), Complex(0.5, 0.8)},
                               {Complex(0.7, 0.1), Complex(0.65, 0.3)},
                               {Complex(-1, 0.2), Complex(-0.2, -3)}}) {
        const Wedge wedge(b, c);
        const Sums pole = integrate(triangle(0, b, c), Power(0, -1)), zero = integrate(triangle(0, b, c), Power(0, 1));
        EXPECT_NEAR(pole.abs / wedge.of_inverse(), 1, 2e-6);
        EXPECT_LT(std::abs(pole.phi - wedge.of_reciprocal()), 2e-6 * pole.abs);
        EXPECT_NEAR(zero.abs / wedge.of_length(), 1, 2e-6);
        EXPECT_LT(std::abs(zero.phi - 0.5 * std::imag(std::conj(b) * c) * (b + c) / 3.0), 1e-12);
        EXPECT_EQ(pole.unresolved, 0);
        EXPECT_LT(pole.points, 10000);
    }
}

TEST(DifferentialQuadrature, ConvergesWithTheVariationAllowed) {
    const Wedge wedge({1, 0}, {0.5, 0.8});
    double error[2];
    for (const int i : {0, 1}) {
        QuadratureOptions options;
        options.variation = i ? 0.15 : 0.6;
        options.tolerance = 1e-14;
        error[i] =
            std::abs(integrate(triangle(0, {1, 0}, {0.5, 0.8}), Power(0, -1), options).abs / wedge.of_inverse() - 1);
    }
    EXPECT_LT(error[0], 1e-3);
    EXPECT_LT(error[1], error[0] / 30);
}

TEST(DifferentialQuadrature, APoleOutsideAndPolynomials) {
    // 1/(z+ε)² over a half-disc-like fan of triangles has no closed form as simple; compare two accuracies.
    QuadratureOptions fine;
    fine.variation = 0.05;
    const Power near({-1e-4, 0}, -2);
    const Mesh mesh = triangle({0, -1}, {1, 0}, {0, 1});
    EXPECT_NEAR(integrate(mesh, near).abs / integrate(mesh, near, fine).abs, 1, 1e-5);
    const Sums one = integrate(test::mixed_square(6), Power(0, 0));
    EXPECT_NEAR(one.area, 1, 1e-12);
    EXPECT_NEAR(one.abs, 1, 1e-12);
    const Sums square = integrate(test::mixed_square(6), Power(0, 2));  // ∫(x² − y² + 2ixy)
    EXPECT_LT(std::abs(square.phi - Complex(0, 0.5)), 1e-12);
}

TEST(DifferentialQuadrature, QuadsHaveTheirOwnPoints) {
    const Sums quads = integrate(test::quad_square(5, 0.2), Power({-0.05, -0.05}, -1)),
               triangles = integrate(test::jittered_square(5), Power({-0.05, -0.05}, -1));
    EXPECT_NEAR(quads.abs / triangles.abs, 1, 1e-4);
    EXPECT_LT(std::abs(quads.phi - triangles.phi), 1e-4 * quads.abs);
}

TEST(DifferentialQuadrature, AnalyticChartsAreEvaluatedAtThePoints) {
    // ∫ over the annulus of the chart z → 1/z (radii .25 and 1 change places): ∫|w^n| |w'|² dA is the same over the
    // image.
    const Mesh mesh = annulus(0.25, 1, 24);
    const Surface surface(mesh);
    const Chart chart = domain_chart(surface, 1);
    ASSERT_TRUE(chart.exact && chart.analytic);
    // The image is the ring between two curves of arcs; its area by Green's formula along the arcs.
    double area = 0;
    for (const auto& loop : surface.topology.boundary_loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Complex a(mesh.positions(loop[i], 0), mesh.positions(loop[i], 1)),
                b(mesh.positions(loop[(i + 1) % loop.size()], 0), mesh.positions(loop[(i + 1) % loop.size()], 1));
            Complex last = chart.analytic(a)[0];
            for (int j = 1; j <= 400; ++j) {
                const Complex next = chart.analytic(a + (b - a) * (j / 400.0))[0];
                area += 0.5 * std::imag(std::conj(last) * next);
                last = next;
            }
        }
    Chart interpolated = chart;
    interpolated.analytic = nullptr;
    const double exact = integrate(surface, chart, Power(0, 0)).abs,
                 rough = integrate(surface, interpolated, Power(0, 0)).abs;
    EXPECT_NEAR(exact / area, 1, 2e-5);
    EXPECT_GT(std::abs(rough / area - 1), 1e-4);
}

TEST(DifferentialQuadrature, WhatIsNotFiniteIsSaid) {
    class Bad final : public DifferentialSpace {
      public:
        int size() const override { return 1; }
        bool complex_coefficients() const override { return true; }
        Eigen::MatrixXcd generators(const ChartPoints& points) const override {
            return Eigen::MatrixXcd::Constant(points.positions.size(), 1, std::nan(""));
        }
        std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }
    };
    QuadratureOptions options;
    options.most_depth = 3;
    EXPECT_EQ(integrate(triangle(0, 1, Complex(0, 1)), Bad(), options).unresolved,
              std::numeric_limits<double>::infinity());
    EXPECT_GT(integrate(triangle(0, 1, Complex(0, 1)), Power(0, -1), options).unresolved, 0.01);
}

TEST(DifferentialQuadrature, SameBytesOnAnyNumberOfThreads) {
    const int threads = thread_count();
    set_thread_count(1);
    const Sums one = integrate(disk(20), Power({0.3, 0.1}, -1));
    set_thread_count(3);
    const Sums three = integrate(disk(20), Power({0.3, 0.1}, -1));
    set_thread_count(threads);
    EXPECT_EQ(one.abs, three.abs);
    EXPECT_EQ(one.phi, three.phi);
}

}  // namespace
}  // namespace beltrami
