#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/baselines/baseline.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/distortion_energy.h>

#include "support/real_mesh.h"

#include "baseline_shapes.h"

namespace beltrami {
namespace {

using namespace baseline_tests;

using Function = BaselineMap (*)(const Surface&, const BoundaryCondition&, const BaselineOptions&);
struct Method {
    const char* name;
    Function map;
};
const std::vector<Method> kAll{{"harmonic", harmonic_baseline},
                               {"lscm", lscm_baseline},
                               {"arap", arap_baseline},
                               {"mips", mips_baseline},
                               {"alternation", alternation_baseline},
                               {"qc", qc_iteration_baseline}};
const std::vector<Method> kFree{{"lscm", lscm_baseline}, {"arap", arap_baseline}, {"mips", mips_baseline}};

/// A hill without symmetry over the ringed_disk.
Mesh hill(int rings) {
    return bent(ringed_disk(rings), [](double x, double y) {
        return Eigen::Vector3d(x, y, 0.9 * std::exp(-4 * ((x - 0.2) * (x - 0.2) + y * y)) + 0.2 * x * y);
    });
}

/// The boundary of a ringed_disk-like surface in space to a circle, by the angle of its points, unevenly.
BoundaryCondition to_circle(const Surface& source, double uneven) {
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) {
        const double t = std::atan2(source.mesh.positions(v, 1), source.mesh.positions(v, 0));
        boundary.pin(v, std::polar(1.0, t + uneven * std::sin(t)));
    }
    return boundary;
}

/// Σ A ‖Df − R‖² per area.
double arap_energy(const Surface& source, const Eigen::VectorXcd& f) {
    double energy = 0;
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [d_z, d_zbar] = source.operators.derivatives(s, f);
        const double stretch = std::abs(d_z) - 1;
        energy += 2 * source.operators.weights[s] * (stretch * stretch + std::norm(d_zbar));
    }
    return energy / source.operators.area();
}

bool mentions(const BaselineMap& result, const std::string& word) {
    return std::any_of(result.warnings.begin(), result.warnings.end(),
                       [&](const Warning& warning) { return warning.sentence.find(word) != std::string::npos; });
}

// ---- all methods ----------------------------------------------------------------------------------------------------

TEST(Baselines, TheIdentityOnTheBoundaryGivesTheIdentity) {
    for (const Mesh& mesh : {ringed_disk(8), square(8, false), square(8, true)}) {
        const Surface source(mesh);
        const BoundaryCondition boundary = prescribe(source, [](Complex z) { return z; });
        for (const Method& method : kAll) {
            const BaselineMap result = method.map(source, boundary, {});
            EXPECT_TRUE(result.converged) << method.name;
            EXPECT_TRUE(result.warnings.empty()) << method.name;
            EXPECT_LT(difference(result.map, points(mesh)), 1e-7) << method.name;
            EXPECT_GE(result.factorizations, 1) << method.name;
        }
    }
}

TEST(Baselines, KeepPrescribedVerticesWhereTheyAre) {
    const Surface source(hill(8));
    for (const BoundaryCondition& boundary : {to_circle(source, 0.5), [] {
                                                  BoundaryCondition pins;
                                                  pins.pin(0, Complex(0.1, 0.2));
                                                  pins.pin(100, Complex(1.2, 0.3));
                                                  pins.pin(180, Complex(-1.0, 0.4));
                                                  return pins;
                                              }()})
        for (const Method& method : kAll) {
            const bool whole = method.map == harmonic_baseline || method.map == alternation_baseline ||
                               method.map == qc_iteration_baseline;
            if (boundary.vertices.size() == 3 && whole) continue;
            const BaselineMap result = method.map(source, boundary, {});
            for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
                EXPECT_EQ(result.map[boundary.vertices[i]], boundary.images[i]) << method.name;
            EXPECT_TRUE(result.converged) << method.name;
        }
}

TEST(Baselines, FollowSimilaritiesOfTheImageAndOfTheSource) {
    const Mesh mesh = hill(8);
    const Surface source(mesh);
    const BoundaryCondition boundary = to_circle(source, 0.5);
    for (const double size : {1e-6, 1.0, 1e6})
        for (const Complex factor : {std::polar(1e-6, 0.3), std::polar(1e6, 2.0)}) {
            const Surface other(scaled(mesh, size));
            BoundaryCondition moved = boundary;
            for (Complex& image : moved.images) image = factor * (image + Complex(2, -1));
            for (const Method& method : kAll) {
                const BaselineMap expected = method.map(source, boundary, {}), result = method.map(other, moved, {});
                const Eigen::VectorXcd wanted = factor * (expected.map.array() + Complex(2, -1));
                EXPECT_LT(difference(result.map, wanted), 1e-8) << method.name << ' ' << size;
                EXPECT_TRUE(result.converged) << method.name;
                EXPECT_EQ(result.iterations, expected.iterations) << method.name;
            }
        }
}

