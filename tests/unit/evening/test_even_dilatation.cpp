#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/evening/dilatation_patches.h>
#include <beltrami/evening/dilatation_sweeps.h>
#include <beltrami/evening/even_dilatation.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using Derivative = DilatationSpread::Derivative;

/// f(z) = z + k z̄ is the extremal map for its boundary values, φ = 1.
constexpr double kAffine = 0.4;
Complex affine(Complex z) {
    return z + kAffine * std::conj(z);
}

/// A map given at the vertices of a planar mesh; inner vertices are shaken by an amount.
Eigen::VectorXcd values(const Surface& source, const std::function<Complex(Complex)>& f, double shake = 0) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-shake, shake);
    const Eigen::VectorXcd z = test::complex_positions(source.mesh);
    Eigen::VectorXcd result(z.size());
    for (int v = 0; v < z.size(); ++v) {
        const double x = uniform(random), y = uniform(random);
        result[v] = f(z[v]) + (source.topology.on_boundary[v] ? Complex(0) : Complex(x, y));
    }
    return result;
}

std::vector<Freedom> boundary_fixed(const Surface& source) {
    std::vector<Freedom> result(source.mesh.vertex_count(), Freedom::free);
    for (int v = 0; v < source.mesh.vertex_count(); ++v)
        if (source.topology.on_boundary[v]) result[v] = Freedom::fixed;
    return result;
}

Eigen::VectorXcd constant_phi(const Surface& source, Complex value = 1) {
    return Eigen::VectorXcd::Constant(source.operators.sample_count(), value);
}

/// φ = g′² of test::exact_composition at the centres of faces; good enough for samples of small quads.
Eigen::VectorXcd exact_phi(const Surface& source) {
    Eigen::VectorXcd phi(source.operators.sample_count());
    for (int s = 0; s < phi.size(); ++s) {
        Complex z = 0;
        const auto face = source.mesh.faces[source.operators.faces[s]];
        for (const int v : face) z += Complex(source.mesh.positions(v, 0), source.mesh.positions(v, 1));
        const Complex derivative = 1.0 + 0.6 * z / static_cast<double>(face.size());
        phi[s] = derivative * derivative;
    }
    return phi;
}

int flipped(const Surface& source, const Eigen::VectorXcd& map) {
    return static_cast<int>(distortion(source.operators, map).flipped.size());
}

/// Triangles, quads and both.
std::vector<Surface> squares() {
    std::vector<Surface> result;
    result.emplace_back(test::jittered_square(12));
    result.emplace_back(test::quad_square(12, 0.2));
    result.emplace_back(test::mixed_square(12));
    return result;
}

// ---- the energy -----------------------------------------------------------------------------------------------------

TEST(DilatationSpread, OfAnAffineMapIsKnown) {
    for (const Surface& source : squares()) {
        DilatationSpread spread(source.operators);
        spread.set_map(values(source, affine));
        spread.set_coefficient(kAffine, constant_phi(source, 3.0), 0.07);
        EXPECT_NEAR(spread.value(0).energy, 0, 1e-28);
        // r² = (k₁ − k)² (1 + k²)/(1 + k₁²) everywhere; the anchored term is the same for this phase.
        const double k = 0.3, r2 = (kAffine - k) * (kAffine - k) * (1 + k * k) / (1 + kAffine * kAffine);
        spread.set_coefficient(k, constant_phi(source, 3.0), 0.07);
        EXPECT_NEAR(spread.value(0).energy, 1.07 * r2, 1e-14);
        EXPECT_NEAR(spread.value(50).energy, r2 * (1 + 50 * r2) + 0.07 * r2, 1e-14);
        // The opposite phase: |q − νp|² = (k₁ + k)² |p|².
        spread.set_coefficient(k, constant_phi(source, -1.0), 0.07);
        const double opposite = (kAffine + k) * (kAffine + k) * (1 + k * k) / (1 + kAffine * kAffine);
        EXPECT_NEAR(spread.value(0).energy, r2 + 0.07 * opposite, 1e-14);
        EXPECT_EQ(spread.value(0).flipped, 0);
        spread.set_map(values(source, [](Complex z) { return std::conj(z) + 0.1 * z; }));
        EXPECT_EQ(spread.value(0).flipped, source.operators.sample_count());
    }
}

