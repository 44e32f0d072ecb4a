#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/teichmuller/certify.h>
#include <beltrami/teichmuller/least_dilatation.h>

namespace beltrami {
namespace {

/// Boundary vertices of a planar mesh with y above @p least, moved along x.
BoundaryCondition sheared(const Surface& surface, double least) {
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) {
        const double x = surface.mesh.positions(v, 0), y = surface.mesh.positions(v, 1);
        if (y >= least) boundary.pin(v, {x + 0.4 * y * y, y});
    }
    return boundary;
}

bool speaks_of_free_parts(const Warning& warning) {
    return warning.kind == WarningKind::free_boundary;
}

TEST(LeastDilatation, IsTheExtremalMapOfAWholeBoundary) {
    const Surface surface(disk(8));
    const Constraints whole(sheared(surface, -2));
    EXPECT_TRUE(free_parts(surface, whole.prescribed).empty());
    const LeastDilatationMap found = least_dilatation_map(surface, whole);
    ASSERT_TRUE(found.extremal);
    EXPECT_FALSE(found.maximum);
    EXPECT_EQ(found.extremal->map, extremal_map(surface, whole).map);
}

TEST(LeastDilatation, OfFreePartsIsThatOfLeastMaximum) {
    const Surface surface(disk(8));
    const Constraints half(sheared(surface, -0.1));
    const std::vector<int> free = free_parts(surface, half.prescribed);
    EXPECT_EQ(free, unprescribed_boundary(half.prescribed, surface));
    ASSERT_FALSE(free.empty());
    const LeastDilatationMap found = least_dilatation_map(surface, half);
    ASSERT_TRUE(found.maximum);
    EXPECT_FALSE(found.extremal);
    EXPECT_EQ(found.maximum->map, least_maximum_map(surface, half).map);
    ASSERT_FALSE(found.maximum->warnings.empty());
    EXPECT_TRUE(speaks_of_free_parts(found.maximum->warnings[0]));
    EXPECT_EQ(found.maximum->warnings[0].where, (Where{Things::vertices, free}));

    LeastDilatationOptions asked;
    asked.what = Least::maximum;
    const LeastDilatationMap same = least_dilatation_map(surface, half, asked);
    EXPECT_EQ(same.maximum->map, found.maximum->map);
    EXPECT_EQ(std::count_if(same.maximum->warnings.begin(), same.maximum->warnings.end(), speaks_of_free_parts), 0);
}

TEST(LeastDilatation, HasNoStartAndNoProofWithFreeParts) {
    const Surface surface(disk(8));
    const Constraints half(sheared(surface, -0.1));
    LeastDilatationOptions options;
    options.maximum.extremal.start = Eigen::VectorXcd::Zero(surface.mesh.vertex_count());
    EXPECT_THROW(least_dilatation_map(surface, half, options), Error);
    try {
        certify(surface, half, 0.01);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_boundary);
        EXPECT_NE(std::string(error.what()).find("nothing to certify"), std::string::npos);
        EXPECT_EQ(error.where().of, Things::vertices);
    }
}

TEST(LeastDilatation, OfALoopThatWasForgottenIsAnError) {
    const Surface ring(annulus(0.5, 1, 32));
    BoundaryCondition outer;
    for (const int v : ring.topology.boundary_loops[0])
        outer.pin(v, {ring.mesh.positions(v, 0), ring.mesh.positions(v, 1)});
    EXPECT_TRUE(free_parts(ring, outer).empty());
    EXPECT_THROW(least_dilatation_map(ring, outer), Error);
    LeastDilatationOptions asked;
    asked.what = Least::maximum;
    EXPECT_TRUE(least_dilatation_map(ring, outer, asked).maximum);
}

}  // namespace
}  // namespace beltrami
