#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/charts/shape.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh plate_with_a_hole() {
    DomainOptions options;
    options.edge_length = 0.15;
    Mesh flat = circle_domain({}, std::vector<Circle>{{{0.2, 0.1}, 0.3}}, options);
    Mesh mesh = flat;
    mesh.positions.resize(flat.vertex_count(), 3);
    for (int v = 0; v < flat.vertex_count(); ++v) {
        const double x = flat.positions(v, 0), y = flat.positions(v, 1);
        mesh.positions.row(v) << x, y, 0.3 * x * x - 0.2 * y;
    }
    return mesh;
}

TEST(Shape, KeepsChartsOfEveryOuterLoop) {
    const Surface surface(plate_with_a_hole());
    const Shape shape(surface);
    const CircleDomainChart& circles = shape.circles();
    EXPECT_EQ(&shape.circles(0), &circles);
    const CircleDomainChart& other = shape.circles(1);
    EXPECT_NE(&other, &circles);
    EXPECT_EQ(&shape.circles(0), &circles);
    EXPECT_EQ(other.outer_loop(), 1);
    EXPECT_EQ(&shape.chart(), &shape.chart(0));
    // They are what is computed without it.
    EXPECT_EQ(circles.chart.vertices, circle_domain_chart(surface).chart.vertices);
    EXPECT_EQ(shape.chart(1).vertices, domain_chart(surface, 1).vertices);
    EXPECT_THROW(shape.circles(2), Error);
    EXPECT_THROW(shape.chart(-1), Error);
}

TEST(Shape, SplitsBridgesOnce) {
    // The corners of the square have ears.
    const Surface square(test::jittered_square(6)), plate(plate_with_a_hole());
    const Shape eared(square), sound(plate);
    const Shape& split = eared.without_bridges();
    ASSERT_TRUE(eared.bridges());
    EXPECT_GT(eared.bridges()->split_edges, 0);
    EXPECT_GT(split.surface().mesh.vertex_count(), square.mesh.vertex_count());
    EXPECT_EQ(&eared.without_bridges(), &split);
    EXPECT_EQ(&split.without_bridges(), &split);
    EXPECT_EQ(&sound.without_bridges(), &sound);
    EXPECT_FALSE(sound.bridges());
}

TEST(Shape, MayBeAskedFromSeveralThreads) {
    const Surface surface(plate_with_a_hole());
    const Shape shape(surface);
    std::vector<const CircleDomainChart*> found(8);
    parallel_for_each(8, [&](int i) { found[i] = &shape.circles(i % 2); });
    for (int i = 0; i < 8; ++i) EXPECT_EQ(found[i], &shape.circles(i % 2));
}

}  // namespace
}  // namespace beltrami
