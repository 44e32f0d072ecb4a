#include <beltrami/registration/carried_surface.h>

#include <cmath>

#include <Eigen/Geometry>

namespace beltrami {

namespace {

constexpr double kUnresolved = 0.5;  // |(μ − ν)/(1 − conj(ν) μ)| of a dilatation of 3

Positions positions_at(const Mesh& target, std::span<const MeshPoint> places) {
    Positions points = Positions::Zero(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (int j = 0; j < 3; ++j)
            points.row(static_cast<Eigen::Index>(i)) +=
                places[i].barycentric[j] * target.point(places[i].vertices[j]).transpose();
    return points;
}

/// The normal of the target's face at every place.
Positions normals_at(const Mesh& target, std::span<const MeshPoint> places) {
    Positions normals(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i)
        normals.row(static_cast<Eigen::Index>(i)) = face_vector_area(target, places[i].face).normalized();
    return normals;
}

}  // namespace

void CarriedSurface::measure(const Surface& source, const Surface& target, const Eigen::VectorXcd& mu) {
    positions = positions_at(target.mesh, places);
    in_space = distortion(source.operators, positions, normals_at(target.mesh, places));
    unresolved.clear();
    for (Eigen::Index s = 0; s < mu.size(); ++s) {
        const Complex straight = in_space.mu[s];
        if (std::abs((straight - mu[s]) / (1.0 - std::conj(mu[s]) * straight)) < kUnresolved && std::abs(straight) < 1)
            continue;
        const int face = source.operators.faces[static_cast<int>(s)];
        if (unresolved.empty() || unresolved.back() != face) unresolved.push_back(face);
    }
}

}  // namespace beltrami
