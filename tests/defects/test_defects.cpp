#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>

// One tiny mesh per defect: diagnose() must find it, at the right place, and nothing else.

namespace beltrami {
namespace {

Mesh planar(std::initializer_list<std::array<double, 2>> points, std::initializer_list<std::vector<int>> faces) {
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 2);
    Eigen::Index row = 0;
    for (const auto& [x, y] : points) mesh.positions.row(row++) << x, y;
    for (const std::vector<int>& face : faces) mesh.faces.add(face);
    return mesh;
}

Mesh spatial(std::initializer_list<std::array<double, 3>> points, std::initializer_list<std::vector<int>> faces) {
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
    Eigen::Index row = 0;
    for (const auto& [x, y, z] : points) mesh.positions.row(row++) << x, y, z;
    for (const std::vector<int>& face : faces) mesh.faces.add(face);
    return mesh;
}

void expect_only(const Mesh& mesh, Defect defect, bool fatal, const std::vector<int>& indices) {
    const std::vector<Finding> findings = diagnose(mesh);
    ASSERT_EQ(findings.size(), 1u) << (findings.empty() ? "nothing found" : findings[1].sentence);
    EXPECT_EQ(findings[0].defect, defect) << findings[0].sentence;
    EXPECT_EQ(findings[0].fatal, fatal);
    EXPECT_EQ(findings[0].indices, indices) << findings[0].sentence;
    EXPECT_FALSE(findings[0].sentence.empty());
    EXPECT_FALSE(findings[0].next_step.empty());
    EXPECT_NE(findings[0].sentence.back(), '.');
    for (const int index : indices) {
        EXPECT_NE(findings[0].sentence.find(std::to_string(index)), std::string::npos) << findings[0].sentence;
    }
    if (fatal) {
        try {
            require_sound(mesh);
            FAIL() << "accepted: " << findings[0].sentence;
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_mesh);
            EXPECT_EQ(error.indices(), indices);
            EXPECT_EQ(error.what(), findings[0].sentence + ": " + findings[0].next_step);
        }
    } else {
        EXPECT_EQ(require_sound(mesh).size(), 1u);
    }
}

Mesh moebius(int n) {
    Mesh mesh;
    mesh.positions.resize(2 * n, 3);
    for (int i = 0; i < n; ++i) {
        const double u = 2.0 * std::acos(-1.0) * i / n;
        for (const int side : {0, 1}) {
            const double r = 1.0 + (side - 0.5) * 0.6 * std::cos(u / 2);
            mesh.positions.row(2 * i + side) << r * std::cos(u), r * std::sin(u), (side - 0.5) * 0.6 * std::sin(u / 2);
        }
        const bool last = i == n - 1;
        const int next = 2 * ((i + 1) % n);
        mesh.faces.add({2 * i, next + (last ? 1 : 0), next + (last ? 0 : 1), 2 * i + 1});
    }
    return mesh;
}

TEST(Defects, SoundMeshesHaveNone) {
    for (const Mesh& mesh : {disk(4), annulus(0.3, 1, 9), rectangle(1, 1, 3, 3, Cells::quads), torus(2, 1, 8, 6),
                             icosahedral_sphere(2), cylinder(1, 1, 5, 2, Cells::quads)}) {
        EXPECT_TRUE(diagnose(mesh).empty());
        EXPECT_TRUE(require_sound(mesh).empty());
    }
}

TEST(Defects, Empty) {
    expect_only(Mesh{}, Defect::empty, true, {});
    expect_only(planar({{0, 0}}, {}), Defect::empty, true, {});
    Mesh line;
    line.positions = Positions::Zero(3, 1);
    line.faces.add({0, 1, 2});
    expect_only(line, Defect::empty, true, {});
}

TEST(Defects, NotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    expect_only(planar({{0, 0}, {1, nan}, {1, 1}, {-infinity, 1}}, {{0, 1, 2}, {0, 2, 3}}), Defect::not_finite, true,
                {1, 3});
}

