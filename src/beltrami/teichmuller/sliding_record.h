#pragma once

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// Rotation of the c-step's grid, tied to the source's shape.
double phase_of(const CircleDomainChart& domain, const Surface& source);

/// K, k and the bounds of a map some of whose boundary slides.
/// @param k of its last c-step
void record_sliding_bounds(const ReichStrebel& integrals, double k, ExtremalMap& result);

}  // namespace beltrami
