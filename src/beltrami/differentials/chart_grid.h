#pragma once

#include <beltrami/charts/chart.h>
#include <beltrami/differentials/singularities.h>

namespace beltrami {

/// Samples of a chart sorted into square cells over the canonical domain. Cells without samples do not occur.
struct ChartGrid {
    std::vector<int> cell;     ///< #S, −1 for an excluded sample
    std::vector<int> offsets;  ///< #cells+1 positions in samples
    std::vector<int> samples;  ///< ordered by cell, ascending within
    std::vector<double> size;  ///< #cells edge length of each cell
    int cell_count() const { return static_cast<int>(offsets.size()) - 1; }
};

/// @param phase the grid's rotation
/// @param size  edges of the cells, in the canonical domain
ChartGrid chart_grid(const Chart& chart, double phase, const CellSize& size);

}  // namespace beltrami
