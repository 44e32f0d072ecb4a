#include <gtest/gtest.h>

#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/boundary_position.h>

namespace beltrami {
namespace {

TEST(BoundaryPosition, IsThatOfTheLoops) {
    const Mesh mesh = annulus(0.5, 1, 20);
    const Topology of = topology(mesh);
    int found = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const auto at = boundary_position(of, v);
        EXPECT_EQ(at.has_value(), of.on_boundary[v] != 0);
        if (!at) continue;
        EXPECT_EQ(of.boundary_loops[at->loop][at->position], v);
        ++found;
    }
    EXPECT_EQ(found, 40);
    EXPECT_FALSE(boundary_position(of, -1));
    EXPECT_FALSE(boundary_position(of, mesh.vertex_count()));
}

}  // namespace
}  // namespace beltrami
