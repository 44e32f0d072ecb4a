#pragma once

#include <vector>

#include <beltrami/charts/chart.h>

namespace beltrami {

/// The largest ratio of the extremal distances of two opposite sides, here and there, over quadrilaterals of vertices
/// that run around the circle at the angles @p from and @p to: no map of the disk with these boundary values has a
/// smaller dilatation (Grötzsch). Sides of few edges, which show an outline's noise, are left out. The search is local:
/// another quadrilateral may say more.
/// @param from, to #n angles, ascending within less than a turn
/// @return at least 1; 1 where there are too few vertices
double quadrilateral_ratio(const std::vector<double>& from, const std::vector<double>& to);

/// The same for a disk whose boundary goes to a circle, its vertices at their angles in the chart: an estimate of what
/// the surface forces, as good as the chart.
/// @param images of the vertices of the boundary loop, in its order
/// @return 1 unless the images run around a circle once and the chart's rim does so too
double chart_quadrilateral_estimate(const Surface& source, const Chart& chart, const std::vector<Complex>& images);

}  // namespace beltrami
