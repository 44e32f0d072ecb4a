#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

const std::vector<Circle> kCircles = {{{-0.45, 0.1}, 0.2}, {{0.35, 0.3}, 0.15}, {{0.2, -0.45}, 0.25}};

Complex centre_of(const Circle& circle) {
    return {circle.centre.x(), circle.centre.y()};
}

Mesh three_holes(double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return circle_domain({}, kCircles, options);
}

std::vector<RoundHole> truth() {
    std::vector<RoundHole> holes;
    for (const Circle& circle : kCircles) holes.push_back({-1, centre_of(circle), circle.radius});
    return holes;
}

/// The hyperbolic distances between the circles, the unit circle among them: what Möbius maps keep, sorted, since loops
/// come in another order.
std::vector<double> moduli(std::vector<RoundHole> holes) {
    holes.push_back({-1, 0, 1});
    std::vector<double> result;
    for (std::size_t i = 0; i < holes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const RoundHole &a = holes[i], &b = holes[j];
            const double squares = std::norm(a.centre - b.centre) - a.radius * a.radius - b.radius * b.radius;
            result.push_back(std::acosh(std::abs(squares) / (2 * a.radius * b.radius)));
        }
    std::sort(result.begin(), result.end());
    return result;
}

double moduli_error(const CircleDomainChart& chart) {
    const std::vector<double> found = moduli(chart.holes), known = moduli(truth());
    double worst = 0;
    for (std::size_t i = 0; i < known.size(); ++i) worst = std::max(worst, std::abs(found[i] / known[i] - 1));
    return worst;
}

/// What every chart promises.
void check(const Surface& source, const CircleDomainChart& chart, int outer_loop) {
    const auto& loops = source.topology.boundary_loops;
    EXPECT_EQ(chart.outer_loop(), outer_loop);
    ASSERT_EQ(chart.holes.size() + 1, loops.size());
    ASSERT_EQ(chart.chart.holes.size(), chart.holes.size());
    for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
        const RoundHole circle = chart.circle(l);
        double turned = 0;
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const Complex arm = chart.chart.vertices[loops[l][i]] - circle.centre,
                          next = chart.chart.vertices[loops[l][(i + 1) % loops[l].size()]] - circle.centre;
            EXPECT_NEAR(std::abs(arm), circle.radius, 4e-16);
            const double increment = std::arg(next * std::conj(arm)) * (l == outer_loop ? 1 : -1);
            EXPECT_GT(increment, 0);
            turned += increment;
        }
        EXPECT_NEAR(turned, 2 * std::numbers::pi, 1e-9);
    }
    EXPECT_GT(least_gap(chart.holes), 0);
    EXPECT_TRUE(chart.flipped.empty());
    EXPECT_TRUE(chart.converged);
    const Distortion map = distortion(source.operators, chart.chart.vertices);
    EXPECT_EQ(chart.mean_mu, map.mean);
    EXPECT_EQ(chart.max_mu, map.max);
    EXPECT_LT(map.max, 1);
}