/// The energy's derivatives along a direction, as the elements have them.
std::array<double, 2> derivatives_along(const DilatationSpread& spread, const Eigen::VectorXcd& d, double penalty,
                                        Derivative derivative, double damping = 0) {
    std::array<double, 2> result{0, 0};
    const Operators& operators = spread.operators();
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto e = spread.element(s, penalty, derivative, damping);
        const auto stencil = operators.stencil(s);
        std::vector<double> x;
        for (const int v : stencil) {
            x.push_back(d[v].real());
            x.push_back(d[v].imag());
        }
        int slot = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            result[0] += e.gradient[i] * x[i];
            for (std::size_t j = 0; j <= i; ++j) result[1] += (i == j ? 1 : 2) * e.hessian[slot++] * x[i] * x[j];
        }
    }
    return result;
}

TEST(DilatationSpread, ExactDerivativesAgreeWithDifferences) {
    for (const Surface& source : squares()) {
        const Eigen::VectorXcd f = values(source, test::exact_composition, 0.01),
                               d = values(source, [](Complex z) { return std::sin(3.0 * z) - std::conj(z); });
        DilatationSpread spread(source.operators);
        spread.set_coefficient(0.45, exact_phi(source), 0);
        const double h = 1e-6;
        const auto at = [&](double t, double penalty) {
            spread.set_map(f + t * d);
            return spread.value(penalty).energy;
        };
        for (const double penalty : {0.0, 100.0}) {
            const double slope = (at(h, penalty) - at(-h, penalty)) / (2 * h);
            spread.set_map(f);
            const double found = 2 * derivatives_along(spread, d, penalty, Derivative::exact)[0];
            EXPECT_NEAR(found, slope, 1e-7 * (1 + std::abs(slope)));
        }
        // Gauss-Newton: Σ w (dr)², with dr from differences.
        std::vector<double> r;
        for (const double t : {h, -h}) {
            spread.set_map(f + t * d);
            for (const SpreadSample& s : spread.samples()) r.push_back(spread_term_exact(s, spread.k()).r);
        }
        double sum = 0;
        for (std::size_t s = 0; s < spread.samples().size(); ++s) {
            const double slope = (r[s] - r[s + spread.samples().size()]) / (2 * h);
            sum += spread.samples()[s].weight * slope * slope;
        }
        spread.set_map(f);
        EXPECT_NEAR(derivatives_along(spread, d, 0, Derivative::exact)[1], sum, 1e-6 * sum);
    }
}

TEST(DilatationSpread, HeldDerivativesAreThoseOfAConstantSize) {
    for (const Surface& source : squares()) {
        const Eigen::VectorXcd f = values(source, test::exact_composition, 0.01),
                               d = values(source, [](Complex z) { return std::sin(3.0 * z) - std::conj(z); });
        DilatationSpread spread(source.operators);
        const double k = 0.45, h = 1e-6;
        spread.set_coefficient(k, exact_phi(source), 0.3);
        spread.set_map(f);
        const std::vector<SpreadSample> base = spread.samples();
        const auto at = [&](double t) {
            spread.set_map(f + t * d);
            double sum = 0;
            for (std::size_t i = 0; i < base.size(); ++i) {
                const SpreadSample& s = spread.samples()[i];
                const double size = 1 / spread_term_held(base[i], k).inverse_size;
                const Complex p(s.p_re, s.p_im), q(s.q_re, s.q_im), nu(s.nu_re, s.nu_im);
                const double r = (std::abs(q) - k * std::abs(p)) / size;
                sum += s.weight * r * r + s.anchor * std::norm((q - nu * p) / size);
            }
            return sum;
        };
        const double slope = (at(h) - at(-h)) / (2 * h);
        spread.set_map(f);
        const auto found = derivatives_along(spread, d, 0, Derivative::size_held);
        EXPECT_NEAR(2 * found[0], slope, 1e-7 * (1 + std::abs(slope)));
        // Along a real direction the damping's Dirichlet energy is Σ 2 w |C d|².
        const Eigen::VectorXcd real = d.real().cast<Complex>();
        spread.set_map(real);
        const std::vector<SpreadSample> moved = spread.samples();
        spread.set_map(f);
        double dirichlet = 0;
        for (std::size_t i = 0; i < base.size(); ++i) {
            const SpreadSample& s = moved[i];
            const Complex p(s.p_re, s.p_im), q(s.q_re, s.q_im), nu(s.nu_re, s.nu_im);
            dirichlet += 2 * s.weight * std::norm((q - nu * p) * spread_term_held(base[i], k).inverse_size);
        }
        const double damped = derivatives_along(spread, real, 0, Derivative::size_held, 0.5)[1] -
                              derivatives_along(spread, real, 0, Derivative::size_held)[1];
        EXPECT_NEAR(damped, 0.5 * dirichlet, 1e-10 * dirichlet);
    }
}

