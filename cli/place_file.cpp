#include "place_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/locate/corner_weights.h>

namespace beltrami::cli {

namespace {

/// Weights of a point's corners sum up to 1, and are not negative, up to this.
constexpr double kWeightTolerance = 1e-9;

}  // namespace

void fail_at_row(const std::string& path, const NumberRow& row, const std::string& what, Cause cause,
                 const std::string& next_step) {
    throw Error(cause, fmt::format("{}:{}: {}", path, row.line, what), next_step,
                {Things::lines, {static_cast<int>(row.line) - 1}});
}

MeshPoint place_of_row(const std::string& path, const NumberRow& row, const Mesh& mesh) {
    const std::vector<double>& n = row.numbers;
    if (!(n[0] >= 0 && n[0] < mesh.face_count() && n[0] == std::floor(n[0])))
        fail_at_row(path, row, fmt::format("{} is not a face from 0 to {}", n[0], mesh.face_count() - 1));
    const int face = static_cast<int>(n[0]);
    const auto corners = mesh.faces[face];
    if (n.size() != corners.size() + 1)
        fail_at_row(path, row,
                    fmt::format("face {} has {} corners, {} are given", face, corners.size(),
                                counted(n.size() - 1, "weight", "weights")));
    double sum = 0;
    std::size_t left_out = 3;  // of a quad, a corner of weight 0
    for (std::size_t j = 0; j < corners.size(); ++j) {
        const double weight = n[j + 1];
        if (!(weight >= -kWeightTolerance)) fail_at_row(path, row, fmt::format("the weight {} is negative", weight));
        sum += weight;
        if (weight == 0) left_out = j;
    }
    if (!(std::abs(sum - 1) <= kWeightTolerance))
        fail_at_row(path, row, fmt::format("the weights sum up to {}, not 1", sum));
    if (corners.size() == 4 && n[left_out + 1] != 0)
        fail_at_row(path, row, "a quad is two triangles, so one of the four weights must be 0");
    MeshPoint place{face, {}, {}};
    for (std::size_t j = 0, i = 0; j < corners.size(); ++j) {
        if (corners.size() == 4 && j == left_out) continue;
        place.vertices[i] = corners[j];
        place.barycentric[i++] = n[j + 1];
    }
    return place;
}

std::string line_of_place(const Mesh& mesh, const MeshPoint& place) {
    std::string text = std::to_string(place.face);
    for (const double weight : corner_weights(mesh, place)) text += fmt::format(" {}", weight);
    return text + "\n";
}

std::vector<MeshPoint> read_places(const std::string& path, const Mesh& mesh, int count) {
    const std::vector<NumberRow> rows = read_number_rows(path, 4, 5, "a place: face and weights of its corners");
    if (static_cast<int>(rows.size()) != count)
        throw Error(Cause::unreadable,
                    fmt::format("{} has {}, the mesh {}", path, counted(rows.size(), "place", "places"),
                                counted(static_cast<std::size_t>(count), "vertex", "vertices")),
                    "give the file that `register` wrote for these two meshes");
    std::vector<MeshPoint> places;
    places.reserve(rows.size());
    for (const NumberRow& row : rows) places.push_back(place_of_row(path, row, mesh));
    return places;
}

void write_places(const std::string& path, const Mesh& mesh, std::span<const MeshPoint> places) {
    std::string text;
    for (const MeshPoint& place : places) text += line_of_place(mesh, place);
    write_atomically(path, text);
}

}  // namespace beltrami::cli
