#include <beltrami/registration/surface_landmarks.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/locate/point_at.h>

namespace beltrami {

namespace {

constexpr double kLimbPart = 1e-3;   // of the area, around a vertex
constexpr int kMostWaySteps = 1000;  // of a way

}  // namespace

std::vector<std::vector<std::optional<MeshPoint>>> stops_of(std::span<const SurfaceWaypoint> waypoints,
                                                            std::span<const SurfaceLandmark> landmarks) {
    std::vector<std::vector<std::optional<MeshPoint>>> result;
    for (const SurfaceWaypoint& waypoint : waypoints) {
        const auto landmark = std::find_if(landmarks.begin(), landmarks.end(),
                                           [&](const SurfaceLandmark& l) { return l.vertex == waypoint.vertex; });
        if (waypoint.step < 1 || waypoint.step > kMostWaySteps || landmark == landmarks.end())
            throw Error(Cause::bad_option,
                        "a waypoint of vertex " + std::to_string(waypoint.vertex) + " at step " +
                            std::to_string(waypoint.step) + " is impossible",
                        "waypoints belong to landmarks and to steps from 1 to " + std::to_string(kMostWaySteps));
        while (static_cast<int>(result.size()) < waypoint.step) result.emplace_back(landmarks.size());
        result[waypoint.step - 1][landmark - landmarks.begin()] = waypoint.place;
    }
    return result;
}

MeshPoint place_of_vertex(const Mesh& mesh, int vertex) {
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        for (std::size_t i = 0; i < v.size(); ++i)
            if (v[i] == vertex) return {f, {v[i], v[(i + 1) % v.size()], v[(i + v.size() - 1) % v.size()]}, {1, 0, 0}};
    }
    throw Error(Cause::bad_boundary, "vertex " + std::to_string(vertex) + " belongs to no face", "name another one",
                {Things::vertices, {vertex}});
}

int nearest_vertex(const MeshPoint& place) {
    const auto largest = std::max_element(place.barycentric.begin(), place.barycentric.end());
    return place.vertices[largest - place.barycentric.begin()];
}

int vertex_at(const MeshPoint& place) {
    for (int i = 0; i < 3; ++i)
        if (place.barycentric[i] == 1) return place.vertices[i];
    return -1;
}

double squared_scale(const Surface& surface, const Positions& chart, const MeshPoint& place) {
    const int vertex = nearest_vertex(place);
    double in_space = 0, there = 0;
    Mesh image;
    image.faces = surface.mesh.faces;
    image.positions = chart;
    for (int f = 0; f < surface.mesh.face_count(); ++f) {
        const auto v = surface.mesh.faces[f];
        if (std::find(v.begin(), v.end(), vertex) == v.end()) continue;
        in_space += face_vector_area(surface.mesh, f).norm();
        there += face_vector_area(image, f).norm();
    }
    return in_space / (there * surface.operators.area());
}

double limb_size(const Surface& surface, const Positions& sphere, int vertex) {
    const Mesh& mesh = surface.mesh;
    std::vector<std::vector<int>> faces_at(static_cast<std::size_t>(mesh.vertex_count()));
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) faces_at[v].push_back(f);
    std::vector<double> distance(faces_at.size(), std::numeric_limits<double>::infinity());
    std::vector<char> counted(static_cast<std::size_t>(mesh.face_count()), 0);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[vertex] = 0;
    queue.emplace(0.0, vertex);
    double area = 0, farthest = 0;
    while (!queue.empty() && area < kLimbPart * surface.operators.area()) {
        const auto [so_far, v] = queue.top();
        queue.pop();
        if (so_far > distance[v]) continue;
        for (const int f : faces_at[v]) {
            if (!counted[f]) area += face_vector_area(mesh, f).norm();
            counted[f] = 1;
            for (const int w : mesh.faces[f]) {
                farthest = std::max(farthest, (sphere.row(w) - sphere.row(vertex)).norm());
                if (const double there = so_far + (mesh.point(w) - mesh.point(v)).norm(); there < distance[w]) {
                    distance[w] = there;
                    queue.emplace(there, w);
                }
            }
        }
    }
    return farthest;
}

void meet_landmarks(std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried) {
    for (const SurfaceLandmark& landmark : landmarks)
        if (std::isinf(landmark.weight)) carried.places[landmark.vertex] = landmark.place;
}

void measure_landmarks(const Mesh& target, std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried) {
    for (const SurfaceLandmark& landmark : landmarks) {
        if (std::isinf(landmark.weight)) continue;
        const Eigen::Vector3d place = point_at(target, landmark.place);
        const double distance = (carried.positions.row(landmark.vertex).transpose() - place).norm();
        carried.largest_distance = std::max(carried.largest_distance.value_or(0), distance);
    }
}

}  // namespace beltrami