// ---- the parts ------------------------------------------------------------------------------------------------------

TEST(DilatationSweeps, LowerTheEnergyAndFoldNothing) {
    for (const Surface& source : squares())
        for (const double penalty : {0.0, 100.0}) {
            const std::vector<Freedom> freedoms = boundary_fixed(source);
            const DilatationSweeps sweeps(source.operators, VertexSamples(source.operators), freedoms);
            const Eigen::VectorXcd start = values(source, test::exact_composition, 0.03);
            Eigen::VectorXcd f = start;
            DilatationSpread spread(source.operators);
            spread.set_coefficient(0.5, exact_phi(source), 0.07);
            spread.set_map(f);
            DilatationSpread::Value last = spread.value(penalty);
            ASSERT_GT(last.flipped, 0);
            const double first = last.energy;
            for (int sweep = 0; sweep < 20; ++sweep) {
                sweeps.run(spread, f, 1, penalty);
                const DilatationSpread::Value now = spread.value(penalty);
                EXPECT_LE(now.energy, last.energy * (1 + 1e-12));
                EXPECT_LE(now.flipped, last.flipped);
                last = now;
            }
            EXPECT_LT(last.energy, 0.2 * first);
            for (int v = 0; v < f.size(); ++v)
                if (freedoms[v] == Freedom::fixed) {
                    EXPECT_EQ(f[v], start[v]);
                }
        }
}

TEST(DilatationSweeps, UseFewColours) {
    // Greedy colouring takes at most one more than a vertex has neighbours; 4 are needed for a grid of quads.
    const Surface triangles(disk(12)), quads(test::quad_square(12, 0.2));
    EXPECT_LE(DilatationSweeps(triangles.operators, VertexSamples(triangles.operators), boundary_fixed(triangles))
                  .colour_count(),
              7);
    EXPECT_EQ(DilatationSweeps(quads.operators, VertexSamples(quads.operators), boundary_fixed(quads)).colour_count(),
              4);
}

TEST(DilatationPatches, RepairAnOutlier) {
    for (const Surface& source : squares()) {
        std::vector<Freedom> freedoms = boundary_fixed(source);
        Eigen::VectorXcd f = values(source, affine);
        // One vertex sits where its faces are folded.
        int worst = -1;
        double nearest = 1;
        for (int v = 0; v < f.size(); ++v) {
            const double distance = std::hypot(source.mesh.positions(v, 0) - 0.5, source.mesh.positions(v, 1) - 0.5);
            if (distance < nearest) nearest = distance, worst = v;
        }
        f[worst] += 0.15;
        DilatationSpread spread(source.operators);
        spread.set_coefficient(kAffine, constant_phi(source), 0.07);
        spread.set_map(f);
        ASSERT_GT(spread.value(0).flipped, 0);
        const VertexSamples around(source.operators);
        const Eigen::VectorXcd before = f;
        const DilatationPatches small(source.operators, around, freedoms, {0.07, 5});
        EXPECT_EQ(small.run(spread, f, 2), 0);  // too large for its limit
        EXPECT_EQ(f, before);
        const DilatationPatches patches(source.operators, around, freedoms, {0.07, 300});
        EXPECT_GT(patches.run(spread, f, 2), 0);
        EXPECT_EQ(spread.value(0).flipped, 0);
        const Distortion after = distortion(source.operators, f);
        EXPECT_NEAR(after.max, kAffine, 0.07);
        EXPECT_EQ(patches.run(spread, f, 2), 0);
    }
}

// ---- the whole ------------------------------------------------------------------------------------------------------