TEST(Defects, IndexOutOfRange) {
    expect_only(planar({{0, 0}, {1, 0}, {1, 1}}, {{0, 1, 2}, {0, 2, 3}}), Defect::index_out_of_range, true, {1});
    const int most = std::numeric_limits<int>::max();
    expect_only(planar({{0, 0}, {1, 0}, {1, 1}}, {{0, 1, -1}, {0, 1, 2}, {most, -most, 0}}), Defect::index_out_of_range,
                true, {0, 2});
}

TEST(Defects, WrongNumberOfCorners) {
    expect_only(planar({{1, 0}, {0.3, 1}, {-0.8, 0.6}, {-0.8, -0.6}, {0.3, -1}}, {{0, 1, 2, 3, 4}}),
                Defect::too_many_corners, true, {0});
    expect_only(planar({{0, 0}, {1, 0}, {1, 1}}, {{0, 1, 2}, {0, 1}}), Defect::too_many_corners, true, {1});
}

TEST(Defects, UnreferencedVertex) {
    expect_only(planar({{0, 0}, {5, 5}, {1, 0}, {1, 1}, {7, 7}}, {{0, 2, 3}}), Defect::unreferenced_vertex, false,
                {1, 4});
}

TEST(Defects, SeveralComponents) {
    expect_only(planar({{0, 0}, {1, 0}, {0, 1}, {5, 0}, {6, 0}, {5, 1}}, {{0, 1, 2}, {3, 4, 5}}),
                Defect::several_components, false, {0, 3});
}

TEST(Defects, NonManifoldEdge) {
    expect_only(spatial({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),
                Defect::non_manifold_edge, true, {0, 1});
}

TEST(Defects, NonManifoldVertex) {
    expect_only(planar({{0, 0}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}, {{0, 1, 2}, {0, 3, 4}}),
                Defect::non_manifold_vertex, true, {0});
    // Two tetrahedra that share a tip: both fans are closed.
    expect_only(spatial({{0, 0, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {-1, 1, -1}, {-1, -1, -1}},
                        {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}}),
                Defect::non_manifold_vertex, true, {0});
}

TEST(Defects, InconsistentOrientationNamesTheMinority) {
    expect_only(
        spatial({{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0}, {-1, 0.5, 0.2}}, {{0, 1, 2}, {0, 3, 2}, {0, 3, 4}}),
        Defect::inconsistent_orientation, true, {1});
    // Every component is judged by its own majority.
    Mesh mesh = icosahedral_sphere(1);
    Mesh wrong = mesh;
    wrong.faces = {};
    for (int f = 0; f < mesh.face_count(); ++f) {
        const std::span<const int> v = mesh.faces[f];
        if (f == 5 || f == 6 || f == 70) {
            wrong.faces.add({v[0], v[2], v[1]});
        } else {
            wrong.faces.add(v);
        }
    }
    expect_only(wrong, Defect::inconsistent_orientation, true, {5, 6, 70});
}

TEST(Defects, Moebius) {
    const std::vector<Finding> findings = diagnose(moebius(12));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].defect, Defect::not_orientable);
    EXPECT_TRUE(findings[0].fatal);
    // Removing the edges it names removes the contradiction: here one, across the band.
    ASSERT_EQ(findings[0].indices.size(), 2u);
    EXPECT_EQ(findings[0].indices[1], findings[0].indices[0] + 1);
    EXPECT_THROW(topology(moebius(12)), Error);
}

