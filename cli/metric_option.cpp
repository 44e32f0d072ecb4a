#include "metric_option.h"

#include <beltrami/io/number_lists.h>

namespace beltrami::cli {

void MetricOption::add_to(CLI::App& app) {
    app.add_option("--metric", metric_,
                   "the metric of the source: FILE with a line `i j length` per edge, or vt for the edge lengths of "
                   "SOURCE's own vt")
        ->type_name("FILE|vt");
}

std::vector<NamedFile> MetricOption::inputs() const {
    if (!from_file()) return {};
    return {{"--metric", metric_}};
}

void MetricOption::load(const MeshInput& input) {
    if (!from_file()) return;
    const IndexedRows rows =
        read_indexed_rows(metric_, 2, static_cast<int>(input.numbers.size()), 1, "an edge of the metric");
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
        lengths_.push_back({input.number_of(rows.indices(i, 0), "an end of an edge"),
                            input.number_of(rows.indices(i, 1), "an end of an edge"), rows.values(i, 0)});
}

Surface MetricOption::surface_of(Mesh mesh) const {
    if (metric_.empty()) return Surface(std::move(mesh));
    require_sound(mesh);
    Positions corners = from_file() ? corners_from_lengths(mesh, lengths_) : texture_corners(mesh);
    return Surface(std::move(mesh), std::move(corners));
}

}  // namespace beltrami::cli