TEST(EvenDilatation, FindsAnAffineMapAgain) {
    for (const Surface& source : squares()) {
        const Eigen::VectorXcd start = values(source, affine, 0.02);
        const EvenDilatation even =
            even_dilatation(source, boundary_fixed(source), start, kAffine, constant_phi(source, {2, 0}));
        EXPECT_TRUE(even.improved);
        EXPECT_EQ(even.flipped, 0);
        EXPECT_LT(even.energy, 1e-4 * even.start_energy);
        const Distortion after = distortion(source.operators, even.map);
        EXPECT_LT(after.standard_deviation, 2e-3);
        EXPECT_NEAR(after.mean, kAffine, 1e-3);
        EXPECT_LT((even.map - values(source, affine)).cwiseAbs().maxCoeff(), 2e-3);
        EXPECT_GT(even.factorizations, 0);
    }
}

TEST(EvenDilatation, TakesFewerStepsWhereAsked) {
    const Surface source(test::jittered_square(12));
    const Eigen::VectorXcd start = values(source, affine, 0.02);
    for (int steps = 0; steps <= 3; ++steps) {
        EvenDilatationOptions options;
        options.steps = steps;
        const EvenDilatation even =
            even_dilatation(source, boundary_fixed(source), start, kAffine, constant_phi(source), {}, options);
        EXPECT_EQ(even.factorizations, steps);
        EXPECT_EQ(even.flipped, 0);
        EXPECT_LT(even.energy, 0.01 * even.start_energy) << steps;
    }
}

TEST(EvenDilatation, KeepsAGoodMap) {
    for (const Mesh& mesh : {disk(16), test::quad_disk(9)}) {
        const Surface source(mesh);
        const Eigen::VectorXcd start = values(source, test::exact_composition);
        const EvenDilatation even = even_dilatation(source, boundary_fixed(source), start, 0.5, exact_phi(source));
        const Distortion before = distortion(source.operators, start), after = distortion(source.operators, even.map);
        EXPECT_LE(even.energy, even.start_energy);
        EXPECT_LE(after.standard_deviation, before.standard_deviation * 1.02);
        EXPECT_NEAR(after.mean, 0.5, 2e-3);
        EXPECT_EQ(even.flipped, 0);
        EXPECT_LT((even.map - start).cwiseAbs().maxCoeff(), 0.02);
    }
}

TEST(EvenDilatation, OpensFoldsAndMakesNone) {
    for (const Surface& source : squares()) {
        const Eigen::VectorXcd start = values(source, affine, 0.06);
        ASSERT_GT(flipped(source, start), 10);
        const EvenDilatation even =
            even_dilatation(source, boundary_fixed(source), start, kAffine, constant_phi(source));
        EXPECT_GT(even.start_flipped, 0);
        EXPECT_EQ(even.flipped, 0);
        EXPECT_EQ(flipped(source, even.map), 0);
        EXPECT_LT(even.energy, even.start_energy);
    }
}

TEST(EvenDilatation, IsNeverWorseForAWrongDifferential) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(0, 6.3);
    for (const Surface& source : squares()) {
        Eigen::VectorXcd phi(source.operators.sample_count());
        for (auto& value : phi) value = std::polar(1.0, angle(random));
        const Eigen::VectorXcd start = values(source, test::exact_composition);
        ASSERT_EQ(flipped(source, start), 0);
        for (const double k : {0.0, 0.2, 0.9}) {
            const EvenDilatation even = even_dilatation(source, boundary_fixed(source), start, k, phi);
            EXPECT_EQ(flipped(source, even.map), 0);
            EXPECT_LE(even.energy, even.start_energy);
            EXPECT_EQ(even.improved, even.map != start);
        }
    }
}

TEST(EvenDilatation, SaysThatFoldsRemain) {
    // A face whose vertices are all fixed is folded.
    const Surface source(test::jittered_square(12));
    Eigen::VectorXcd start = values(source, affine, 0.02);
    std::vector<Freedom> freedoms = boundary_fixed(source);
    const auto face = source.mesh.faces[2 * (12 * 6 + 6)];
    for (const int v : face) freedoms[v] = Freedom::fixed;
    std::swap(start[face[0]], start[face[1]]);
    const EvenDilatation even = even_dilatation(source, freedoms, start, kAffine, constant_phi(source));
    EXPECT_GE(even.flipped, 1);
    EXPECT_LE(even.flipped, even.start_flipped);
    EXPECT_LT(even.energy, even.start_energy);
    for (const int v : face) EXPECT_EQ(even.map[v], start[v]);
}

