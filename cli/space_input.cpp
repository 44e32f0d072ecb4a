#include "space_input.h"

#include <set>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/space/polygon_surface.h>

#include "command.h"

namespace beltrami::cli {

Surface surface_in_space(const MeshInputOptions& options, const std::string& path, MeshInput& input, Record& record) {
    input = options.load_polygons(path, record.warnings);
    cut_folded_polygons(input, record.warnings);
    Surface surface = polygon_surface(input.mesh);
    add_findings(surface.findings, record.warnings);
    record.source = source_record(surface, input.unit);
    return surface;
}

Mesh target_in_space(const std::string& path, double unit, Warnings& warnings) {
    MeshInput target = MeshInputOptions().load_polygons(path, warnings);
    cut_folded_polygons(target, warnings);
    target.mesh.positions *= target.unit / unit;
    return std::move(target.mesh);
}

PlacesInSpace places_in_space(const std::string& path, const MeshInput& input, const std::string& what) {
    const IndexedRows rows =
        read_indexed_rows(path, 1, static_cast<int>(input.numbers.size()), 3, what + ": vertex x y z");
    PlacesInSpace result;
    std::set<int> seen;
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        result.vertices.push_back(input.number_of(rows.indices(i, 0), what));
        if (!seen.insert(result.vertices.back()).second)
            throw Error(Cause::bad_boundary, fmt::format("{} names vertex {} twice", path, rows.indices(i, 0)),
                        "give one place", {Things::vertices, {result.vertices.back()}});
    }
    result.places = rows.values / input.unit;
    return result;
}

}  // namespace beltrami::cli