TEST(CircleDomainChart, APlanarCircleDomainIsItsOwn) {
    Mesh mesh = three_holes(0.1);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    mesh.positions = (3e5 * mesh.positions).rowwise() + Eigen::RowVector2d(7e5, -2e5);
    const Surface source(mesh);
    const CircleDomainChart chart = circle_domain_chart(source);
    check(source, chart, 0);
    EXPECT_TRUE(chart.chart.exact);
    EXPECT_EQ(chart.steps, 0);
    EXPECT_EQ(chart.factorizations, 0);
    EXPECT_LT((chart.chart.vertices - z).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(moduli_error(chart), 1e-8);
    for (int outer = 1; outer < 4; ++outer) {
        const CircleDomainChart turned = circle_domain_chart(source, outer);
        check(source, turned, outer);
        EXPECT_TRUE(turned.chart.exact);
        EXPECT_LT(moduli_error(turned), 1e-8);
    }
}

TEST(CircleDomainChart, OfAConformalImageHasTheModuliOfTheOriginalToSecondOrder) {
    const auto wavy = [](Complex z) { return std::exp(0.9 * z) * Complex(1, 0.3) + 0.1 * z * z * z; };
    for (const bool in_space : {false, true}) {
        double coarse = 0;
        for (const double h : {0.1, 0.05, 0.025}) {
            const Surface source(in_space ? test::on_sphere(three_holes(h)) : test::moved(three_holes(h), wavy));
            const CircleDomainChart chart = circle_domain_chart(source);
            check(source, chart, 0);
            EXPECT_FALSE(chart.chart.exact);
            EXPECT_LT(chart.steps, 8);
            const double error = moduli_error(chart);
            EXPECT_LT(error, 0.3 * h * h);
            if (coarse > 0) {
                EXPECT_LT(error, coarse / 3.4);  // order 1.77 at least
            }
            coarse = error;
        }
    }
}

TEST(CircleDomainChart, AnyLoopCanBeTheOuterOne) {
    const Surface coarse(test::on_sphere(three_holes(0.05))), fine(test::on_sphere(three_holes(0.0125)));
    // A hole's chords lie outside the surface's own domain, the unit circle's inside: the errors of the two polygons,
    // about (π/25)² here, add up.
    for (int outer = 1; outer < 4; ++outer) {
        const CircleDomainChart a = circle_domain_chart(coarse, outer), b = circle_domain_chart(fine, outer);
        check(coarse, a, outer);
        check(fine, b, outer);
        EXPECT_LT(moduli_error(a), 0.02);
        EXPECT_LT(moduli_error(b), moduli_error(a) / 11);  // order 1.73 at least
    }
}

TEST(CircleDomainChart, StaysExactWhereAnAnalyticMapMakesTheHolesRound) {
    CircleMap map;
    for (const Circle& circle : kCircles) {
        map.poles.push_back({centre_of(circle), circle.radius, Eigen::VectorXcd(3)});
        map.poles.back().coefficients << Complex(0.004, 0.002), Complex(0.01, -0.004), Complex(0.002, 0.006);
    }
    const Surface source(test::moved(three_holes(0.025), [&](Complex z) { return map(z)[0]; }));
    const CircleDomainChart exact = circle_domain_chart(source);
    check(source, exact, 0);
    EXPECT_TRUE(exact.chart.exact);
    EXPECT_LT(exact.roundness, 3e-4);
    EXPECT_LT(moduli_error(exact), 1e-7);
    // The derivative is that of the map itself.
    const auto& analytic = exact.chart.analytic;
    ASSERT_TRUE(analytic);
    for (const Complex z : {Complex(0.1, 0.1), Complex(-0.7, -0.3)}) {
        const double step = 1e-5;
        const Complex slope = (analytic(z + step)[0] - analytic(z - step)[0]) / (2 * step);
        EXPECT_LT(std::abs(slope - analytic(z)[1]), 1e-8);
    }
    CircleDomainOptions options;
    options.exact_part = 0;
    const CircleDomainChart sliding = circle_domain_chart(source, 0, options);
    check(source, sliding, 0);
    EXPECT_FALSE(sliding.chart.exact);
    EXPECT_LT(moduli_error(sliding), 1e-4);
    EXPECT_GT(moduli_error(sliding), 10 * moduli_error(exact));
}

TEST(CircleDomainChart, LowersTheConformalEnergyToAMinimum) {
    const Surface source(test::on_sphere(three_holes(0.1)));
    const CircleDomainChart chart = circle_domain_chart(source);
    const auto energy = [&](const Eigen::VectorXcd& f) {
        double sum = 0;
        for (int s = 0; s < source.operators.sample_count(); ++s)
            sum += source.operators.weights[s] * std::norm(source.operators.derivatives(s, f)[1]);
        return sum;
    };
    const double least = energy(chart.chart.vertices);
    // Any motion of one circle, or of one rim vertex along its circle, costs energy of second order.
    for (const RoundHole& hole : chart.holes) {
        const auto& rim = source.topology.boundary_loops[hole.loop];
        for (const double step : {1e-3, -1e-3}) {
            Eigen::VectorXcd shifted = chart.chart.vertices, raised = shifted, grown = shifted, slid = shifted;
            for (const int v : rim) {
                shifted[v] += step;
                raised[v] += Complex(0, step);
                grown[v] += step * (grown[v] - hole.centre);
            }
            slid[rim[3]] = hole.centre + (slid[rim[3]] - hole.centre) * std::polar(1.0, step);
            for (const Eigen::VectorXcd* f : {&shifted, &raised, &grown, &slid}) {
                const double rise = energy(*f) - least;
                EXPECT_GT(rise, 0);
                EXPECT_LT(rise, 20 * step * step);
            }
        }
    }
}

TEST(CircleDomainChart, DoesNotDependOnPlaceSizeOrNumbering) {
    const Mesh mesh = test::on_sphere(three_holes(0.1));
    const CircleDomainChart chart = circle_domain_chart(Surface(mesh));
    Mesh moved = mesh;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    moved.positions = (40 * mesh.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -3, 100);
    const CircleDomainChart turned = circle_domain_chart(Surface(moved));
    for (std::size_t i = 0; i < moduli(chart.holes).size(); ++i)
        EXPECT_NEAR(moduli(chart.holes)[i], moduli(turned.holes)[i], 1e-6);
    EXPECT_NEAR(chart.mean_mu, turned.mean_mu, 1e-6);

    const int n = mesh.vertex_count();
    Mesh renumbered;
    renumbered.positions.resize(n, 3);
    for (int v = 0; v < n; ++v) renumbered.positions.row(n - 1 - v) = mesh.positions.row(v);
    for (int f = mesh.face_count() - 1; f >= 0; --f) {
        const auto v = mesh.faces[f];
        renumbered.faces.add({n - 1 - v[0], n - 1 - v[1], n - 1 - v[2]});
    }
    const CircleDomainChart other = circle_domain_chart(Surface(renumbered));
    for (std::size_t i = 0; i < moduli(chart.holes).size(); ++i)
        EXPECT_NEAR(moduli(chart.holes)[i], moduli(other.holes)[i], 5e-4);  // other vertices are held
}

TEST(CircleDomainChart, IsTheSameForAnyNumberOfThreads) {
    const Surface source(test::on_sphere(three_holes(0.025)));
    const int before = thread_count();
    set_thread_count(1);
    const CircleDomainChart one = circle_domain_chart(source);
    set_thread_count(3);
    const CircleDomainChart three = circle_domain_chart(source);
    set_thread_count(before);
    EXPECT_EQ(one.chart.vertices, three.chart.vertices);
}

TEST(CircleDomainChart, ReadsQuadsAndAMetricOfItsOwn) {
    // The upper half of a rectangle with an opening, in quads.
    Mesh quads;
    const int n = 24;
    quads.positions.resize((n + 1) * (n + 1), 2);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) quads.positions.row(j * (n + 1) + i) << i + 0.3 * std::sin(0.4 * j), j;
    std::vector<char> used((n + 1) * (n + 1), 0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            if (i >= 6 && i < 14 && j >= 8 && j < 18) continue;
            const int a = j * (n + 1) + i;
            quads.faces.add({a, a + 1, a + n + 2, a + n + 1});
        }
    const Surface plane(quads);
    const CircleDomainChart chart = circle_domain_chart(plane);
    check(plane, chart, 0);
    EXPECT_LT(chart.mean_mu, 0.08);

    // The metric decides, not the positions.
    const Mesh flat = three_holes(0.05);
    Mesh bent = test::on_sphere(flat);
    bent.positions.col(2) *= 2;
    const Surface source(bent, corner_positions(flat));
    const CircleDomainChart by_metric = circle_domain_chart(source);
    check(source, by_metric, 0);
    EXPECT_LT(moduli_error(by_metric), 1e-3);
    EXPECT_GT(moduli_error(circle_domain_chart(Surface(bent))), 1e-2);
}