TEST(EvenDilatation, HoldsWhatIsNotFree) {
    for (const Surface& source : squares()) {
        std::vector<Freedom> freedoms = boundary_fixed(source);
        for (int v = 0; v < source.mesh.vertex_count(); v += 7)
            if (freedoms[v] == Freedom::free) freedoms[v] = v % 2 ? Freedom::fixed : Freedom::sliding;
        const Eigen::VectorXcd start = values(source, test::exact_composition, 0.01);
        const EvenDilatation even = even_dilatation(source, freedoms, start, 0.5, exact_phi(source));
        EXPECT_TRUE(even.improved);
        for (int v = 0; v < start.size(); ++v)
            if (freedoms[v] != Freedom::free) {
                EXPECT_EQ(even.map[v], start[v]);
            }
    }
}

TEST(EvenDilatation, DoesNotDependOnThreads) {
    const Surface source(test::quad_disk(14));
    // Two inner vertices held in wrong places: patches around them.
    std::vector<Freedom> freedoms = boundary_fixed(source);
    Eigen::VectorXcd start = values(source, test::exact_composition, 0.012);
    const Eigen::VectorXcd phi = exact_phi(source), z = test::complex_positions(source.mesh);
    for (const Complex at : {Complex(0.4, 0), Complex(-0.4, 0.1)}) {
        Eigen::Index v;
        (z.array() - at).abs().minCoeff(&v);
        freedoms[v] = Freedom::fixed;
        start[v] += 0.05;
    }
    const int threads = thread_count();
    set_thread_count(1);
    const EvenDilatation one = even_dilatation(source, freedoms, start, 0.5, phi);
    set_thread_count(3);
    const EvenDilatation three = even_dilatation(source, freedoms, start, 0.5, phi);
    set_thread_count(threads);
    ASSERT_TRUE(one.improved);
    ASSERT_GT(one.patch_steps, 0);
    EXPECT_EQ(one.map, three.map);
    EXPECT_EQ(one.energy, three.energy);
    EXPECT_EQ(one.patch_steps, three.patch_steps);
}

TEST(EvenDilatation, IsInvariantUnderSimilarities) {
    for (const Mesh& mesh : {test::jittered_square(12), test::mixed_square(10)}) {
        const Surface source(mesh);
        const Eigen::VectorXcd start = values(source, test::exact_composition, 0.01), phi = exact_phi(source);
        const EvenDilatation even = even_dilatation(source, boundary_fixed(source), start, 0.5, phi);
        ASSERT_TRUE(even.improved);

        const Complex turn = std::polar(37.0, 1.1), shift(3, -2);
        Mesh moved = mesh;
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        for (int v = 0; v < z.size(); ++v) {
            const Complex w = turn * z[v] + shift;
            moved.positions.row(v) << w.real(), w.imag();
        }
        const Surface turned(moved);
        const EvenDilatation of_source =
            even_dilatation(turned, boundary_fixed(turned), start, 0.5, phi / (turn * turn));
        EXPECT_LT((of_source.map - even.map).cwiseAbs().maxCoeff(), 1e-8);
        EXPECT_NEAR(of_source.energy, even.energy, 1e-9 * even.energy);

        const Complex image = std::polar(0.02, -2.0);
        const EvenDilatation of_image =
            even_dilatation(source, boundary_fixed(source), (image * start.array() + shift).matrix(), 0.5, 5.0 * phi);
        EXPECT_LT((((of_image.map.array() - shift) / image) - even.map.array()).abs().maxCoeff(), 1e-8);
        EXPECT_NEAR(of_image.energy, even.energy, 1e-9 * even.energy);
    }
}

