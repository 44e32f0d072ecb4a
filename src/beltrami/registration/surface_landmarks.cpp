#include <beltrami/registration/surface_landmarks.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

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

void meet_landmarks(std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried) {
    for (const SurfaceLandmark& landmark : landmarks)
        if (std::isinf(landmark.weight)) carried.places[landmark.vertex] = landmark.place;
}

void measure_landmarks(const Mesh& target, std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried) {
    for (const SurfaceLandmark& landmark : landmarks) {
        if (std::isinf(landmark.weight)) continue;
        Eigen::Vector3d place = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3; ++i) place += landmark.place.barycentric[i] * target.point(landmark.place.vertices[i]);
        const double distance = (carried.positions.row(landmark.vertex).transpose() - place).norm();
        carried.largest_distance = std::max(carried.largest_distance.value_or(0), distance);
    }
}

}  // namespace beltrami