TEST(Defects, DuplicateFace) {
    // The same triangle from both sides is edge-manifold; only the comparison of corners finds it.
    expect_only(spatial({{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, {{0, 1, 2}, {2, 1, 0}}), Defect::duplicate_face, true, {1});
}

TEST(Defects, DegenerateFace) {
    expect_only(planar({{0, 0}, {1, 0}, {1, 1}}, {{0, 1, 2}, {1, 2, 2}}), Defect::degenerate_face, true, {1});
    expect_only(planar({{0, 0}, {1, 0}, {1, 1}}, {{0, 1, 2, 1}}), Defect::degenerate_face, true, {0});
}

TEST(Defects, ZeroAreaFace) {
    for (const double scale : {1e-150, 1e-9, 1.0, 1e9, 1e150}) {
        SCOPED_TRACE(scale);
        expect_only(spatial({{0, 0, 0}, {scale, 0, 0}, {2 * scale, 0, 0}, {scale, scale, scale}},
                            {{0, 1, 3}, {1, 2, 3}, {0, 2, 1}}),
                    Defect::zero_area_face, true, {2});
    }
    expect_only(planar({{3, 3}, {3, 3}, {3, 3}}, {{0, 1, 2}}), Defect::zero_area_face, true, {0});
    expect_only(planar({{0, 0}, {0, 0}, {0, 0}}, {{0, 1, 2}}), Defect::zero_area_face, true, {0});
}

TEST(Defects, SliverFace) {
    for (const double scale : {1e-150, 1e-9, 1.0, 1e9, 1e150}) {
        SCOPED_TRACE(scale);
        expect_only(planar({{0, 0}, {scale, 0}, {scale, 0.008 * scale}}, {{0, 1, 2}}), Defect::sliver_face, false, {0});
        EXPECT_TRUE(diagnose(planar({{0, 0}, {scale, 0}, {scale, 0.009 * scale}}, {{0, 1, 2}})).empty());
    }
}

TEST(Defects, VeryThinIsASliverNotWithoutArea) {
    expect_only(planar({{0, 0}, {1, 0}, {1, 1e-12}}, {{0, 1, 2}}), Defect::sliver_face, false, {0});
    expect_only(planar({{0, 0}, {1, 0}, {1, 1e-14}}, {{0, 1, 2}}), Defect::zero_area_face, true, {0});
}

TEST(Defects, FoldedPlanarFace) {
    // Coherently oriented, but the second face lies over the first.
    expect_only(planar({{0, 0}, {1, 0}, {0, 1}, {0.2, 0.1}, {1, 1}}, {{0, 1, 2}, {2, 1, 4}, {0, 3, 1}}),
                Defect::folded_planar_face, true, {2});
    // The same folding in space is a crease, not a defect.
    Mesh crease = spatial({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.1, 0.5}}, {{0, 1, 2}, {0, 3, 1}});
    EXPECT_TRUE(diagnose(crease).empty());
}

TEST(Defects, ReflexQuad) {
    for (const double scale : {1e-150, 1.0, 1e150}) {
        expect_only(planar({{0, 0}, {2 * scale, 0}, {0.4 * scale, 0.4 * scale}, {0, 2 * scale}}, {{0, 1, 2, 3}}),
                    Defect::reflex_quad, false, {0});
        EXPECT_TRUE(diagnose(planar({{0, 0}, {2 * scale, 0}, {scale, scale}, {0, 2 * scale}}, {{0, 1, 2, 3}})).empty())
            << "a straight corner";
    }
    EXPECT_FALSE(spoils_topology(Defect::reflex_quad));
}

TEST(Defects, FatalOnesComeFirstAndSentencesStayShort) {
    Mesh mesh = rectangle(1, 1, 30, 30);
    mesh.positions.conservativeResize(1000, 2);
    mesh.positions.bottomRows(39).setZero();
    mesh.faces.add(mesh.faces[7]);
    const std::vector<Finding> findings = diagnose(mesh);
    ASSERT_GE(findings.size(), 2u);
    EXPECT_TRUE(findings.front().fatal);
    EXPECT_EQ(findings.back().defect, Defect::unreferenced_vertex);
    EXPECT_EQ(findings.back().indices.size(), 39u);
    EXPECT_NE(findings.back().sentence.find(" and 29 more"), std::string::npos) << findings.back().sentence;
    try {
        require_sound(mesh);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("further"), std::string::npos);
    }
}

