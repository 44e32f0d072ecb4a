// Classes of maps that nothing tells.
#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/generate/double_torus.h>
#include <beltrami/hyperbolic/cut_marking.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/snap.h>
#include <beltrami/meshing/edge_collapse.h>
#include <beltrami/registration/register_handles.h>

#include "problems/level_surface.h"
#include "problems/slit_torus.h"
#include "support/cause_of.h"

namespace beltrami {
namespace {

Mesh stretched(Mesh mesh) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        mesh.positions(v, 1) *= 1.3 + 0.1 * mesh.positions(v, 0);
        mesh.positions(v, 2) += 0.1 * mesh.positions(v, 0);
    }
    return mesh;
}

struct Pair {
    Surface source{double_torus(0.2)}, target{stretched(double_torus(0.17))};
    HyperbolicShape from{source}, to{target};
};

TEST(CollapseEdges, KeepsTheTopologyAndIsSimplicial) {
    const Mesh fine = double_torus(0.1);
    const CollapsedMesh coarse = collapse_edges(fine, 500);
    EXPECT_LE(coarse.mesh.vertex_count(), 500);
    const Topology here = topology(fine), there = topology(coarse.mesh);
    EXPECT_EQ(there.genus, 2);
    EXPECT_EQ(there.components, 1);
    EXPECT_TRUE(there.boundary_loops.empty());
    for (const auto& [a, b] : here.edges) {
        const int c = coarse.images[static_cast<std::size_t>(a)], d = coarse.images[static_cast<std::size_t>(b)];
        EXPECT_TRUE(c == d || edge_between(there, c, d) >= 0);
    }
}

TEST(CutMarking, IsAClassAndSnappingMakesItExact) {
    const Pair pair;
    const std::vector<double> here = edge_lengths(pair.source.topology, pair.from.metric()),
                              there = edge_lengths(pair.target.topology, pair.to.metric());
    int sound = 0;
    for (const int root : {0, 100, 200}) {
        Marking marking =
            marking_by_cutting(pair.source, pair.from.metric().original, here, root, pair.to.group(), there, root + 7);
        const Eigen::MatrixXi homology =
            periods_of_images(pair.source.topology, marking.map, pair.from.forms().homology.loops);
        EXPECT_EQ(homology * pair.to.forms().homology.intersections * homology.transpose(),
                  pair.from.forms().homology.intersections);
        if (!(marking.defect < 1e-4)) continue;
        ++sound;
        EquivariantMapStep step(pair.source, marking.map);
        step.relax(1e-3);
        EquivariantMap map = step.map();
        EXPECT_LT(snap_to_target(pair.source, pair.to.metric(), map), 1e-3);
        EXPECT_LT(flatness(pair.source, map).maxCoeff(), 1e-11);
        // Nothing is left to do.
        EXPECT_LT(snap_to_target(pair.source, pair.to.metric(), map), 1e-10);
    }
    EXPECT_GT(sound, 0);
}

TEST(ClassSearch, FindsTheClassOfADeformation) {
    const Pair pair;
    HandleMarking near, sought;
    near.start = stretched(pair.source.mesh).positions;
    sought.search.emplace();
    sought.search->starts = 4;
    sought.search->vertices = 400;
    const HandleRegistration natural = register_handles(pair.from, pair.to, near),
                             found = register_handles(pair.from, pair.to, sought);
    ASSERT_TRUE(found.search);
    EXPECT_EQ(found.search->reached.size() + static_cast<std::size_t>(found.search->failed), 4u);
    for (std::size_t i = 1; i < found.search->reached.size(); ++i)
        EXPECT_LE(found.search->reached[i - 1].energy, found.search->reached[i].energy);
    // The double torus has symmetries, and so classes that are alike: k is the same.
    EXPECT_NEAR(found.map.k, natural.map.k, 3e-3);
    EXPECT_NEAR(found.map.energy, natural.map.energy, 1e-3 * natural.map.energy);
    EXPECT_TRUE(found.map.one_to_one());
    RecordProperty("k", std::to_string(found.map.k) + " " + std::to_string(natural.map.k));
    // The same again.
    const ClassSearch again = search_class(pair.from, pair.to, *sought.search);
    EXPECT_EQ(again.reached[0].energy, found.search->reached[0].energy);
}

TEST(ClassSearch, FindsTheClassInGenusThree) {
    const auto stretch = [](double x) { return 1.3 + 0.2 * (x - 1.1); };
    const Surface source(bench::three_rings(
        false, 0.16, [](double) { return 1.0; }, false)),
        target(bench::three_rings(false, 0.15, stretch, true));
    const HyperbolicShape from(source), to(target);
    HandleMarking near, sought;
    near.start = source.mesh.positions;
    for (int v = 0; v < source.mesh.vertex_count(); ++v) (*near.start)(v, 1) *= stretch(source.mesh.positions(v, 0));
    sought.search.emplace();
    sought.search->vertices = 700;
    const HandleRegistration natural = register_handles(from, to, near), found = register_handles(from, to, sought);
    // Rings in a triangle change places without changing much: what is found is no worse.
    EXPECT_LT(found.map.energy, natural.map.energy * (1 + 1e-3));
    EXPECT_LT(found.map.k, natural.map.k + 3e-3);
    EXPECT_TRUE(found.map.one_to_one());
    RecordProperty("k", std::to_string(found.map.k) + " " + std::to_string(natural.map.k));
}

TEST(ClassSearch, RefusesWhatItCannotSeek) {
    const bench::SlitTorus torus = bench::slit_torus(16, 1, 1);
    const HyperbolicShape open(torus.surface);
    EXPECT_EQ(test::cause_of([&] { search_class(open, open); }), Cause::bad_mesh);
    const Pair pair;
    EXPECT_EQ(test::cause_of([&] {
                  HandleMarking both;
                  both.search = ClassSearchOptions{};
                  both.start = pair.source.mesh.positions;
                  register_handles(pair.from, pair.to, both);
              }),
              Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