TEST(CircleDomainChart, OfADiskIsTheRoundDisk) {
    const Surface round(disk(8)), bump(test::bump(600));
    const CircleDomainChart exact = circle_domain_chart(round), chart = circle_domain_chart(bump);
    check(round, exact, 0);
    EXPECT_TRUE(exact.chart.exact);
    EXPECT_TRUE(exact.holes.empty());
    check(bump, chart, 0);
    EXPECT_LT(chart.mean_mu, 1.02 * distortion(bump.operators, round_disk_chart(bump).vertices).mean);
}

TEST(CircleDomainChart, NamesFacesThatNoCircleDomainHasRoomFor) {
    // A triangle set onto two edges of a hole's rim, where they turn away from it least.
    Mesh mesh = test::on_sphere(three_holes(0.1));
    const Topology shape = topology(mesh);
    const auto& rim = shape.boundary_loops[1];
    mesh.faces.add({rim[1], rim[0], rim[2]});
    const Surface source(mesh);
    const CircleDomainChart chart = circle_domain_chart(source);
    const int ear = mesh.face_count() - 1;
    EXPECT_TRUE(chart.pinched.empty());  // the middle vertex is no longer on the rim
    EXPECT_TRUE(std::find(chart.flipped.begin(), chart.flipped.end(), ear) == chart.flipped.end());

    // Three vertices of one rim: the ear of a face with a vertex of its own.
    const int tip = mesh.vertex_count();
    Mesh eared = test::on_sphere(three_holes(0.1));
    Positions positions(tip + 1, 3);
    positions.topRows(tip) = eared.positions;
    positions.row(tip) =
        0.5 * (eared.positions.row(rim[0]) + eared.positions.row(rim[1])) +
        0.1 * (eared.positions.row(rim[0]) - eared.positions.row(rim[1])).norm() * Eigen::RowVector3d(0.3, 0.5, 0.2);
    eared.positions = positions;
    eared.faces.add({rim[1], rim[0], tip});
    const Surface with_ear(eared);
    const CircleDomainChart forced = circle_domain_chart(with_ear);
    EXPECT_EQ(forced.pinched.size(), 2u);
    EXPECT_FALSE(forced.chart.warnings.empty());
    EXPECT_TRUE(std::find(forced.pinched.begin(), forced.pinched.end(), eared.face_count() - 1) !=
                forced.pinched.end());
    EXPECT_FALSE(forced.flipped.empty());
}