TEST(Baselines, FreeMapsFollowTheScaleOfTheSource) {
    const Mesh mesh = hill(8);
    for (const Method& method : kFree) {
        const BaselineMap expected = method.map(Surface(mesh), {}, {});
        EXPECT_TRUE(expected.converged) << method.name;
        for (const double size : {1e-6, 1e6}) {
            const BaselineMap result = method.map(Surface(scaled(mesh, size)), {}, {});
            EXPECT_TRUE(result.converged) << method.name;
            EXPECT_LT(difference_up_to_similarity(result.map, expected.map), 1e-7) << method.name;
            if (method.map == arap_baseline) {
                EXPECT_LT(difference(result.map / size, expected.map), 1e-7);
            }
        }
    }
}

TEST(Baselines, FreeMapsOfAPlanarMeshAreSimilarities) {
    for (const bool quads : {false, true}) {
        const Surface source(square(7, quads));
        for (const Method& method : kFree)
            EXPECT_LT(difference_up_to_similarity(method.map(source, {}, {}).map, points(source.mesh)), 1e-6)
                << method.name;
    }
}

TEST(Baselines, RecordABoundaryThatForcesFolds) {
    const Surface source(ringed_disk(6));
    const BoundaryCondition clockwise = prescribe(source, [](Complex z) { return std::conj(z); });
    for (const Method& method : kAll) {
        const BaselineMap result = method.map(source, clockwise, {});
        EXPECT_FALSE(result.converged) << method.name;
        EXPECT_TRUE(mentions(result, "encloses no positive area")) << method.name;
        EXPECT_EQ(result.map.size(), source.mesh.vertex_count());
    }
}

void expect_error(Cause cause, const char* part, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << "no error, though one with '" << part << "' was due";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), cause) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Baselines, RejectWhatIsMissing) {
    const Surface source(ringed_disk(3));
    BoundaryCondition one, same, partial;
    one.pin(0, 0.0);
    same.pin(0, 1.0);
    same.pin(5, 1.0);
    partial.pin(30, 1.0);
    partial.pin(31, 2.0);
    expect_error(Cause::bad_boundary, "without a prescribed image", [&] { harmonic_baseline(source, partial); });
    expect_error(Cause::bad_boundary, "without a prescribed image", [&] { harmonic_baseline(source, {}); });
    expect_error(Cause::bad_boundary, "without a prescribed image", [&] { alternation_baseline(source, partial); });
    expect_error(Cause::bad_boundary, "without a prescribed image", [&] { qc_iteration_baseline(source, partial); });
    expect_error(Cause::bad_boundary, "two pins", [&] { lscm_baseline(source, one); });
    for (const Method& method : kFree)
        expect_error(Cause::bad_boundary, "two pins", [&] { method.map(source, same, {}); });

    Mesh tetrahedron;
    tetrahedron.positions.resize(4, 3);
    tetrahedron.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    for (const auto& face : {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}})
        tetrahedron.faces.add(face);
    const Surface closed(tetrahedron);
    for (const Method& method : kAll)
        expect_error(Cause::bad_mesh, "closed surface", [&] { method.map(closed, one, {}); });

    Mesh pair = ringed_disk(2);
    const int n = pair.vertex_count();
    const FaceList single = pair.faces;
    pair.positions.conservativeResize(2 * n, Eigen::NoChange);
    pair.positions.bottomRows(n) = pair.positions.topRows(n).rowwise() + Eigen::RowVector2d(3, 0);
    for (int f = 0; f < single.size(); ++f) pair.faces.add({single[f][0] + n, single[f][1] + n, single[f][2] + n});
    const Surface two(pair);
    const BoundaryCondition identity = prescribe(two, [](Complex z) { return z; });
    for (const Method& method : kAll)
        expect_error(Cause::bad_mesh, "the mesh has 2 components", [&] { method.map(two, identity, {}); });
    for (const Method& method : kFree)
        expect_error(Cause::bad_mesh, "the mesh has 2 components", [&] { method.map(two, {}, {}); });

    for (const Method& method : kAll) {
        BaselineOptions options;
        options.max_iterations = 0;
        expect_error(Cause::bad_option, "max_iterations", [&] { method.map(source, one, options); });
        options = {};
        options.tolerance = 0;
        expect_error(Cause::bad_option, "tolerance", [&] { method.map(source, one, options); });
        options = {};
        options.smoothing = 1.5;
        expect_error(Cause::bad_option, "smoothing", [&] { method.map(source, one, options); });
        options = {};
        options.smoothing_passes = -1;
        expect_error(Cause::bad_option, "smoothing_passes", [&] { method.map(source, one, options); });
    }
}