TEST(Defects, NoInputMakesDiagnoseFail) {
    Random random(2024);
    for (int trial = 0; trial < 2000; ++trial) {
        Mesh mesh;
        const int vertices = static_cast<int>(random.next() % 7);
        mesh.positions.resize(vertices, 2 + static_cast<int>(random.next() % 2));
        for (int i = 0; i < mesh.positions.size(); ++i) {
            const std::uint64_t kind = random.next() % 40;
            mesh.positions.data()[i] = kind == 0   ? std::numeric_limits<double>::quiet_NaN()
                                       : kind == 1 ? std::numeric_limits<double>::max()
                                       : kind == 2 ? std::numeric_limits<double>::denorm_min()
                                                   : std::floor(random.uniform(0, 4));
        }
        const int faces = static_cast<int>(random.next() % 8);
        for (int f = 0; f < faces; ++f) {
            std::vector<int> corners(random.next() % 20 == 0 ? random.next() % 7 : 3 + random.next() % 2);
            for (int& v : corners)
                v = static_cast<int>(random.next() % (vertices + (random.next() % 20 == 0 ? 2 : 0) + 1)) -
                    (trial % 30 == 0);
            mesh.faces.add(corners);
        }
        const std::vector<Finding> findings = diagnose(mesh);
        // topology() accepts what has no combinatorial defect, and nothing else.
        const bool combinatorial = std::any_of(findings.begin(), findings.end(), [](const Finding& f) {
            return f.defect == Defect::index_out_of_range || f.defect == Defect::too_many_corners ||
                   f.defect == Defect::degenerate_face || f.defect == Defect::non_manifold_edge ||
                   f.defect == Defect::non_manifold_vertex || f.defect == Defect::inconsistent_orientation ||
                   f.defect == Defect::not_orientable;
        });
        bool refused = false;
        try {
            topology(mesh);
        } catch (const Error&) {
            refused = true;
        }
        EXPECT_EQ(refused, combinatorial) << "trial " << trial;
    }
}

class RealDefects : public testing::Test {
  protected:
    Mesh load(const char* name) {
        const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
        return read_mesh(std::filesystem::path(folder) / "defects" / name).mesh;
    }
    void SetUp() override {
        const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
        if (!folder || !std::filesystem::is_directory(std::filesystem::path(folder) / "defects")) {
            GTEST_SKIP() << "BELTRAMI_TEST_MESHES names no folder with real defective meshes";
        }
    }
    static std::vector<Defect> kinds(const Mesh& mesh) {
        std::vector<Defect> result;
        for (const Finding& finding : diagnose(mesh)) result.push_back(finding.defect);
        return result;
    }
};

TEST_F(RealDefects, Moebius) {
    EXPECT_EQ(kinds(load("moebius.obj")), (std::vector{Defect::not_orientable}));
}

TEST_F(RealDefects, TripleVierbein) {
    const Mesh mesh = load("triple_vierbein.obj");
    const std::vector<Finding> findings = diagnose(mesh);
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].defect, Defect::non_manifold_edge);
    EXPECT_EQ(findings[0].indices.size(), 40u);  // 20 edges
    EXPECT_THROW(topology(mesh), Error);
}

TEST_F(RealDefects, InvertedTrianglesAreNamedSoThatTurningThemMendsTheMesh) {
    const Mesh mesh = load("inverted_triangles.obj");
    const std::vector<Finding> findings = diagnose(mesh);
    ASSERT_EQ(findings.size(), 1u);
    ASSERT_EQ(findings[0].defect, Defect::inconsistent_orientation);
    Mesh mended = mesh;
    mended.faces = {};
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::vector<int> corners(mesh.faces[f].begin(), mesh.faces[f].end());
        if (std::binary_search(findings[0].indices.begin(), findings[0].indices.end(), f)) {
            std::reverse(corners.begin(), corners.end());
        }
        mended.faces.add(corners);
    }
    EXPECT_TRUE(diagnose(mended).empty());
    EXPECT_EQ(topology(mended).boundary_loops.size(), 6u);
}

}  // namespace
}  // namespace beltrami
