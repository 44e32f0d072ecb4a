#include "slide_option.h"

#include <algorithm>

#include <beltrami/io/number_lists.h>

namespace beltrami::cli {

void SlideOption::add_to(CLI::App& app) {
    app.add_option("--slide", path_,
                   "arcs of the boundary that slide while the rest of their loop is prescribed: a line `first_vertex "
                   "last_vertex` each, the arc from first to last along its loop, which has the surface on its left; "
                   "along the circle or polygon of --boundary or --hole, else along the curve of --onto; its ends stay "
                   "prescribed")
        ->type_name("FILE");
}

std::vector<SlidingArc> SlideOption::arcs(const Surface& source, const BoundaryOptions& boundary) const {
    std::vector<SlidingArc> result;
    if (!given()) return result;
    const IndexedRows rows = read_indexed_rows(path_, 2, source.mesh.vertex_count(), 0, "an arc");
    const auto& loops = source.topology.boundary_loops;
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        SlidingArc arc{rows.indices(i, 0), rows.indices(i, 1)};
        for (std::size_t l = 0; l < loops.size(); ++l)
            if (std::find(loops[l].begin(), loops[l].end(), arc.first) != loops[l].end())
                arc.along = boundary.curve(static_cast<int>(l));
        result.push_back(std::move(arc));
    }
    return result;
}

}  // namespace beltrami::cli