TEST(Baselines, CanBeCancelledAndLimited) {
    const Surface source(hill(8));
    const BoundaryCondition boundary = to_circle(source, 0.5);
    for (const Method& method : {Method{"arap", arap_baseline}, Method{"mips", mips_baseline},
                                 Method{"alternation", alternation_baseline}, Method{"qc", qc_iteration_baseline}}) {
        BaselineOptions options;
        options.progress = [](int iteration, double) { return iteration < 2; };
        expect_error(Cause::cancelled, "2", [&] { method.map(source, boundary, options); });
        options = {};
        options.max_iterations = 2;
        const BaselineMap result = method.map(source, boundary, options);
        EXPECT_EQ(result.iterations, 2);
        EXPECT_FALSE(result.converged);
        EXPECT_TRUE(mentions(result, "stopped after 2")) << method.name;
    }
}

// ---- ARAP -----------------------------------------------------------------------------------------------------------

TEST(Arap, IsAnIsometryOfADevelopableSurface) {
    // Strips of a prism over an arc: a discrete cylinder, flattened without any distortion.
    const Surface source(bent(square(12, false, 0),
                              [](double x, double y) { return Eigen::Vector3d(std::sin(3 * x), std::cos(3 * x), y); }));
    BoundaryCondition pin;
    pin.pin(17, Complex(3, 4));
    for (const BoundaryCondition& boundary : {BoundaryCondition(), pin}) {
        const BaselineMap result = arap_baseline(source, boundary);
        EXPECT_TRUE(result.converged);
        EXPECT_LT(arap_energy(source, result.map), 1e-16);
        for (const auto& [a, b] : source.topology.edges)
            EXPECT_NEAR(std::abs(result.map[a] - result.map[b]), (source.mesh.point(a) - source.mesh.point(b)).norm(),
                        1e-8);
        EXPECT_TRUE(distortion(source.operators, result.map).flipped.empty());
    }
    EXPECT_EQ(arap_baseline(source, pin).map[17], Complex(3, 4));
    EXPECT_GT(arap_energy(source, least_squares_conformal_map(source, {})), 1e-3) << "the start is no isometry";
}

TEST(Baselines, FreeBoundariesKeepTheArea) {
    const Surface source(bent(square(12, false, 0),
                              [](double x, double y) { return Eigen::Vector3d(x, y, 0.3 * std::sin(4 * x) * y); }));
    const double area = source.operators.area();
    for (const auto method : {lscm_baseline, mips_baseline}) {
        const Eigen::VectorXcd map = method(source, {}, {}).map;
        double image = 0;
        for (int s = 0; s < source.operators.sample_count(); ++s) {
            const auto [d_z, d_zbar] = source.operators.derivatives(s, map);
            image += source.operators.weights[s] * (std::norm(d_z) - std::norm(d_zbar));
        }
        EXPECT_NEAR(image / area, 1, 1e-10);
    }
}

TEST(Arap, EnergyNeverRises) {
    const Surface lobes(ringed_disk(12)), surface(hill(12));
    struct Case {
        const Surface& source;
        BoundaryCondition boundary;
    };
    for (const Case& tested :
         {Case{lobes, prescribe(lobes, three_lobes)}, Case{surface, to_circle(surface, 0.5)}, Case{surface, {}}}) {
        std::vector<double> energies;
        BaselineOptions options;
        options.tolerance = 1e-7;
        options.progress = [&](int iteration, double energy) {
            EXPECT_EQ(iteration, static_cast<int>(energies.size()) + 1);
            energies.push_back(energy);
            return true;
        };
        const BaselineMap result = arap_baseline(tested.source, tested.boundary, options);
        EXPECT_TRUE(result.converged);
        ASSERT_GT(energies.size(), 5u);
        EXPECT_EQ(result.iterations, static_cast<int>(energies.size()));
        EXPECT_EQ(result.factorizations, 2) << "one for the start, one for all steps";
        for (std::size_t i = 1; i < energies.size(); ++i) EXPECT_LE(energies[i], energies[i - 1] * (1 + 1e-14));
        EXPECT_LT(energies.back(), energies.front() * (1 - 1e-4));
        if (tested.boundary.empty()) {
            EXPECT_NEAR(energies.back(), arap_energy(tested.source, result.map), 1e-12);
        }
    }
}

