#include <beltrami/registration/target_image.h>

#include <utility>

#include <beltrami/locate/point_at.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/starts/target_model.h>

namespace beltrami {

Eigen::Vector3d TargetImage::place(const Positions& points, const MeshPoint& place) const {
    return surface_point(point_at(points, place));
}

Positions TargetImage::at(const Positions& points, std::span<const MeshPoint> places) const {
    Positions result(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = place(points, places[i]);
    return result;
}

Positions TargetImage::with_places(const Positions& points, std::span<const MeshPoint> places) const {
    Positions result(points.rows() + static_cast<Eigen::Index>(places.size()), 3);
    result << points, at(points, places);
    return result;
}

SphereImage::SphereImage(const Surface& target, const SphereMapOptions& options, Warnings& warnings)
    : faces_(target.mesh.faces) {
    require_sphere(target);
    SphereMap map = sphere_map(target, options);
    append(warnings, map.warnings);
    points_ = std::move(map.positions);
}

std::vector<MeshPoint> SphereImage::locate(const Positions& points) const {
    return SphereLocator(faces_, points_).locate(points);
}

DomainImage::DomainImage(const Surface& target, int outer_loop)
    : surface_(target), chart_(circle_domain_chart(target, outer_loop)), domain_(circle_target(chart_)) {
    points_ = in_space(chart_.chart.vertices);
}

Positions DomainImage::in_space(const Eigen::VectorXcd& plane) {
    Positions points(plane.size(), 3);
    points << plane.real(), plane.imag(), Eigen::VectorXd::Zero(plane.size());
    return points;
}

Eigen::VectorXcd DomainImage::in_plane(const Positions& points) {
    Eigen::VectorXcd plane(points.rows());
    plane.real() = points.col(0);
    plane.imag() = points.col(1);
    return plane;
}

std::vector<MeshPoint> DomainImage::locate(const Positions& points) const {
    const Eigen::VectorXcd plane = in_plane(points);
    return locate_in_chart(surface_, chart_.chart.vertices, std::vector<Complex>(plane.begin(), plane.end()));
}

}  // namespace beltrami