TEST(CircleDomainChart, UnfoldsWhatTheHarmonicMapTurnsOver) {
    // A star as the hole: the conformal map makes the bays between its tips exponentially small.
    Polygon star;
    for (int i = 0; i < 16; ++i) {
        const double radius = i % 2 ? 1 : 0.25, angle = i * std::numbers::pi / 8;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    DomainOptions options;
    options.edge_length = 0.1;
    options.hole_edge_length = 0.05;
    const Surface source(polygon_domain({{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, {star}, options));
    const CircleDomainChart chart = circle_domain_chart(source);
    check(source, chart, 0);
    EXPECT_TRUE(chart.pinched.empty());
    const auto& warnings = chart.chart.warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                            [](const Warning& w) { return w.sentence.find("unfolded") != std::string::npos; }));
    EXPECT_LT(chart.mean_mu, 0.08);
}

TEST(CircleDomainChart, RefusesWhatHasNone) {
    const auto cause = [](const Surface& source, int outer, const CircleDomainOptions& options = {}) {
        try {
            circle_domain_chart(source, outer, options);
        } catch (const Error& error) {
            return error.cause();
        }
        ADD_FAILURE() << "no error";
        return Cause::unwritable;
    };
    const Surface source(three_holes(0.1));
    EXPECT_EQ(cause(source, 4), Cause::bad_option);
    EXPECT_EQ(cause(source, -1), Cause::bad_option);
    EXPECT_EQ(cause(Surface(icosahedral_sphere(2)), 0), Cause::bad_mesh);
    CircleDomainOptions options;
    options.tolerance = 0;
    EXPECT_EQ(cause(source, 0, options), Cause::bad_option);
    // Circles that nearly touch.
    options = {};
    options.least_gap = 1.2;
    EXPECT_EQ(cause(source, 0, options), Cause::not_solved);
    EXPECT_EQ(cause(Surface(test::on_sphere(three_holes(0.1))), 0, options), Cause::not_solved);
}

TEST(CircleDomainChart, HolesCloseToEachOtherAndToTheRim) {
    DomainOptions meshing;
    meshing.edge_length = 0.08;
    meshing.hole_edge_length = 0.01;
    const std::vector<Circle> close = {{{-0.21, 0}, 0.2}, {{0.21, 0}, 0.2}, {{0, 0.74}, 0.24}};
    const Surface source(test::on_sphere(circle_domain({}, close, meshing)));
    const CircleDomainChart chart = circle_domain_chart(source);
    check(source, chart, 0);
    std::vector<RoundHole> known;
    for (const Circle& circle : close) known.push_back({-1, centre_of(circle), circle.radius});
    const std::vector<double> found = moduli(chart.holes), wanted = moduli(known);
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i] / wanted[i], 1, 0.01);
}

TEST(LargeCircleDomainChart, OfScans) {
    const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
    if (!folder || !std::filesystem::exists(folder)) GTEST_SKIP() << "no folder of scans";
    const struct {
        const char* name;
        int outer;
        double mean;
    } scans[] = {{"alex_3.obj", 0, 0.014},  {"alex_3.obj", 2, 0.04},     {"amoeba1.obj", 0, 0.02},
                 {"amoeba1.obj", 1, 0.036}, {"human_face.obj", 0, 0.02}, {"mcqc3d_planar_src.obj", 0, 1e-6},
                 {"hand_disk.obj", 0, 0.19}};
    for (const auto& scan : scans) {
        SCOPED_TRACE(scan.name);
        const Surface source(read_mesh(std::filesystem::path(folder) / scan.name).mesh);
        const CircleDomainChart chart = circle_domain_chart(source, scan.outer);
        check(source, chart, scan.outer);
        EXPECT_LT(chart.mean_mu, scan.mean);
    }
}

/// The polygon of a loop's chart has less area than the circle, which pulls on the three vertices that are held: none
/// of them may stand between edges far shorter than the others.
TEST(CircleDomainChart, IsConformalWhereTheMeshIsGradedToItsFirstBoundaryVertex) {
    Polygon ellipse;
    for (int i = 0; i < 60; ++i) {
        const double t = 2 * std::numbers::pi * i / 60;
        ellipse.emplace_back(std::cos(t), 0.5 * std::sin(t));
    }
    DomainOptions options;
    options.edge_length = 0.08;
    options.sources = {{ellipse[0], 2e-4}};
    const Surface source(polygon_domain(ellipse, {}, options));
    ASSERT_EQ(source.topology.boundary_loops[0][0], 0);
    const CircleDomainChart chart = circle_domain_chart(source);
    EXPECT_LT(chart.mean_mu, 0.05);
    EXPECT_LT(chart.max_mu, 0.35);
}

}  // namespace
}  // namespace beltrami