TEST(Arap, EndsWhereTheEnergyIsStationary) {
    const Surface source(hill(6));
    BaselineOptions options;
    options.tolerance = 1e-9;
    options.max_iterations = 100000;
    const Eigen::VectorXcd f = arap_baseline(source, {}, options).map;
    const double h = 1e-4, energy = arap_energy(source, f);
    for (Eigen::Index v = 0; v < f.size(); ++v)
        for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
            Eigen::VectorXcd right = f, left = f;
            right[v] += h * direction;
            left[v] -= h * direction;
            EXPECT_NEAR((arap_energy(source, right) - arap_energy(source, left)) / (2 * h), 0, 1e-6);
            EXPECT_GT(arap_energy(source, right), energy);
        }
}

// ---- MIPS -----------------------------------------------------------------------------------------------------------

/// The gradient of the MIPS energy at free vertices, largest, relative to that of another map.
double relative_gradient(const Surface& source, const BoundaryCondition& boundary, const Eigen::VectorXcd& f,
                         const Eigen::VectorXcd& other) {
    const DistortionEnergy energy(source.operators, Eigen::VectorXcd::Zero(source.operators.sample_count()), 1);
    Eigen::VectorXcd here = energy.gradient(f, {}), there = energy.gradient(other, {});
    for (const int v : boundary.vertices) here[v] = there[v] = 0;
    return here.cwiseAbs().maxCoeff() / there.cwiseAbs().maxCoeff();
}

TEST(Mips, EnergyFallsToAStationaryMapWithoutFolds) {
    const Surface source(hill(12));
    for (const BoundaryCondition& boundary : {to_circle(source, 0.4), BoundaryCondition()}) {
        std::vector<double> energies;
        BaselineOptions options;
        options.tolerance = 1e-7;
        options.progress = [&](int, double energy) {
            energies.push_back(energy);
            return true;
        };
        const BaselineMap result = mips_baseline(source, boundary, options);
        EXPECT_TRUE(result.converged);
        EXPECT_TRUE(result.warnings.empty());
        EXPECT_LE(result.iterations, 20);
        EXPECT_GT(result.factorizations, result.iterations);
        for (std::size_t i = 1; i < energies.size(); ++i) EXPECT_LE(energies[i], energies[i - 1]);
        const Distortion d = distortion(source.operators, result.map);
        EXPECT_TRUE(d.flipped.empty());
        const Eigen::VectorXcd start =
            boundary.empty() ? least_squares_conformal_map(source, {}) : harmonic_map(source, boundary);
        EXPECT_LT(relative_gradient(source, boundary, result.map, start), 1e-5);
        // The mean of (1+|μ|²)/(1−|μ|²), computed from μ alone.
        double mean = 0;
        for (Eigen::Index s = 0; s < d.mu.size(); ++s)
            mean += source.operators.weights[s] * (1 + std::norm(d.mu[s])) / (1 - std::norm(d.mu[s]));
        EXPECT_NEAR(mean / source.operators.area(), energies.back(), 1e-10);
    }
}

TEST(Mips, UntanglesThreeLobes) {
    const Surface source(ringed_disk(27));
    const BoundaryCondition boundary = prescribe(source, three_lobes);
    const BaselineMap start = harmonic_baseline(source, boundary);
    ASSERT_GT(distortion(source.operators, start.map).flipped.size(), 100u);
    EXPECT_TRUE(mentions(start, "flipped"));
    const BaselineMap result = mips_baseline(source, boundary);
    EXPECT_TRUE(result.converged);
    EXPECT_TRUE(mentions(result, "unfolded"));
    EXPECT_TRUE(distortion(source.operators, result.map).flipped.empty());
    EXPECT_LE(result.iterations, 40);
}

