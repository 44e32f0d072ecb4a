#pragma once

#include <beltrami/certificate/pair_bound.h>

namespace beltrami {

/// The largest bound that pairs of piecewise linear functions with periods around the holes prove, or of functions up
/// to sign that change it around them: the pair bound (pair_bound.h) of one homotopy class.
///
/// For closed forms ω on the image and η on the surface ∫ f*ω ∧ η is the same for all f of a class: f*ω − F*ω is exact
/// for maps f and F with the same boundary values, of a function that is one and the same constant on all boundary
/// loops if they are homotopic with their boundary values kept. So it may be worked out face by face for the map at
/// hand. Where K* is that of a class, as of turned holes, single-valued functions see little of it.
/// @param image  of the same faces, under a map of the class
/// @pre all faces of source are triangles, genus 0, two or more boundary loops
/// @throw Error not_solved
PairBound period_pair_bound(const Surface& source, const BoundaryImage& image, const PairBoundOptions& options = {});

}  // namespace beltrami
