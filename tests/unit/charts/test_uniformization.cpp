#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/charts/uniformization.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/disk_moebius.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

const std::vector<Circle> kRoundHoles = {{{-0.45, 0.1}, 0.2}, {{0.35, 0.3}, 0.15}, {{0.2, -0.45}, 0.25}};

Mesh domain(std::vector<Circle> circles, double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return circle_domain({}, circles, options);
}

/// Normalised, with these circles in the order of the mesh's loops.
std::vector<double> moduli_of(const Mesh& mesh, const std::vector<Circle>& circles) {
    const Surface surface(mesh);
    std::vector<RoundHole> holes;
    for (std::size_t l = 1; l < surface.topology.boundary_loops.size(); ++l) {
        const int v = surface.topology.boundary_loops[l][0];
        const Complex at(mesh.positions(v, 0), mesh.positions(v, 1));
        for (const Circle& circle : circles) {
            const Complex centre(circle.centre.x(), circle.centre.y());
            if (std::abs(std::abs(at - centre) - circle.radius) < 1e-9)
                holes.push_back({static_cast<int>(l), centre, circle.radius});
        }
    }
    const DiskMoebius to_centre = centring(holes[0]);
    std::vector<double> result{to_centre(holes[0]).radius};
    const Complex turn = std::conj(to_centre(holes[1]).centre) / std::abs(to_centre(holes[1]).centre);
    for (std::size_t h = 1; h < holes.size(); ++h) {
        const RoundHole hole = to_centre(holes[h]);
        result.push_back((turn * hole.centre).real());
        if (h > 1) result.push_back((turn * hole.centre).imag());
        result.push_back(hole.radius);
    }
    return result;
}

double worst(const std::vector<double>& a, const std::vector<double>& b) {
    EXPECT_EQ(a.size(), b.size());
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

/// The circles are those of the map, to rounding, and the normalisation is as promised.
void expect_normalised(const Surface& surface, const Uniformization& found) {
    for (const int v : surface.topology.boundary_loops[found.chart.outer_loop()])
        EXPECT_NEAR(std::abs(found.map[v]), 1, 1e-14);
    for (const RoundHole& hole : found.holes)
        for (const int v : surface.topology.boundary_loops[hole.loop])
            EXPECT_NEAR(std::abs(found.map[v] - hole.centre), hole.radius, 1e-14);
    if (!found.holes.empty()) {
        EXPECT_EQ(found.holes[0].centre, 0.0);
    }
    if (found.holes.size() > 1) {
        EXPECT_EQ(found.holes[1].centre.imag(), 0);
        EXPECT_GT(found.holes[1].centre.real(), 0);
    }
}

TEST(Uniformization, ModulesOfRingsConverge) {
    // exp maps the ring about 0 to another one, and rings that are not concentric are known too.
    const double exact = std::log(1 / 0.35) / (2 * std::numbers::pi);
    std::vector<double> errors;
    for (const double h : {0.12, 0.06, 0.03}) {
        const Mesh ring = test::moved(domain({{{0, 0}, 0.35}}, h), [](Complex z) { return z + 0.12 * z * z; });
        const Surface surface(test::on_sphere(ring));
        const Uniformization found = uniformization(surface);
        expect_normalised(surface, found);
        ASSERT_TRUE(found.module);
        EXPECT_DOUBLE_EQ(*found.module, -std::log(found.moduli.at(0)) / (2 * std::numbers::pi));
        errors.push_back(std::abs(*found.module - exact));
    }
    EXPECT_LT(errors.back(), 2e-4);
    EXPECT_GT(std::log2(errors.front() / errors.back()) / 2, 1.8);
}

TEST(Uniformization, AnEccentricRingHasTheModuleOfTheConcentricOne) {
    // The unit circle and one of radius r around c: cosh(2π module) = (1 + r² − |c|²)/2r.
    const double r = 0.3, c = 0.4;
    const Surface surface(domain({{{0.24, 0.32}, r}}, 0.08));
    const Uniformization found = uniformization(surface);
    expect_normalised(surface, found);
    EXPECT_NEAR(*found.module, std::acosh((1 + r * r - c * c) / (2 * r)) / (2 * std::numbers::pi), 1e-9);
    EXPECT_TRUE(distortion(surface.operators, found.map).flipped.empty());
}

TEST(Uniformization, ModuliOfThreeHolesConverge) {
    std::vector<double> errors;
    for (const double h : {0.1, 0.05, 0.025}) {
        const Mesh flat = domain(kRoundHoles, h);
        const Surface surface(test::on_sphere(flat));
        // The same loop is the outer one in space as in the plane.
        ASSERT_EQ(surface.topology.boundary_loops[0], Surface(flat).topology.boundary_loops[0]);
        const Uniformization found = uniformization(surface);
        expect_normalised(surface, found);
        EXPECT_EQ(found.moduli.size(), 6u);
        EXPECT_FALSE(found.module);
        errors.push_back(worst(found.moduli, moduli_of(flat, kRoundHoles)));
    }
    EXPECT_LT(errors.back(), 1e-3);
    EXPECT_GT(std::log2(errors.front() / errors.back()) / 2, 1.8);
}

TEST(Uniformization, DoesNotDependOnMoebiusMapsOfTheSurface) {
    const Mesh flat = domain(kRoundHoles, 0.06);
    const Uniformization one = uniformization(Surface(flat));
    for (const DiskMoebius& move : {DiskMoebius{1.1, {0.4, -0.2}}, DiskMoebius{-2.0, {0, 0.5}}}) {
        const Surface moved(test::moved(flat, [&](Complex z) { return 3.0 * move(z) + Complex(1, 2); }));
        const Uniformization other = uniformization(moved);
        expect_normalised(moved, other);
        EXPECT_LT(worst(one.moduli, other.moduli), 1e-9);
        EXPECT_LT((one.map - other.map).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(Uniformization, AHoleOfChoiceGoesToTheCentre) {
    const Surface surface(domain(kRoundHoles, 0.08));
    const Uniformization found = uniformization(surface, 0, 3);
    expect_normalised(surface, found);
    EXPECT_EQ(found.holes[0].loop, 3);
    EXPECT_EQ(found.holes[1].loop, 1);
    EXPECT_EQ(found.holes[2].loop, 2);
    EXPECT_THROW(uniformization(surface, 0, 0), Error);
    EXPECT_THROW(uniformization(surface, 0, 4), Error);
    EXPECT_THROW(uniformization(surface, 5), Error);
}

TEST(Uniformization, OfADiskHasNoModuli) {
    const Surface surface(test::bump(2000));
    const Uniformization found = uniformization(surface);
    expect_normalised(surface, found);
    EXPECT_TRUE(found.moduli.empty());
    EXPECT_FALSE(found.module);
    EXPECT_LT(std::abs(found.map[surface.topology.boundary_loops[0][0]] - 1.0), 1e-14);
    EXPECT_LT(distortion(surface.operators, found.map).mean, 0.03);
}

}  // namespace
}  // namespace beltrami
