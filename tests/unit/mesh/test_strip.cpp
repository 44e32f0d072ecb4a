#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/strip.h>
#include <beltrami/meshing/planar_domains.h>

namespace beltrami {
namespace {

/// How much the function of some jumps grows along a boundary loop, by the faces beside it.
double growth(const Mesh& mesh, const Topology& topology, const std::vector<double>& jumps, int loop) {
    std::vector<char> on_loop(mesh.vertex_count(), 0);
    for (const int v : topology.boundary_loops[loop]) on_loop[v] = 1;
    double sum = 0;
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int c = mesh.faces.first_corner(f), end = c + mesh.faces.degree(f), first = c; c < end; ++c) {
            const auto& sides = topology.edge_faces[topology.corner_edges[c]];
            if ((sides[0] < 0 || sides[1] < 0) && on_loop[mesh.faces.vertices()[c]])
                sum += jumps[c + 1 < end ? c + 1 : first] - jumps[c];
        }
    return sum;
}

TEST(Strip, GrowsByOneAroundItsLoopsOnly) {
    DomainOptions options;
    options.edge_length = 0.1;
    const Mesh mesh = circle_domain({}, {{{0.4, 0}, 0.2}, {{-0.4, 0.1}, 0.25}}, options);
    const Topology shape = topology(mesh);
    ASSERT_EQ(shape.boundary_loops.size(), 3U);
    const std::vector<double> jumps = jumps_across_strip(mesh, shape, 1, 0);
    EXPECT_EQ(std::abs(growth(mesh, shape, jumps, 1)), 1);
    EXPECT_EQ(growth(mesh, shape, jumps, 0), -growth(mesh, shape, jumps, 1));
    EXPECT_EQ(growth(mesh, shape, jumps, 2), 0);
}

TEST(Strip, IsClosedAcrossEdges) {
    const Mesh mesh = annulus(0.3, 1, 16);
    const Topology shape = topology(mesh);
    const std::vector<double> jumps = jumps_across_strip(mesh, shape, 0, 1);
    // The step along an edge is the same in both of its faces.
    std::vector<double> step(shape.edge_count(), 0);
    std::vector<char> seen(shape.edge_count(), 0);
    int crossed = 0;
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int i = 0; i < 3; ++i) {
            const int c = 3 * f + i, d = 3 * f + (i + 1) % 3, e = shape.corner_edges[c];
            const double sense = mesh.faces.vertices()[c] < mesh.faces.vertices()[d] ? 1 : -1;
            const double here = sense * (jumps[d] - jumps[c]);
            if (seen[e]) {
                EXPECT_EQ(here, step[e]);
            }
            step[e] = here;
            crossed += !seen[e] && here != 0;
            seen[e] = 1;
        }
    EXPECT_GT(crossed, 1);
}

}  // namespace
}  // namespace beltrami
