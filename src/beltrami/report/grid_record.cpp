#include <beltrami/report/grid_record.h>

#include <fmt/format.h>

#include <numbers>

#include <beltrami/report/text_table.h>

namespace beltrami {

namespace {

double area_of(const Mesh& mesh) {
    double area = 0;
    for (int f = 0; f < mesh.face_count(); ++f) area += face_vector_area(mesh, f).norm();
    return area;
}

}  // namespace

GridRecord grid_record(const SurfaceGrid& grid, const Mesh& surface) {
    GridRecord record;
    record.vertices = grid.mesh.vertex_count();
    for (int f = 0; f < grid.mesh.face_count(); ++f)
        ++(grid.mesh.faces.degree(f) == 4 ? record.quads : record.triangles);
    record.whole_cells = grid.whole_cells;
    record.trimmed_cells = grid.trimmed_cells;
    record.omitted_cells = grid.omitted_cells;
    record.quality = grid.quality;
    record.area_part = area_of(grid.mesh) / area_of(surface);
    return record;
}

std::string to_table(const GridRecord& record) {
    const GridQuality& quality = record.quality;
    const auto degrees = [](double angle) { return fmt::format("{:.1f}", angle * 180 / std::numbers::pi); };
    return text_table({{"grid", "quads", "triangles", "omitted", "folded", "min angle", "max angle", "mean skew",
                        "mean aspect", "max aspect", "area ratio", "area"},
                       {to_string(record.lines), std::to_string(record.quads), std::to_string(record.triangles),
                        std::to_string(record.omitted_cells), std::to_string(quality.folded.size()),
                        degrees(quality.min_angle), degrees(quality.max_angle), degrees(quality.mean_skew),
                        fmt::format("{:.3f}", quality.mean_aspect), fmt::format("{:.2f}", quality.max_aspect),
                        fmt::format("{:.1f}", quality.area_ratio), fmt::format("{:.1f} %", 100 * record.area_part)}});
}

}  // namespace beltrami
