#pragma once

#include <optional>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/space/unrolled_map.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// The extremal map of an annulus onto a surface that is the plane rolled up, its boundary held, where that surface is
/// unrolled: φ is written down in the source's strip (annulus_strip), and images move in the plane that has the
/// target's metric. Of the result map, distortion, φ, k and estimates of its bounds are set; map is unrolled.
/// @param source  one component of genus 0 with two boundary loops
/// @param places  where the map begins; which turn the faces are in is kept
/// @param fixed   #V the boundary's vertices
/// @throw Error not_solved, cancelled
ExtremalMap extremal_unrolled_map(const Surface& source, const CornerElements& elements, const UnrolledPlaces& places,
                                  const std::vector<char>& fixed, const Progress& progress);

}  // namespace beltrami
