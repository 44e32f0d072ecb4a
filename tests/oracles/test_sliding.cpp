// Boundaries that slide: closed forms, values known from both directions, and what must not matter.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "support/onto.h"

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/mesh/planar.h>

#include "problems/elliptic.h"

namespace beltrami {
namespace {

using test::circles_target;
using test::disk_with_holes;
using test::expect_sliding_sound;
using test::Hole;

TEST(SlidingRing, ConvergesToTheRadialStretchWithSecondOrder) {
    const double exact = std::log(0.3) / std::log(0.5);
    double last_error = 0, last_std = 0;
    for (const double h : {0.08, 0.04, 0.02}) {
        const ExtremalMap result =
            extremal_map(Surface(disk_with_holes({{0, 0, 0.5}}, h)), circles_target({{0, 0, 0.3}}));
        expect_sliding_sound(result);
        EXPECT_EQ(result.dimension, 1);
        const double error = std::abs(result.k - k_of(exact));
        if (last_error > 0) {
            EXPECT_GT(std::log2(last_error / error), 1.6);
            EXPECT_GT(std::log2(last_std / result.distortion.standard_deviation), 0.8);
        }
        // Both ends of the bracket have errors of second order (measured: .11 to .14 h²).
        EXPECT_NEAR(result.K_lower, exact, 0.2 * h * h);
        EXPECT_NEAR(result.K_upper, exact, 0.4 * h * h);
        last_error = error;
        last_std = result.distortion.standard_deviation;
    }
    EXPECT_LT(last_error, 2e-4);
}

struct KnownPair {
    const char* name;
    std::vector<Hole> source, target;
    double k, uncertainty;  ///< the value as it is known
    int dimension;
};

void PrintTo(const KnownPair& pair, std::ostream* out) {
    *out << pair.name;
}

class KnownPairs : public testing::TestWithParam<KnownPair> {};

TEST_P(KnownPairs, HaveTheirKBothWays) {
    const KnownPair& pair = GetParam();
    // Holes keep their numbers: other matchings of three alike holes make other maps.
    Correspondence wanted;
    for (int l = 0; l <= static_cast<int>(pair.source.size()); ++l) wanted.loops.push_back({l, l});
    const ExtremalMap there =
        extremal_map(Surface(disk_with_holes(pair.source, 0.04)), {circles_target(pair.target), wanted});
    const ExtremalMap back =
        extremal_map(Surface(disk_with_holes(pair.target, 0.04)), {circles_target(pair.source), wanted});
    for (const ExtremalMap* result : {&there, &back}) {
        expect_sliding_sound(*result);
        EXPECT_EQ(result->dimension, pair.dimension);
        // At h = .04 the error of the mesh comes on top.
        EXPECT_NEAR(result->k, pair.k, pair.uncertainty + 3e-4);
        EXPECT_LT(k_of(result->K_lower), pair.k + pair.uncertainty + 8e-5);
        EXPECT_GT(k_of(result->K_upper), pair.k - pair.uncertainty - 8e-5);
        EXPECT_LT(result->K_upper / result->K_lower, 1.005);
    }
}

INSTANTIATE_TEST_SUITE_P(Sliding, KnownPairs,
                         testing::Values(KnownPair{"example_4",
                                                   {{0, 0.33, 0.1}, {0.33, -0.33, 0.067}, {-0.33, -0.33, 0.133}},
                                                   {{0, 0.6, 0.1}, {0.7, -0.3, 0.1}, {-0.7, -0.3, 0.1}},
                                                   0.3758,
                                                   1e-4,
                                                   6},
                                         KnownPair{"example_5",
                                                   {{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}},
                                                   {{0, 0.5, 0.2}, {-0.4, -0.3, 0.2}, {0.4, -0.3, 0.2}},
                                                   0.2708,
                                                   5e-5,
                                                   6},
                                         KnownPair{"two_holes",
                                                   {{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}},
                                                   {{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}},
                                                   0.16556,
                                                   3e-5,
                                                   3}),
                         [](const auto& test) { return std::string(test.param.name); });

/// A rectangle's corners by number of the marks: counter-clockwise from (0, 0).
std::vector<Mark> rectangle_marks(const Surface& source, double a, double b) {
    std::vector<Mark> marks;
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    const std::array<Complex, 4> corners{Complex(0, 0), Complex(a, 0), Complex(a, 1), Complex(0, 1)};
    const std::array<double, 4> parameters{0, b, b + 1, 2 * b + 1};
    for (int c = 0; c < 4; ++c)
        for (const int v : source.topology.boundary_loops[0])
            if (std::abs(z[v] - corners[c]) < 1e-12) marks.push_back({v, 0, parameters[c]});
    return marks;
}

TEST(SlidingRectangle, IsTheAffineMap) {
    for (const double b : {1.7, 0.6}) {
        const Surface source(polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, {.edge_length = 0.08}));
        Correspondence wanted;
        wanted.marks = rectangle_marks(source, 1, b);
        ASSERT_EQ(wanted.marks.size(), 4u);
        const ExtremalMap result =
            extremal_map(source, {target_domain(TargetCurve::polygon({{0, 0}, {b, 0}, {b, 1}, {0, 1}})), wanted});
        expect_sliding_sound(result);
        EXPECT_EQ(result.space, ExtremalOptions::Space::one_form_squares);
        EXPECT_NEAR(result.K, std::max(b, 1 / b), 1e-9);
        EXPECT_NEAR(result.K_max, std::max(b, 1 / b), 1e-7);
        EXPECT_LT(result.boundary_residual, 1e-12);
        const Eigen::VectorXcd z = planar_coordinates(source.mesh);
        for (Eigen::Index v = 0; v < z.size(); ++v)
            EXPECT_LT(std::abs(result.map[v] - Complex(b * z[v].real(), z[v].imag())), 1e-7);
    }
}

/// K(k)/K′(k), k = sin α.
double modulus(double alpha) {
    return bench::complete_elliptic(std::sin(alpha)) / bench::complete_elliptic(std::cos(alpha));
}

TEST(SlidingDisk, WithFourMarksHasTheRatioOfModuli) {
    const double from = kPi / 4, to = kPi / 6;
    const double K = std::max(modulus(from), modulus(to)) / std::min(modulus(from), modulus(to));
    EXPECT_NEAR(k_of(K), 0.122523, 1e-6);
    for (const auto space : {ExtremalOptions::Space::one_form_squares, ExtremalOptions::Space::laurent}) {
        const Surface source(disk_with_holes({}, 0.04));
        const Eigen::VectorXcd z = planar_coordinates(source.mesh);
        Correspondence wanted;
        ExtremalOptions options;
        options.space = space;
        // The nearest boundary vertices stand for the marked points: the modulus of the four of them counts.
        std::array<double, 4> angles{from, kPi - from, kPi + from, 2 * kPi - from};
        const std::array<double, 4> images{to, kPi - to, kPi + to, 2 * kPi - to};
        for (int i = 0; i < 4; ++i) {
            int best = -1;
            for (const int v : source.topology.boundary_loops[0])
                if (best < 0 ||
                    std::abs(z[v] - std::polar(1.0, angles[i])) < std::abs(z[best] - std::polar(1.0, angles[i])))
                    best = v;
            ASSERT_LT(std::abs(z[best] - std::polar(1.0, angles[i])), 0.03);
            angles[i] = std::arg(z[best]);
            wanted.marks.push_back({best, 0, images[i]});
        }
        // Cross ratio of four points of a circle ↔ the angle α of the symmetric quadruple.
        const auto point = [&](int i) { return std::polar(1.0, angles[i]); };
        const double cross =
            std::abs((point(0) - point(3)) * (point(1) - point(2)) / ((point(0) - point(2)) * (point(1) - point(3))));
        const double alpha = std::asin(std::sqrt(cross));
        const double exact = std::max(modulus(alpha), modulus(to)) / std::min(modulus(alpha), modulus(to));
        const ExtremalMap result = extremal_map(source, {target_domain(TargetCurve::circle(0, 1)), wanted}, options);
        expect_sliding_sound(result);
        EXPECT_EQ(result.space, space);
        EXPECT_EQ(result.dimension, 1);
        EXPECT_NEAR(result.k, k_of(exact), 2e-3);
        EXPECT_LT(result.K_lower, exact * (1 + 2e-3));
        EXPECT_GT(result.K_upper, exact * (1 - 2e-3));
    }
}

TEST(SlidingDisk, WithoutMarksIsConformal) {
    const Surface source(disk_with_holes({}, 0.08));
    const ExtremalMap result =
        extremal_map(source, target_domain(TargetCurve::polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}})));
    expect_sliding_sound(result);
    EXPECT_EQ(result.dimension, 0);
    EXPECT_EQ(result.K, 1);
    EXPECT_LT(result.distortion.mean, 0.05);
}

