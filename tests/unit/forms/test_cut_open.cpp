#include <beltrami/forms/cut_open.h>

#include <gtest/gtest.h>

#include <beltrami/base/random.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/uniformize/fold_free_flattening.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

/// A disk with the surface's faces, each side of the cut at the place of the vertex that was.
void expect_disk_of(const CutOpen& cut, const Mesh& closed) {
    const Topology shape = topology(cut.disk);
    EXPECT_EQ(shape.components, 1);
    EXPECT_EQ(shape.genus, 0);
    ASSERT_EQ(shape.boundary_loops.size(), 1);
    EXPECT_EQ(shape.boundary_loops[0].size(), 2 * static_cast<std::size_t>(cut.seam_edges));
    ASSERT_EQ(cut.disk.face_count(), closed.face_count());
    ASSERT_EQ(cut.disk.faces.corner_count(), closed.faces.corner_count());
    for (int c = 0; c < closed.faces.corner_count(); ++c)
        EXPECT_EQ(cut.vertices[cut.disk.faces.vertices()[c]], closed.faces.vertices()[c]);
    for (int v = 0; v < cut.disk.vertex_count(); ++v)
        EXPECT_EQ(cut.disk.positions.row(v), closed.positions.row(cut.vertices[v]));
}

TEST(CutOpen, EveryGenusBecomesADisk) {
    for (const Mesh& closed : {octahedral_sphere(0), octahedral_sphere(3), torus(2, 0.7, 20, 12), double_torus(0.2)}) {
        const CutOpen cut = cut_open(Surface(closed));
        expect_disk_of(cut, closed);
        EXPECT_GE(cut.seam_edges, 2);
    }
}

TEST(CutOpen, ATetrahedronHasNoTwoVerticesApart) {
    Mesh mesh;
    mesh.positions = Positions(4, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    mesh.faces.add({0, 2, 1});
    mesh.faces.add({0, 1, 3});
    mesh.faces.add({1, 2, 3});
    mesh.faces.add({2, 0, 3});
    const CutOpen cut = cut_open(Surface(mesh));
    expect_disk_of(cut, mesh);
    EXPECT_EQ(cut.seam_edges, 2);
}

TEST(CutOpen, OnlyClosedSurfaces) {
    EXPECT_EQ(test::cause_of([] { cut_open(Surface(disk(3))); }), Cause::bad_mesh);
}

TEST(FoldFreeFlattening, OpensTheFoldsOfCutSpikySpheres) {
    // Between spikes conformal equivalence flips edges, and faces themselves come out flipped.
    int folded = 0;
    for (const int seed : {1, 2, 3, 4, 5, 6}) {
        Mesh mesh = octahedral_sphere(3);
        Random random(seed);
        for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions.row(v) *= random.uniform(0.1, 4);
        const Surface surface(cut_open(Surface(mesh)).disk);
        const FoldFreeFlattening found = fold_free_flattening(surface);
        EXPECT_TRUE(found.fold_free) << seed;
        EXPECT_EQ(found.unfolded, distortion(surface.operators, flatten(surface.mesh).positions).flipped);
        EXPECT_TRUE(distortion(surface.operators, found.flattening.positions).flipped.empty());
        folded += static_cast<int>(!found.unfolded.empty());
        if (!found.kept_boundary) continue;
        const std::vector<int>& loop = surface.topology.boundary_loops[0];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Complex here = found.flattening.positions[loop[i]],
                          next = found.flattening.positions[loop[(i + 1) % loop.size()]];
            EXPECT_NEAR(std::abs(next - here) / surface.boundary_edge_lengths[0][i], 1, 1e-6);
        }
    }
    EXPECT_GT(folded, 0);
}

}  // namespace
}  // namespace beltrami
