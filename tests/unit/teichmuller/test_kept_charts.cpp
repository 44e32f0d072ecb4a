#include <gtest/gtest.h>

#include <beltrami/base/effort.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/shape.h>
#include <beltrami/flow/flow_start.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/extremal_between.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh bent(Mesh mesh) {
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (int v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), 0.4 * flat(v, 0) * flat(v, 0);
    return mesh;
}

Mesh bent_disk() {
    DomainOptions options;
    options.edge_length = 0.1;
    return bent(circle_domain({}, {}, options));
}

/// Charts made for a map whose boundary runs with conformal speed.
std::int64_t charts_made(const Surface& surface, const Shape* shape, ExtremalMap& map) {
    const std::int64_t before = effort(Work::domain_chart);
    BoundaryPlacement placement;
    placement.speed = BoundarySpeed::conformal;
    placement.shape = shape;
    ExtremalOptions options;
    if (shape) options.shapes = {shape};
    map = extremal_map(surface, boundary_to_disk(surface, 0.4, placement), options);
    return effort(Work::domain_chart) - before;
}

TEST(KeptCharts, ServeBoundaryValuesAndMap) {
    const Surface surface(bent_disk());
    const Shape shape(surface);
    ExtremalMap alone, kept;
    EXPECT_EQ(charts_made(surface, nullptr, alone), 2);
    EXPECT_EQ(charts_made(surface, &shape, kept), 1);
    EXPECT_EQ(charts_made(surface, &shape, kept), 0);
    EXPECT_NEAR(kept.k, alone.k, 1e-9);
    EXPECT_LT((kept.map - alone.map).cwiseAbs().maxCoeff(), 1e-6);
}

Mesh bent_ring() {
    DomainOptions options;
    options.edge_length = 0.15;
    return bent(circle_domain({}, std::vector<Circle>{{{0.1, 0}, 0.4}}, options));
}

TEST(KeptCharts, ServeStartsOfFlows) {
    const Surface source(bent_ring());
    const Shape shape(source);
    const TargetDomain target{TargetCurve::circle(0, 1), {TargetCurve::circle(0, 0.3)}};
    FlowStartOptions options;
    options.shapes = {&shape};
    const SlidingStart alone = flow_start(source, target);
    const std::int64_t before = effort(Work::circle_chart);
    const SlidingStart first = flow_start(source, target, {}, options),
                       second = flow_start(source, target, {}, options);
    EXPECT_EQ(effort(Work::circle_chart) - before, 1);
    EXPECT_EQ(first.map, alone.map);
    EXPECT_EQ(second.map, alone.map);
}

TEST(KeptCharts, ServePrescribedTargets) {
    const Surface source(bent_ring()), target(bent_ring());
    const Shape shape(target);
    const auto& loops = source.topology.boundary_loops;
    const std::vector<std::array<int, 2>> pairs{{loops[0][0], loops[0][0]}, {loops[1][0], loops[1][0]}};
    ExtremalOptions options;
    options.shapes = {&shape};
    const PrescribedTarget alone = prescribed_target(source, target, pairs);
    const std::int64_t before = effort(Work::circle_chart);
    for (int i = 0; i < 2; ++i) {
        const ExtremalMapBetween map = extremal_map_between(source, target, pairs, {}, options);
        EXPECT_EQ(map.target.boundary.images, alone.boundary.images);
        EXPECT_LT(map.plane.k, 1e-2) << "the identity";
    }
    EXPECT_EQ(effort(Work::circle_chart) - before, 1);
}

TEST(KeptCharts, AreThoseOfTheSurfaceAlone) {
    const Surface surface(bent_disk()), other(bent_disk());
    const Shape shape(other);
    ExtremalMap map;
    EXPECT_EQ(charts_made(surface, nullptr, map), 2);
    EXPECT_EQ(shape_of(surface, {&shape}), nullptr);
    EXPECT_EQ(shape_of(other, {&shape}), &shape);
}

}  // namespace
}  // namespace beltrami