TEST(SlidingLShape, ToARectangleHasItsSymmetricValue) {
    // The L is conformal to a square with these corners, by its symmetry in the diagonal.
    const Surface source(polygon_domain({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {},
                                        {.edge_length = 0.06, .corner_edge_length = 0.01}));
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    Correspondence wanted;
    const std::array<Complex, 4> from{Complex(0, 0), Complex(2, 0), Complex(1, 1), Complex(0, 2)};
    const std::array<double, 4> to{0, 1.5, 2.5, 4};
    for (int i = 0; i < 4; ++i)
        for (const int v : source.topology.boundary_loops[0])
            if (std::abs(z[v] - from[i]) < 1e-12) wanted.marks.push_back({v, 0, to[i]});
    ASSERT_EQ(wanted.marks.size(), 4u);
    const ExtremalMap result =
        extremal_map(source, {target_domain(TargetCurve::polygon({{0, 0}, {1.5, 0}, {1.5, 1}, {0, 1}})), wanted});
    EXPECT_TRUE(result.one_to_one());
    EXPECT_NEAR(result.k, 0.2, 6e-3);
}

TEST(SlidingClasses, RotatingTheStartChangesNothing) {
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.08));
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    const ExtremalMap plain = extremal_map(source, target);
    expect_sliding_sound(plain);
    for (const std::vector<double>& turns :
         {std::vector<double>{0.5, 0, 0}, {0, 1, -1}, {0.3, -2, 2}, {0, 0.7, 0}, {0, 2, 2}, {1, 0, 0}, {2, 0, 0}}) {
        ExtremalOptions options;
        options.start_turns = turns;
        const ExtremalMap turned = extremal_map(source, target, options);
        expect_sliding_sound(turned);
        EXPECT_NEAR(turned.k, plain.k, 1e-5);
        // Loops turn back before anything is led, and the iteration is as short as without the turns.
        EXPECT_LE(turned.iterations, plain.iterations + 8);
    }
}

