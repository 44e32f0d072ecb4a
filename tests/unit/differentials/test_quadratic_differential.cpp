#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/quadratic_differential.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Complex phi_of(Complex z) {
    return 1.0 + z * z * Complex(0.3, 1);
}

std::vector<MeshPoint> places_on(const Mesh& mesh) {
    std::vector<MeshPoint> places;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        places.push_back({f, {v[0], v[1], v[2]}, {0.5, 0.3, 0.2}});
    }
    return places;
}

TEST(QuadraticDifferential, OfOnesOwnHasItsValuesEverywhere) {
    for (const Mesh& mesh : {test::jittered_square(5), test::mixed_square(4)}) {
        const Surface source(mesh);
        const QuadraticDifferential phi = differential_of(source, phi_of);
        const Eigen::VectorXcd z = test::complex_positions(mesh), at = at_samples(source.operators, z);
        EXPECT_LT((phi.at_samples(source) - at.unaryExpr([](Complex p) { return phi_of(p); })).norm(), 1e-14);
        const std::vector<MeshPoint> places = places_on(mesh);
        const Eigen::VectorXcd values = phi.at(source, places);
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(std::abs(values[static_cast<Eigen::Index>(i)] - phi_of(places[i].interpolate(z))), 0, 1e-14);
    }
}

TEST(QuadraticDifferential, OfASpaceIsPulledBackByTheChart) {
    // φ = ψ(w) w′² with w = z/2 on a disk of radius 2.
    Mesh mesh = disk(8);
    mesh.positions *= 2;
    const Surface source(mesh);
    Eigen::VectorXcd coefficients(3);
    coefficients << 1.0, Complex(0, 2), 0.5;
    const QuadraticDifferential phi{
        std::make_shared<PolynomialSpace>(2, 2), std::make_shared<Chart>(domain_chart(source)), coefficients, {}, {}};
    const auto exact = [&](Complex z) {
        Complex sum = 0;
        for (int j = 0; j < 3; ++j)
            sum += coefficients[j] * std::sqrt((j + 1) / std::numbers::pi) * std::pow(z / 2.0, j) / 4.0;
        return sum;
    };
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const std::vector<MeshPoint> places = places_on(mesh);
    const Eigen::VectorXcd values = phi.at(source, places);
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_NEAR(std::abs(values[static_cast<Eigen::Index>(i)] - exact(places[i].interpolate(z))), 0, 1e-12);
    const Eigen::VectorXcd samples = phi.at_samples(source), at = at_samples(source.operators, z);
    for (Eigen::Index s = 0; s < samples.size(); ++s) EXPECT_NEAR(std::abs(samples[s] - exact(at[s])), 0, 1e-12);
}

TEST(QuadraticDifferential, TabulatedIsThatOfTheNearestSample) {
    const Surface source(test::mixed_square(3));
    const Eigen::VectorXcd values = Eigen::VectorXcd::Random(source.operators.sample_count());
    const QuadraticDifferential phi = differential_of(source, values);
    EXPECT_TRUE(phi.tabulated());
    EXPECT_EQ(phi.at_samples(source), values);
    const std::vector<MeshPoint> places = places_on(source.mesh);  // nearest to the first corner
    const Eigen::VectorXcd there = phi.at(source, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        int sample = 0;
        while (source.operators.faces[sample] != places[i].face) ++sample;
        EXPECT_EQ(there[static_cast<Eigen::Index>(i)], values[sample]);
    }
    EXPECT_THROW(differential_of(source, Eigen::VectorXcd(values.head(2))), Error);
    EXPECT_THROW(differential_of(Surface(test::bump(100)), phi_of), Error);
}

TEST(QuadraticDifferential, OfNothingIsZero) {
    const Surface source(test::mixed_square(3));
    const QuadraticDifferential none;
    EXPECT_TRUE(none.zero());
    EXPECT_EQ(none.at_samples(source), Eigen::VectorXcd(Eigen::VectorXcd::Zero(source.operators.sample_count())));
}

}  // namespace
}  // namespace beltrami
