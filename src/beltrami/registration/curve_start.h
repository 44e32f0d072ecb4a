#pragma once

#include <span>
#include <vector>

#include <beltrami/curves/surface_curve.h>

namespace beltrami {

/// A map between two closed surfaces of genus 0 that takes curves to curves, by cutting both along them: the parts of
/// the one go to the parts of the other, every part by the conformal chart of its target to a disk with round holes,
/// every vertex inside to the mean of its neighbours there (Tutte 1963). The sides of a curve go to those of its
/// partner, in proportion to arc length between the given points. Parts with one boundary loop are not folded, others
/// may be.
/// @return #V places on the target's mesh of the source's vertices
/// @throw Error bad_boundary if the curves divide the two surfaces in different ways, or a curve consists of one edge;
///        not_solved
std::vector<MeshPoint> map_cut_along_curves(const MeshWithCurves& source, const MeshWithCurves& target);

/// The segment of a curve that lies where a point of its partner is, and how far along it: between the same given
/// points, at the same part of the arc.
struct PlaceOnCurve {
    std::size_t segment;
    double part;
};
PlaceOnCurve partner_place(const MeshWithCurves::Chain& curve, std::size_t vertex,
                           const MeshWithCurves::Chain& partner);

}  // namespace beltrami