TEST(SlidingClasses, HolesThatChangePlacesEitherWayAreTwoMaps) {
    // Two holes change places beside a third one. (Without a third hole, or a mark outside, both ways are the same: the
    // outer loop turns along.)
    const Surface source(disk_with_holes({{-0.35, 0.25, 0.12}, {0.35, 0.25, 0.12}, {0, -0.5, 0.15}}, 0.06));
    const TargetDomain target = circles_target({{0.35, 0.25, 0.12}, {-0.35, 0.2, 0.14}, {0.1, -0.5, 0.15}});
    std::vector<ExtremalMap> results;
    for (const double sign : {1.0, -1.0}) {
        Correspondence wanted;
        wanted.loops = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
        wanted.waypoints =
            std::vector<Waypoint>{{1, 1, Complex(0, 0.25 - 0.25 * sign)}, {1, 2, Complex(0, 0.25 + 0.25 * sign)}};
        results.push_back(extremal_map(source, {target, wanted}));
        const ExtremalMap& result = results.back();
        EXPECT_TRUE(result.led);
        EXPECT_EQ(result.path.size(), 2u);
        EXPECT_TRUE(result.one_to_one());
        EXPECT_EQ(result.termination, Termination::converged);
    }
    EXPECT_GT(std::abs(results[0].k - results[1].k), 1e-3);
}

TEST(SlidingClasses, AGivenStartKeepsItsClass) {
    const Surface source(disk_with_holes({{-0.35, 0.25, 0.12}, {0.35, 0.25, 0.12}, {0, -0.5, 0.15}}, 0.06));
    const TargetDomain target = circles_target({{0.35, 0.25, 0.12}, {-0.35, 0.2, 0.14}, {0.1, -0.5, 0.15}});
    Correspondence wanted;
    wanted.loops = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
    std::vector<double> found;
    for (const double sign : {1.0, -1.0}) {
        Correspondence led = wanted;
        led.waypoints =
            std::vector<Waypoint>{{1, 1, Complex(0, 0.25 - 0.25 * sign)}, {1, 2, Complex(0, 0.25 + 0.25 * sign)}};
        const ExtremalMap there = extremal_map(source, {target, led});
        ExtremalOptions options;
        options.start = there.map;
        for (int v = 0; v < source.mesh.vertex_count(); ++v)  // some faces fold, and rims leave their circles
            (*options.start)[v] += 0.02 * std::polar(1.0, 7.0 * v * v);
        const ExtremalMap again = extremal_map(source, {target, wanted}, options);
        EXPECT_GT(again.start_flips, 0);
        EXPECT_TRUE(again.warnings.empty()) << again.warnings[0].sentence;
        EXPECT_TRUE(again.one_to_one());
        EXPECT_NEAR(again.k, there.k, 2e-5);
        found.push_back(again.k);
    }
    EXPECT_GT(std::abs(found[0] - found[1]), 1e-3);
}

