#include <beltrami/space/polygon_surface.h>

#include <algorithm>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/space/corner_elements.h>

namespace beltrami {

namespace {

std::vector<std::vector<double>> lengths_of_loops(const Surface& surface) {
    std::vector<std::vector<double>> lengths;
    for (const auto& loop : surface.topology.boundary_loops) {
        auto& of_loop = lengths.emplace_back();
        for (std::size_t i = 0; i < loop.size(); ++i)
            of_loop.push_back((surface.mesh.point(loop[(i + 1) % loop.size()]) - surface.mesh.point(loop[i])).norm());
    }
    return lengths;
}

/// A finding about the triangles as one about the polygons.
void name_polygons(Finding& finding, const std::vector<int>& face_of_triangle) {
    if (finding.where().of != Things::faces) return;
    for (int& face : finding.indices) face = face_of_triangle[face];
    finding.indices.erase(std::unique(finding.indices.begin(), finding.indices.end()), finding.indices.end());
}

}  // namespace

bool has_polygons(const Mesh& mesh) {
    for (int f = 0; f < mesh.face_count(); ++f)
        if (mesh.faces.degree(f) > 4) return true;
    return false;
}

std::vector<int> folded_corner_faces(const Mesh& mesh) {
    std::vector<int> result;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        const std::size_t n = v.size();
        if (n < 4) continue;
        const Eigen::Vector3d up = face_vector_area(mesh, f);
        for (std::size_t j = 0; j < n; ++j) {
            const Eigen::Vector3d at = mesh.point(v[j]);
            const Eigen::Vector3d corner = (mesh.point(v[(j + 1) % n]) - at).cross(mesh.point(v[(j + n - 1) % n]) - at);
            if (corner.dot(up) > 0) continue;
            result.push_back(f);
            break;
        }
    }
    return result;
}

SplitMesh split_folded_polygons(const Mesh& mesh) {
    return split_faces(mesh, folded_corner_faces(mesh));
}

Surface polygon_surface(Mesh mesh) {
    if (!has_polygons(mesh)) return Surface(std::move(mesh));
    if (std::vector<int> folded = folded_corner_faces(mesh); !folded.empty()) {
        const std::string sentence = "face " + std::to_string(folded[0]) + " is not convex at all of its corners";
        throw Error(Cause::bad_mesh, sentence, "cut it into triangles", {Things::faces, std::move(folded)});
    }
    SplitMesh split = split_large_faces(mesh);
    Surface surface(std::move(split.mesh));
    for (Finding& finding : surface.findings) name_polygons(finding, split.faces);
    surface.topology = topology(mesh);
    surface.operators = corner_elements(mesh).operators;
    surface.mesh = std::move(mesh);
    surface.boundary_edge_lengths = lengths_of_loops(surface);
    return surface;
}

}  // namespace beltrami
