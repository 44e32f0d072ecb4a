// Quadratic differentials of problems with constraints inside: Re ∫ φ ∂̄V = 0 for every motion V that the constraints
// allow.
#include <beltrami/charts/domain_chart.h>
#include <beltrami/coefficient/differential_quadrature.h>
#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/teichmuller/problem.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/extremal.h"

namespace beltrami {
namespace {

enum class Kind { pinned, held, held_alone };

class Admissible : public testing::TestWithParam<Kind> {};

TEST_P(Admissible, DifferentialsPairWithNoMotion) {
    const Kind kind = GetParam();
    const Surface source(disk(12));
    const auto place = [&](int v) { return bench::place(source.mesh, v); };
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) boundary.pin(v, place(v));
    const Complex direction = std::polar(1.0, 0.7);
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        const Complex z = place(v);
        if (source.topology.on_boundary[v] || std::abs(z.imag()) > 1e-12 || z.real() > 0.55) continue;
        if (kind == Kind::pinned && z.real() > -0.8) boundary.pin(v, z);  // no face at the rim nailed down
        if (kind == Kind::held) boundary.pin_to_line(v, z, 1.0);
        if (kind == Kind::held_alone && z.real() == 0) boundary.pin_to_line(v, z, direction);
    }
    Eigen::VectorXcd identity(source.mesh.vertex_count());
    for (int v = 0; v < identity.size(); ++v) identity[v] = place(v);
    const Chart chart = domain_chart(source);
    Singularities singularities = singularities_of(source, chart, boundary, {}, identity);
    ASSERT_EQ(singularities.curves.size(), kind == Kind::held_alone ? 0u : 1u);
    ASSERT_EQ(singularities.real(), kind != Kind::pinned);
    ExtremalProblem problem(source, boundary, 1);
    problem.set_chart(chart);
    problem.set_singularities(singularities, 1500);
    std::unique_ptr<DifferentialSpace> space = problem.starting_space(10);
    while (auto larger = space->refined()) space = std::move(larger);
    EXPECT_EQ(space->complex_coefficients(), kind == Kind::pinned);
    ASSERT_GT(space->size(), space->complex_coefficients() ? 11 : 22);  // those of the polynomials

    const std::vector<Freedom> freedom = freedoms(boundary, source);
    Eigen::VectorXcd V = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    for (int v = 0; v < V.size(); ++v) {
        const Complex z = place(v);
        const Complex any(std::sin(4 * z.real() + 1) + z.imag(), std::cos(3 * z.real() - 2 * z.imag()));
        if (freedom[v] == Freedom::free) V[v] = any;
        if (freedom[v] == Freedom::sliding) V[v] = any.real() * (kind == Kind::held ? Complex(1) : direction);
    }
    const int samples = source.operators.sample_count();
    for (int j = 0; j < space->size(); ++j) {
        Eigen::VectorXcd c = Eigen::VectorXcd::Zero(space->size());
        c[j] = 1;
        Eigen::VectorXcd phi = Eigen::VectorXcd::Zero(samples);
        visit_quadrature(source, chart, *space, c, [&](const FacePoint& p) { phi[p.sample] += p.weight * p.phi; });
        Complex pairing = 0;
        double size = 0;
        for (int s = 0; s < samples; ++s) {
            const Complex dbar = source.operators.derivatives(s, V)[1];
            pairing += phi[s] * dbar;
            size += std::abs(phi[s] * dbar);
        }
        const double off = space->complex_coefficients() ? std::abs(pairing) : std::abs(pairing.real());
        EXPECT_LT(off, 2e-3 * size) << j;
    }
}

INSTANTIATE_TEST_SUITE_P(Constraints, Admissible, testing::Values(Kind::pinned, Kind::held, Kind::held_alone),
                         [](const auto& instance) {
                             return std::string(instance.param == Kind::pinned ? "Pinned"
                                                : instance.param == Kind::held ? "Held"
                                                                               : "HeldAlone");
                         });

}  // namespace
}  // namespace beltrami
