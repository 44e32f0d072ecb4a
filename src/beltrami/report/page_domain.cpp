#include <beltrami/report/page_domain.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/charts/chart.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/report/fundamental_polygon.h>

namespace beltrami {

namespace {

constexpr int kPiecesOfSide = 48, kPiecesOfCircle = 360;

PageDomain cut_open(const Mesh& surface, const TextureCoordinates& layout) {
    PageDomain result;
    result.mesh = cut_along_seams(surface, layout);
    result.layout = layout.points;
    result.joined.assign(static_cast<std::size_t>(layout.points.rows()), 0);
    for (int c = 0; c < surface.faces.corner_count(); ++c)
        result.joined[static_cast<std::size_t>(layout.corners[static_cast<std::size_t>(c)])] =
            surface.faces.vertices()[static_cast<std::size_t>(c)];
    return result;
}

Positions curve(const std::vector<Complex>& points) {
    Positions result(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t i = 0; i < points.size(); ++i)
        result.row(static_cast<Eigen::Index>(i)) << points[i].real(), points[i].imag();
    return result;
}

}  // namespace

Positions PageDomain::at_copies(const Positions& values) const {
    return values(joined, Eigen::all);
}

PageDifferential PageDomain::at_copies(PageDifferential differential, const Mesh& surface) const {
    for (CriticalPoint& point : differential.points) {
        const auto before = surface.faces[point.place.face], after = mesh.faces[point.place.face];
        for (int& vertex : point.place.vertices)
            vertex = after[static_cast<std::size_t>(std::find(before.begin(), before.end(), vertex) - before.begin())];
    }
    return differential;
}

PageDomain page_domain(const Surface& surface, const FlatTorus& torus) {
    PageDomain result = cut_open(surface.mesh, torus.layout);
    // Where the first corner of the first face has the place 0.
    result.outline.push_back(curve({0, 1, 1.0 + torus.tau, torus.tau, 0}));
    return result;
}

PageDomain page_domain(const Surface& surface, const HyperbolicSurface& metric, const HyperbolicDomain& domain) {
    PageDomain result = cut_open(surface.mesh, domain.layout);
    std::vector<Complex> circle;
    for (int i = 0; i <= kPiecesOfCircle; ++i)
        circle.push_back(std::polar(1.0, 2 * std::numbers::pi * i / kPiecesOfCircle));
    result.outline.push_back(curve(circle));
    // The group of a surface with a boundary is free, and its polygons have no finite area.
    if (metric.has_boundary()) return result;
    // The generators are seen from a vertex that lies at 0.
    const HyperbolicPolygon polygon = dirichlet_polygon(domain.generators, 4 * std::numbers::pi * (metric.genus - 1));
    std::vector<Complex> rim;
    for (std::size_t side = 0; side < polygon.sides.size(); ++side) {
        const std::vector<Complex> points = polygon.points_of_side(side, kPiecesOfSide);
        rim.insert(rim.end(), points.begin(), points.end());
    }
    if (!rim.empty()) result.outline.push_back(curve(rim));
    return result;
}

PageDifferential page_differential(const Surface& surface, const FlatTorus& torus, Complex mu) {
    Eigen::VectorXcd corners(surface.mesh.faces.corner_count());
    for (Eigen::Index c = 0; c < corners.size(); ++c) {
        const auto point = torus.layout.points.row(torus.layout.corners[static_cast<std::size_t>(c)]);
        corners[c] = {point[0], point[1]};
    }
    const Chart chart = make_atlas(surface, corners);
    const Eigen::VectorXcd phi = std::conj(mu) * chart.derivatives.cwiseProduct(chart.derivatives);
    return page_differential(surface, phi, {});
}

}  // namespace beltrami
