#pragma once

#include <beltrami/charts/chart.h>

namespace beltrami {

/// Degree of φ that the outer loop of a round chart resolves: a function of degree d turns d times along the circle,
/// and each turn takes so many edges, of the length that a place of the rim sees on average (Σe²/Σe).
/// @pre the outer loop lies on the unit circle of the chart
int degree_of_rim(const Surface& source, const Chart& chart);

/// Powers of r/(z − c) of φ that the boundary of a hole resolves, by its edges.
/// @param loop of the source
int powers_of_hole(const Surface& source, int loop);

}  // namespace beltrami
