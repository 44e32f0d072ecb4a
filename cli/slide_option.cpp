#include "slide_option.h"

#include <beltrami/io/number_lists.h>
#include <beltrami/mesh/boundary_position.h>

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
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        SlidingArc arc{rows.indices(i, 0), rows.indices(i, 1)};
        if (const auto at = boundary_position(source.topology, arc.first)) arc.along = boundary.curve(at->loop);
        result.push_back(std::move(arc));
    }
    return result;
}

}  // namespace beltrami::cli
