#pragma once

#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A bounded domain of the plane given by its boundary curves, all with the domain on their left, as the boundary loops
/// of a mesh have their faces. Curve 0 is the outer one, curve i + 1 is hole i.
struct TargetDomain {
    TargetCurve outer;                    ///< counter-clockwise
    std::vector<TargetCurve> holes = {};  ///< clockwise

    int curve_count() const { return static_cast<int>(holes.size()) + 1; }
    const TargetCurve& curve(int index) const {
        return index == 0 ? outer : holes[static_cast<std::size_t>(index) - 1];
    }
    /// Whether a point lies in the domain. @pre not on a curve
    bool contains(Complex p) const;
    double area() const;
};

/// "the outer curve" or "hole i", for sentences.
std::string curve_name(int curve);

/// The domain between curves that may run in either direction: they are turned as the domain wants them.
/// @throw Error bad_option naming the hole that lies outside the outer curve or in another one, or the two curves that
///        meet
TargetDomain target_domain(TargetCurve outer, std::vector<TargetCurve> holes = {});

/// @throw Error bad_option as target_domain, or if a curve runs the wrong way
void validate(const TargetDomain& domain);

/// The domain that a planar mesh covers, seen from the side from which its faces run counter-clockwise (planar.h):
/// curve l is the polygon of topology.boundary_loops[l], with its vertices in their order as knots().
/// @throw Error bad_mesh unless the mesh lies in the plane, has one component, genus 0 and a boundary; bad_boundary
///        naming a loop that crosses itself or loops that meet
TargetDomain boundary_domain(const Surface& planar);

}  // namespace beltrami
