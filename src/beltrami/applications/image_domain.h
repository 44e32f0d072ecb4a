#pragma once

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The domain that the boundary of a map to the plane bounds: the loop whose image encloses the most, and the others as
/// holes, in the order of the loops. A loop whose vertices lie on a circle is that circle, others are polygons.
/// @param map #V
/// @throw Error bad_mesh unless the surface has one component, genus 0 and a boundary; bad_boundary, naming the
///        vertices of a loop whose image meets itself; bad_option if two loops meet, or do not lie in each other
TargetDomain image_domain(const Surface& source, const Eigen::VectorXcd& map);

}  // namespace beltrami
