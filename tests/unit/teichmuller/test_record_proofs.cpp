#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <beltrami/generate/grids.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/record_proofs.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

double value_of(const ExtremalMap& result, Bound::Kind kind) {
    for (const Bound& bound : result.bounds)
        if (bound.kind == kind) return bound.K;
    return 0;
}

void expect_ordered(const ExtremalMap& result) {
    EXPECT_LE(1, result.K_lower_proved);
    EXPECT_LE(result.K_lower_proved, result.K_lower);
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.K, result.K_max);
    EXPECT_NEAR(result.k, (result.K - 1) / (result.K + 1), 1e-12);
    EXPECT_EQ(result.K_lower_proved, largest_proof(result.bounds));
}

TEST(Proofs, KIsNeverBelowWhatIsProved) {
    // Two triangles folded in space to a square (cases/two.obj).
    Mesh mesh;
    mesh.positions = Positions(4, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    const Surface surface(mesh);
    BoundaryCondition boundary;
    const Complex corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int v = 0; v < 4; ++v) boundary.pin(v, corners[v]);
    const ExtremalMap result = extremal_map(surface, boundary);
    expect_ordered(result);
    EXPECT_NEAR(value_of(result, Bound::Kind::edge_corner), 1.1470, 1e-4);
    EXPECT_GE(result.K, 1.1470);
    EXPECT_EQ(result.termination, Termination::below_bound);
    EXPECT_TRUE(std::any_of(result.warnings.begin(), result.warnings.end(),
                            [](const Warning& warning) { return warning.kind == WarningKind::below_bound; }));
    // What is proved later takes the place of what was, in the warning too.
    const auto sentences_of = [](const ExtremalMap& map) {
        std::vector<std::string> sentences;
        for (const Warning& warning : map.warnings)
            if (warning.kind == WarningKind::below_bound) sentences.push_back(warning.sentence);
        return sentences;
    };
    ExtremalMap later = result;
    later.bounds.push_back({Bound::Kind::pair, 1.15, Bound::Of::extremal, true});
    raise_to_proofs(later);
    EXPECT_EQ(later.K, 1.15);
    ASSERT_EQ(sentences_of(later).size(), 1u);
    const auto found = [](const std::string& sentence) { return sentence.substr(0, sentence.find(',')); };
    EXPECT_EQ(found(sentences_of(later)[0]), found(sentences_of(result)[0]));
    EXPECT_NE(sentences_of(later)[0].find("1.150000"), std::string::npos);
    // Without the costly bounds the corner's is still there.
    ExtremalOptions options;
    options.prove = false;
    const ExtremalMap cheap = extremal_map(surface, boundary, options);
    EXPECT_EQ(value_of(cheap, Bound::Kind::pair), 0);
    EXPECT_NEAR(cheap.K_lower_proved, 1.1470, 1e-4);
}

TEST(Proofs, ATriangleIsAffine) {
    Mesh mesh;
    mesh.positions = Positions(3, 2);
    mesh.positions << 0, 0, 1, 0, 0, 1;
    mesh.faces.add({0, 1, 2});
    const Surface surface(mesh);
    BoundaryCondition boundary;
    for (int v = 0; v < 3; ++v) boundary.pin(v, std::polar(1.0, 2.1 * v));
    const ExtremalMap result = extremal_map(surface, boundary);
    expect_ordered(result);
    EXPECT_NEAR(result.K_lower_proved, result.K_max, 1e-9);
    // φ shows less, but the map is proved to be extremal.
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.warnings.empty());
}

TEST(Proofs, AQuadAttainsWhatItsCornersDo) {
    Mesh mesh;
    mesh.positions = Positions(4, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1;
    mesh.faces.add({0, 1, 2, 3});
    const Surface surface(mesh);
    BoundaryCondition boundary;
    const Complex corners[] = {{0, 0}, {1, 0}, {1, 0.001}, {0, 1}};
    for (int v = 0; v < 4; ++v) boundary.pin(v, corners[v]);
    const ExtremalMap result = extremal_map(surface, boundary);
    expect_ordered(result);
    EXPECT_GT(result.K_lower_proved, 20);
    EXPECT_GT(result.K_max, 990);  // at its Gauss points: 7.7
    EXPECT_EQ(result.termination, Termination::below_bound);
}

TEST(Proofs, SmoothProblemsKeepTheirEstimates) {
    const Surface surface(disk(12));
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, test::exact_composition));
    expect_ordered(result);
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_GT(value_of(result, Bound::Kind::pair), 2.97);
    EXPECT_LT(value_of(result, Bound::Kind::pair), 3.01);
    EXPECT_GE(result.K_lower_proved, value_of(result, Bound::Kind::reich_strebel));
}

TEST(Proofs, PairsOnRefinedMeshesProveMore) {
    const Surface surface(disk(8));
    const BoundaryCondition boundary = test::boundary_values(surface, test::exact_composition);
    const ExtremalMap result = extremal_map(surface, boundary);
    ExtremalMap finer = result;
    finer.K_lower = 1;  // as if φ showed nothing
    add_finer_pair(surface, boundary, finer.K_lower, finer);
    raise_to_proofs(finer);
    expect_ordered(finer);
    EXPECT_GT(value_of(finer, Bound::Kind::pair), value_of(result, Bound::Kind::pair) + 0.001);
    EXPECT_LT(value_of(finer, Bound::Kind::pair), 3.0292);  // verified from above for these polygons
    EXPECT_EQ(std::count_if(finer.bounds.begin(), finer.bounds.end(),
                            [](const Bound& bound) { return bound.kind == Bound::Kind::pair; }),
              1);
}

TEST(Proofs, APinnedPointOfASquare) {
    // The plane is a chart, so Reich-Strebel with a pole at the pin is a proof; the branched pair is another.
    const Surface surface(test::jittered_square(16));
    BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
    const int centre = 8 * 17 + 8;
    boundary.pin(centre,
                 Complex(surface.mesh.positions(centre, 0), surface.mesh.positions(centre, 1)) + Complex(0.12, 0.08));
    const ExtremalMap result = extremal_map(surface, boundary);
    expect_ordered(result);
    EXPECT_GT(value_of(result, Bound::Kind::pair), 1.15);
    EXPECT_GT(result.K_lower_proved, 1.3);
    EXPECT_LT(result.K_lower_proved, 1.37);
}

}  // namespace
}  // namespace beltrami
