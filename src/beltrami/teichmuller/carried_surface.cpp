#include <beltrami/locate/point_at.h>
#include <beltrami/teichmuller/carried_surface.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace beltrami {

namespace {

constexpr double kUnresolved = 0.5;  // |(μ − ν)/(1 − conj(ν) μ)| of a dilatation of 3

/// The normal of the target's face at every place.
Positions normals_at(const Mesh& target, std::span<const MeshPoint> places) {
    Positions normals(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i)
        normals.row(static_cast<Eigen::Index>(i)) = face_vector_area(target, places[i].face).normalized();
    return normals;
}

/// #F 1 for faces whose straight images miss a vertex of the target that belongs there by more than their longest side.
std::vector<char> faces_that_miss(const Mesh& source, const Mesh& target, const Positions& images,
                                  std::span<const MeshPoint> back) {
    std::vector<char> result(static_cast<std::size_t>(source.face_count()), 0);
    for (std::size_t v = 0; v < back.size(); ++v) {
        const MeshPoint& place = back[v];
        if (place.face < 0) continue;
        double longest = 0;
        for (int i = 0; i < 3; ++i)
            longest =
                std::max(longest, (images.row(place.vertices[(i + 1) % 3]) - images.row(place.vertices[i])).norm());
        if ((point_at(images, place) - target.point(static_cast<int>(v))).norm() > longest) result[place.face] = 1;
    }
    return result;
}

}  // namespace

void CarriedSurface::measure(const Surface& source, const Surface& target, const Eigen::VectorXcd& mu,
                             std::span<const MeshPoint> back) {
    positions = points_at(target.mesh, places);
    in_space = distortion(source.operators, positions, normals_at(target.mesh, places));
    std::vector<char> missed = faces_that_miss(source.mesh, target.mesh, positions, back);
    for (Eigen::Index s = 0; s < mu.size(); ++s) {
        const Complex straight = in_space.mu[s];
        if (std::abs((straight - mu[s]) / (1.0 - std::conj(mu[s]) * straight)) < kUnresolved && std::abs(straight) < 1)
            continue;
        missed[source.operators.faces[static_cast<int>(s)]] = 1;
    }
    unresolved.clear();
    for (int f = 0; f < source.mesh.face_count(); ++f)
        if (missed[f]) unresolved.push_back(f);
}

}  // namespace beltrami