TEST(EvenDilatation, ReadsAMetricOnly) {
    // The same plane mesh rolled up in space: isometric faces, frames along their first edges.
    const Surface flat(test::jittered_square(10));
    Mesh rolled = flat.mesh;
    rolled.positions.resize(flat.mesh.vertex_count(), 3);
    Positions corners(flat.mesh.faces.corner_count(), 2);
    for (int v = 0; v < flat.mesh.vertex_count(); ++v)
        rolled.positions.row(v) << std::sin(flat.mesh.positions(v, 0)), flat.mesh.positions(v, 1),
            std::cos(flat.mesh.positions(v, 0));
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = flat.mesh.positions.row(flat.mesh.faces.vertices()[c]);
    const Surface own_metric(rolled, corners);
    const Eigen::VectorXcd start = values(flat, affine, 0.01);
    // φ dz² in the frame of the first edge e: φ (e/|e|)².
    Eigen::VectorXcd phi(flat.operators.sample_count());
    const Eigen::VectorXcd z = test::complex_positions(flat.mesh);
    for (int s = 0; s < phi.size(); ++s) {
        const auto v = flat.mesh.faces[flat.operators.faces[s]];
        const Complex edge = z[v[1]] - z[v[0]];
        phi[s] = edge * edge / std::norm(edge);
    }
    const EvenDilatation plane = even_dilatation(flat, boundary_fixed(flat), start, kAffine, constant_phi(flat)),
                         metric = even_dilatation(own_metric, boundary_fixed(flat), start, kAffine, phi);
    ASSERT_TRUE(plane.improved);
    EXPECT_LT((plane.map - metric.map).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(EvenDilatation, WorksWithoutFixedVertices) {
    const Surface source(test::jittered_square(10));
    const std::vector<Freedom> freedoms(source.mesh.vertex_count(), Freedom::free);
    const EvenDilatation even =
        even_dilatation(source, freedoms, values(source, affine, 0.02), kAffine, constant_phi(source));
    EXPECT_TRUE(even.improved);
    EXPECT_LT(even.energy, 0.05 * even.start_energy);
    EXPECT_TRUE(even.map.allFinite());
}

TEST(EvenDilatation, TakesNewCoefficients) {
    const Surface source(test::jittered_square(12));
    const Eigen::VectorXcd start = values(source, affine, 0.02);
    int calls = 0;
    const EvenDilatation even =
        even_dilatation(source, boundary_fixed(source), start, 0.2, constant_phi(source, {0, 1}),
                        [&](const Eigen::VectorXcd& map, Eigen::VectorXcd& phi, double& k) {
                            ++calls;
                            EXPECT_EQ(map.size(), start.size());
                            phi = constant_phi(source);
                            k = kAffine;
                            return true;
                        });
    EXPECT_GE(calls, 1);
    EXPECT_LE(calls, 3);
    EXPECT_EQ(even.k, kAffine);
    EXPECT_EQ(even.phi, constant_phi(source));
    EXPECT_LT(distortion(source.operators, even.map).standard_deviation, 3e-3);
    EXPECT_THROW(even_dilatation(source, boundary_fixed(source), start, 0.2, constant_phi(source),
                                 [](const Eigen::VectorXcd&, Eigen::VectorXcd&, double& k) {
                                     k = 1;
                                     return true;
                                 }),
                 Error);
}

TEST(EvenDilatation, RefusesNonsense) {
    const Surface source(test::jittered_square(4));
    const Eigen::VectorXcd start = values(source, affine), phi = constant_phi(source);
    const std::vector<Freedom> freedoms = boundary_fixed(source);
    const auto cause = [&](const std::function<void()>& call) {
        try {
            call();
        } catch (const Error& error) {
            return static_cast<int>(error.cause());
        }
        return -1;
    };
    const int bad_option = static_cast<int>(Cause::bad_option);
    EvenDilatationOptions four_steps;
    four_steps.steps = 4;
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, 0.5, phi, {}, four_steps); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, 1, phi); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, -0.1, phi); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, 0.5, phi.head(3)); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start.head(3), 0.5, phi); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, {}, start, 0.5, phi); }), bad_option);
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start * NAN, 0.5, phi); }),
              static_cast<int>(Cause::bad_boundary));
    EvenDilatationOptions options;
    options.anchor = -1;
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, 0.5, phi, {}, options); }), bad_option);
    options = {};
    options.progress = [](int, double) { return false; };
    EXPECT_EQ(cause([&] { even_dilatation(source, freedoms, start, 0.5, phi, {}, options); }),
              static_cast<int>(Cause::cancelled));
}

}  // namespace
}  // namespace beltrami
