#include "landmark_options.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/registration/nearest_places.h>

#include "place_file.h"

namespace beltrami::cli {

namespace {

constexpr double kFar = 0.01;  // of the target's diagonal, beyond which a point is hardly meant to be on it

int index_of(const std::string& path, const NumberRow& row, double number) {
    if (!(number >= 0 && number <= std::numeric_limits<int>::max() && number == std::floor(number)))
        fail_at_row(path, row, fmt::format("{} is not the number of a vertex", number));
    return static_cast<int>(number);
}

}  // namespace

int index_at(const std::string& path, const NumberRow& row, std::size_t column) {
    return index_of(path, row, row.numbers[column]);
}

bool is_far(const NearestPlace& place, const MeshInput& target) {
    const Mesh& mesh = target.mesh;
    const double diagonal = (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
    return place.distance > kFar * diagonal * target.unit;
}

NearestPlace place_at(const std::string& path, const NumberRow& row, std::size_t column, const MeshInput& target) {
    const std::vector<double>& n = row.numbers;
    if (n.size() == column + 1) {
        const int vertex = target.number_of(index_of(path, row, n[column]), "a landmark's place");
        return {place_of_vertex(target.mesh, vertex), 0};
    }
    if (n.size() != column + 3)
        fail_at_row(path, row,
                    fmt::format("{} are given, {} or {} are wanted", counted(n.size(), "number", "numbers"), column + 1,
                                column + 3));
    Positions point(1, 3);
    point << n[column], n[column + 1], n[column + 2];
    if (!point.allFinite()) fail_at_row(path, row, "a coordinate is not finite");
    NearestPlace nearest = nearest_places(target.mesh, point / target.unit)[0];
    nearest.distance *= target.unit;
    return nearest;
}

void LandmarkOptions::add_to(CLI::App& app) {
    app.add_option("--landmarks", landmarks_,
                   "what belongs to what: lines `source_vertex target_vertex` or `source_vertex x y z`, for which the "
                   "nearest point of TARGET is taken; vertices are counted from 0")
        ->type_name("FILE");
    app.add_option("--weights", weights_,
                   "lines `source_vertex weight` of landmarks that need not be met: being off by d costs weight·d², d "
                   "in units of the root of TARGET's area, beside ½ log K")
        ->type_name("FILE");
    app.add_option("--waypoints", waypoints_,
                   "ways of landmarks, which choose the homotopy class: lines `step source_vertex target_vertex` or "
                   "`step source_vertex x y z`, steps from 1; landmarks not named at a step go straight")
        ->type_name("FILE");
}

std::vector<NamedFile> LandmarkOptions::inputs() const {
    return {{"--landmarks", landmarks_}, {"--weights", weights_}, {"--waypoints", waypoints_}};
}

std::vector<SurfaceLandmark> LandmarkOptions::landmarks(const MeshInput& source, const MeshInput& target,
                                                        Warnings& warnings) const {
    std::vector<SurfaceLandmark> result;
    if (landmarks_.empty()) {
        if (!weights_.empty())
            throw Error(Cause::bad_option, "--weights without --landmarks", "give the landmarks too");
        return result;
    }
    std::vector<int> lines;
    for (const NumberRow& row : read_number_rows(landmarks_, 2, 4, "a landmark")) {
        const int vertex = source.number_of(index_at(landmarks_, row, 0), "a landmark");
        const NearestPlace nearest = place_at(landmarks_, row, 1, target);
        result.push_back({vertex, nearest.place});
        if (is_far(nearest, target)) lines.push_back(static_cast<int>(row.line) - 1);
    }
    if (!lines.empty())
        warnings.push_back({WarningKind::marks,
                            fmt::format("{} far from TARGET (more than 1 % of its diagonal), the first on line {}",
                                        counted(lines.size(), "landmark is", "landmarks are"), lines[0] + 1),
                            {Things::lines, lines}});
    if (weights_.empty()) return result;
    for (const NumberRow& row : read_number_rows(weights_, 2, 2, "a weight: `source_vertex weight`")) {
        const int vertex = source.number_of(index_at(weights_, row, 0), "a landmark");
        const double weight = row.numbers[1];
        if (!(weight > 0 && std::isfinite(weight)))
            fail_at_row(weights_, row, fmt::format("the weight {} is not positive", weight));
        bool found = false;
        for (SurfaceLandmark& landmark : result)
            if (landmark.vertex == vertex) landmark.weight = weight, found = true;
        if (!found) fail_at_row(weights_, row, fmt::format("vertex {} is no landmark", row.numbers[0]));
    }
    return result;
}

std::vector<SurfaceWaypoint> LandmarkOptions::waypoints(const MeshInput& source, const MeshInput& target) const {
    std::vector<SurfaceWaypoint> result;
    if (waypoints_.empty()) return result;
    for (const NumberRow& row : read_number_rows(waypoints_, 3, 5, "a waypoint")) {
        const int step = index_at(waypoints_, row, 0);
        const int vertex = source.number_of(index_at(waypoints_, row, 1), "a landmark");
        result.push_back({step, vertex, place_at(waypoints_, row, 2, target).place});
    }
    return result;
}

}  // namespace beltrami::cli