TEST(SlidingClasses, AStartThatLeadsNowhereIsGivenUp) {
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.1));
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    Correspondence wanted;
    wanted.loops = {{0, 0}, {1, 1}, {2, 2}};
    const ExtremalMap plain = extremal_map(source, {target, wanted});
    ExtremalOptions options;
    options.start = plain.map;
    for (int v = 0; v < source.mesh.vertex_count(); ++v)
        if (!source.topology.on_boundary[v]) (*options.start)[v] = std::polar(0.9, 7.0 * v * v);
    options.max_iterations = plain.iterations + 1;  // too few from such a start
    const ExtremalMap stopped = extremal_map(source, {target, wanted}, options);
    const auto about_start = [](const Warning& warning) { return warning.kind == WarningKind::start; };
    EXPECT_EQ(std::count_if(stopped.warnings.begin(), stopped.warnings.end(), about_start), 1);
    EXPECT_EQ(stopped.termination, Termination::converged);
    EXPECT_EQ(stopped.k, plain.k);
    options = {};
    options.start = plain.map;
    const ExtremalMap settled = extremal_map(source, {target, wanted}, options);
    EXPECT_EQ(std::count_if(settled.warnings.begin(), settled.warnings.end(), about_start), 0);
    EXPECT_NEAR(settled.k, plain.k, 1e-5);
    EXPECT_LE(settled.iterations, plain.iterations);
}

TEST(SlidingInvariance, TurningScalingAndRenumberingChangeNothing) {
    const std::vector<Hole> holes{{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}};
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    const Mesh mesh = disk_with_holes(holes, 0.1);
    const double k = extremal_map(Surface(mesh), target).k;
    Mesh moved = mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z = 1e3 * std::polar(1.0, 0.7) * Complex(mesh.positions(v, 0), mesh.positions(v, 1)) + 5e3;
        moved.positions.row(v) << z.real(), z.imag();
    }
    EXPECT_NEAR(extremal_map(Surface(moved), target).k, k, 1e-8);
    Mesh renumbered;
    const int n = mesh.vertex_count();
    renumbered.positions.resize(n, 2);
    for (int v = 0; v < n; ++v) renumbered.positions.row(n - 1 - v) = mesh.positions.row(v);
    for (int f = mesh.face_count() - 1; f >= 0; --f) {
        const auto corners = mesh.faces[f];
        renumbered.faces.add({n - 1 - corners[0], n - 1 - corners[1], n - 1 - corners[2]});
    }
    EXPECT_NEAR(extremal_map(Surface(renumbered), target).k, k, 1e-7);
}

TEST(SlidingInvariance, MoebiusImagesOfADomainAreFoundConformal) {
    const std::vector<Hole> holes{{-0.4, 0.1, 0.2}, {0.35, 0.3, 0.12}, {0.2, -0.45, 0.15}};
    const Surface source(disk_with_holes(holes, 0.08));
    for (const DiskMoebius& move : {DiskMoebius{0, 0}, DiskMoebius{2.2, {0.5, 0.2}}, DiskMoebius{-2.6, {-0.35, 0.6}}}) {
        std::vector<Hole> images;
        for (const int h : {2, 0, 1}) {  // in another order
            const RoundHole image = move(RoundHole{h, {holes[h][0], holes[h][1]}, holes[h][2]});
            images.push_back({image.centre.real(), image.centre.imag(), image.radius});
        }
        const TargetDomain target = circles_target(images);
        const ExtremalMap result = extremal_map(source, target);
        expect_sliding_sound(result);
        EXPECT_LT(result.k, 1e-3);
        EXPECT_EQ(result.start_flips, 0);
        for (const LoopOnto& loop : result.loops) {
            if (loop.loop == 0) continue;
            const Complex at(source.mesh.positions(source.topology.boundary_loops[loop.loop][0], 0),
                             source.mesh.positions(source.topology.boundary_loops[loop.loop][0], 1));
            const TargetCurve& curve = target.curve(loop.curve);
            EXPECT_NEAR(std::abs(move(at) - curve.centre()), curve.radius(), 1e-6);
        }
    }
}

