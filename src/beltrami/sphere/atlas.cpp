#include <beltrami/sphere/atlas.h>

#include <cmath>

#include <beltrami/sphere/unit_sphere.h>

namespace beltrami::atlas {

Complex place(const Eigen::Vector3d& point, bool south) {
    if (!south) return stereographic(point);
    // 1/z: the point turned by half a turn around the x-axis.
    return kSouth + stereographic(Eigen::Vector3d(point.x(), -point.y(), -point.z()));
}

std::array<Complex, 2> spinor(Complex place) {
    if (place.real() > kSouth / 2) return {1.0, place - kSouth};
    return {place, 1.0};
}

std::array<Complex, 2> unit_spinor(const Eigen::Vector3d& point) {
    auto [xi, eta] = spinor(place(point, point.z() < 0));
    const double size = std::sqrt(std::norm(xi) + std::norm(eta));
    return {xi / size, eta / size};
}

Eigen::VectorXcd corner_places(const FaceList& faces, const Positions& points) {
    Eigen::VectorXcd places(faces.corner_count());
    for (int f = 0; f < faces.size(); ++f) {
        double height = 0;
        for (const int v : faces[f]) height += points(v, 2);
        for (int i = 0; i < faces.degree(f); ++i)
            places[faces.first_corner(f) + i] = place(points.row(faces[f][i]), height < 0);
    }
    return places;
}

}  // namespace beltrami::atlas