TEST(Mips, StartsFromTuttesMapWhereTheHarmonicOneFolds) {
    // Pairs of slivers along a long edge, whose cotangent weight is negative: the harmonic map folds although its image
    // is convex.
    const Mesh mesh = ringed_disk(8);
    const Topology edges = topology(mesh);
    std::vector<EdgeLength> lengths;
    std::vector<char> used(mesh.face_count(), 0);
    for (int e = 0; e < edges.edge_count(); ++e) {
        const auto [left, right] = edges.edge_faces[e];
        const bool long_edge = left >= 0 && right >= 0 && !used[left] && !used[right] && e % 2 == 0;
        if (long_edge) used[left] = used[right] = 1;
        lengths.push_back({edges.edges[e][0], edges.edges[e][1], long_edge ? 1.99 : 1.0});
    }
    const Surface source(mesh, corners_from_lengths(mesh, lengths));
    const BoundaryCondition boundary = to_circle(source, 0.5);
    ASSERT_FALSE(distortion(source.operators, harmonic_map(source, boundary)).flipped.empty());
    const BaselineMap result = mips_baseline(source, boundary);
    EXPECT_TRUE(mentions(result, "Tutte")) << "started from something else";
    EXPECT_TRUE(result.converged);
    EXPECT_TRUE(distortion(source.operators, result.map).flipped.empty());
}

TEST(Mips, SaysWhenTheBoundaryCrossesItself) {
    const Surface source(ringed_disk(8));
    const BoundaryCondition boundary =
        prescribe(source, [](Complex z) { return std::polar(1.0, std::arg(z) + 1.5 * std::sin(std::arg(z))); });
    const BaselineMap result = mips_baseline(source, boundary);
    EXPECT_FALSE(result.converged);
    EXPECT_TRUE(mentions(result, "folds remain"));
}

// ---- against published results --------------------------------------------------------------------------------------

struct Statistics {
    double mean = 0, deviation = 0, largest = 0;
};

/// Of |μ| over faces, each counted once.
Statistics unweighted(const Surface& source, const Eigen::VectorXcd& f) {
    const Eigen::ArrayXd size = beltrami_coefficient(source.operators, f).cwiseAbs().array();
    const double mean = size.mean();
    return {mean, std::sqrt((size - mean).square().mean()), size.maxCoeff()};
}

TEST(Peers, MultiplyConnectedDomainWithPinnedBoundary) {
    const std::filesystem::path file = test::real_mesh("mcqc2d_planar_src.obj");
    if (file.empty()) GTEST_SKIP() << "set BELTRAMI_TEST_MESHES to the folder of mcqc2d_planar_src.obj";
    const Surface source(read_mesh(file).mesh);
    BoundaryCondition boundary;
    std::ifstream pins(test::real_mesh("mcqc2d_pins.txt"));
    int vertex;
    double x, y;
    while (pins >> vertex >> x >> y) boundary.pin(vertex, {x, y});
    ASSERT_GT(boundary.vertices.size(), 100u);

    // Other programs give .093, .111, .622 for the harmonic map and .107, .087, .465 for MIPS.
    const Statistics harmonic = unweighted(source, harmonic_baseline(source, boundary).map);
    EXPECT_NEAR(harmonic.mean, 0.093, 6e-4);
    EXPECT_NEAR(harmonic.deviation, 0.111, 6e-4);
    EXPECT_NEAR(harmonic.largest, 0.622, 6e-4);
    const BaselineMap mips = mips_baseline(source, boundary);
    EXPECT_TRUE(mips.converged);
    EXPECT_TRUE(distortion(source.operators, mips.map).flipped.empty());
    const Statistics conformal = unweighted(source, mips.map);
    EXPECT_NEAR(conformal.mean, 0.107, 6e-4);
    EXPECT_NEAR(conformal.deviation, 0.087, 6e-4);
    EXPECT_NEAR(conformal.largest, 0.465, 6e-4);

    // Known of the QC iteration after 300 steps: .210, .012, .256 and no flip, which takes an argument left as it is.
    BaselineOptions options;
    options.max_iterations = 300;
    options.smoothing = 0;
    const BaselineMap qc = qc_iteration_baseline(source, boundary, options);
    EXPECT_TRUE(distortion(source.operators, qc.map).flipped.empty());
    const Statistics even = unweighted(source, qc.map);
    EXPECT_NEAR(even.mean, 0.210, 6e-4);
    EXPECT_NEAR(even.deviation, 0.012, 6e-4);
    EXPECT_NEAR(even.largest, 0.256, 6e-4);
}

}  // namespace
}  // namespace beltrami