TEST(SlidingInvariance, AMoebiusImageOfTheTargetChangesNothing) {
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0.3, 0.12}, {0.2, -0.45, 0.15}}, 0.06));
    const std::vector<Hole> near{{-0.5, 0, 0.2}, {0.4, 0.2, 0.18}, {0.2, -0.5, 0.1}};
    const ExtremalMap plain = extremal_map(source, circles_target(near));
    const DiskMoebius move{1.3, {0.4, -0.3}};
    std::vector<Hole> far;
    for (const Hole& hole : near) {
        const RoundHole image = move(RoundHole{0, {hole[0], hole[1]}, hole[2]});
        far.push_back({image.centre.real(), image.centre.imag(), image.radius});
    }
    const ExtremalMap moved = extremal_map(source, circles_target(far));
    expect_sliding_sound(moved);
    EXPECT_GT(plain.k, 0.05);
    EXPECT_NEAR(moved.k, plain.k, 5e-4);
    for (std::size_t l = 0; l < plain.loops.size(); ++l) EXPECT_EQ(moved.loops[l].curve, plain.loops[l].curve);
}

TEST(SlidingInvariance, AMarkThatTurnsTheRingChangesNothing) {
    const Surface source(disk_with_holes({{0, 0, 0.5}}, 0.1));
    const TargetDomain target = circles_target({{0, 0, 0.3}});
    const double exact = k_of(std::log(0.3) / std::log(0.5));
    for (const double turn : {0.0, 1.5, 3.0, -2.0}) {
        Correspondence wanted;
        const int vertex = source.topology.boundary_loops[0][0];
        const Complex z(source.mesh.positions(vertex, 0), source.mesh.positions(vertex, 1));
        wanted.marks = {{vertex, 0, target.outer.wrap(std::arg(z) + turn)}};
        const ExtremalMap result = extremal_map(source, {target, wanted});
        expect_sliding_sound(result);
        EXPECT_NEAR(result.k, exact, 2e-3);
        EXPECT_NEAR(std::abs(result.map[vertex] - z * std::polar(1.0, turn)), 0, 1e-9);
    }
}

class SymmetricHoles : public testing::TestWithParam<int> {};

TEST_P(SymmetricHoles, AreNoSpecialCase) {
    std::vector<Hole> from, to;
    if (GetParam() == 0) {  // in line
        from = {{-0.5, 0, 0.1}, {0, 0, 0.1}, {0.5, 0, 0.1}};
        to = {{-0.5, 0, 0.15}, {0, 0, 0.2}, {0.5, 0, 0.15}};
    } else {
        for (int i = 0; i < 5; ++i) {
            const Complex c = std::polar(0.5, 2 * kPi * i / 5);
            from.push_back({c.real(), c.imag(), 0.1});
            to.push_back({c.real(), c.imag(), 0.2});
        }
    }
    const ExtremalMap there = extremal_map(Surface(disk_with_holes(from, 0.06)), circles_target(to));
    const ExtremalMap back = extremal_map(Surface(disk_with_holes(to, 0.06)), circles_target(from));
    expect_sliding_sound(there);
    expect_sliding_sound(back);
    EXPECT_NEAR(there.k, back.k, 2e-3);
    EXPECT_LT(there.K_upper / there.K_lower, 1.006);
}

INSTANTIATE_TEST_SUITE_P(Sliding, SymmetricHoles, testing::Values(0, 1));

TEST(SlidingMistakes, AreSaid) {
    const Surface source(disk_with_holes({{0, 0, 0.4}}, 0.2));
    EXPECT_THROW(extremal_map(source, circles_target({})), Error);  // one hole against none
    Correspondence wanted;
    wanted.loops = {{0, 1}, {1, 0}};
    EXPECT_THROW(extremal_map(source, {circles_target({{0, 0, 0.3}}), wanted}), Error);  // the outer one goes inside
    wanted.loops = {{0, 0}};
    EXPECT_THROW(extremal_map(source, {circles_target({{0, 0, 0.3}}), wanted}), Error);  // a loop is left out
    wanted.loops.clear();
    const auto& outer = source.topology.boundary_loops[0];
    wanted.marks = {{outer[0], 0, 0.0}, {outer[4], 0, 4.0}, {outer[8], 0, 2.0}};
    EXPECT_THROW(extremal_map(source, {circles_target({{0, 0, 0.3}}), wanted}), Error);  // marks out of order
    int inside = 0;
    while (source.topology.on_boundary[inside]) ++inside;
    wanted.marks = {{inside, 0, 0.0}};
    EXPECT_THROW(extremal_map(source, {circles_target({{0, 0, 0.3}}), wanted}), Error);
}

}  // namespace
}  // namespace beltrami
