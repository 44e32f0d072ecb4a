#include <beltrami/forms/flat_torus.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <beltrami/base/error.h>
#include <beltrami/forms/delaunay_forms.h>
#include <beltrami/forms/period_matrix.h>

namespace beltrami {

namespace {

void require_torus(const Topology& t) {
    if (t.components != 1)
        throw Error(Cause::bad_mesh, "the surface has " + std::to_string(t.components) + " components",
                    "take one component at a time");
    if (!t.boundary_loops.empty())
        throw Error(Cause::bad_mesh, "the surface has a boundary, and is no torus", "fill its holes");
    if (t.genus != 1)
        throw Error(Cause::bad_mesh, "the surface has genus " + std::to_string(t.genus) + ", and is no torus",
                    "take one of genus 1");
}

TorusMarking inverse_of(const TorusMarking& m) {
    TorusMarking result;
    result << m(1, 1), -m(0, 1), -m(1, 0), m(0, 0);
    return result;
}

/// The forms dual to the generators, from those dual to the loops: determinant ±1.
Eigen::Matrix2d dual_of(const TorusMarking& generators) {
    return generators.cast<double>().inverse().transpose().array().round().matrix();
}

/// What every corner's place has beyond FlatTorus::lattice of its vertex: integers, such that the faces lie as layout
/// says (#corners×2).
Eigen::MatrixX2i shifts_of_corners(const Surface& surface, const FlatTorus& torus) {
    const FaceList& faces = surface.mesh.faces;
    const Eigen::MatrixX2i cochains = torus.homology.cochains * dual_of(torus.generators).cast<int>();
    Eigen::MatrixX2i shifts(faces.corner_count(), 2);
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f), n = faces.degree(f);
        Eigen::RowVector2i shift(0, 0);
        Eigen::RowVector2d middle(0, 0);
        for (int i = 0; i < n; ++i) {
            shifts.row(first + i) = shift;
            middle += (torus.lattice.row(faces.vertices()[first + i]) + shift.cast<double>()) / n;
            const int edge = surface.topology.corner_edges[first + i];
            const bool along = surface.topology.edges[edge][0] == faces.vertices()[first + i];
            shift += (along ? 1 : -1) * cochains.row(edge);
        }
        const Eigen::RowVector2i whole = middle.array().floor().cast<int>().matrix();
        for (int i = 0; i < n; ++i) shifts.row(first + i) -= whole;
    }
    return shifts;
}

TextureCoordinates layout_of(const Surface& surface, const FlatTorus& torus) {
    const Eigen::MatrixX2i shifts = shifts_of_corners(surface, torus);
    const std::vector<int>& vertices = surface.mesh.faces.vertices();
    const auto place = [&](std::size_t c) {
        const auto row = static_cast<Eigen::Index>(c);
        return std::array{vertices[c], shifts(row, 0), shifts(row, 1)};
    };
    std::map<std::array<int, 3>, int> numbers;
    for (std::size_t c = 0; c < vertices.size(); ++c) numbers[place(c)] = 0;
    TextureCoordinates layout;
    int count = 0;
    layout.points.resize(static_cast<Eigen::Index>(numbers.size()), 2);
    for (auto& [point, number] : numbers) {
        number = count++;
        const auto& [v, m, n] = point;
        const Complex z = torus.lattice(v, 0) + m + torus.tau * (torus.lattice(v, 1) + n);
        layout.points.row(number) << z.real(), z.imag();
    }
    for (std::size_t c = 0; c < vertices.size(); ++c) layout.corners.push_back(numbers.at(place(c)));
    return layout;
}

/// The corners of a Delaunay triangle in lattice coordinates.
std::array<Eigen::RowVector2d, 3> corners_of(const FlatTorus& torus, const Eigen::Matrix2d& dual, int triangle) {
    const detail::DelaunayForms& forms = *torus.forms;
    const int h = 3 * triangle;
    const Eigen::RowVector2d first = torus.lattice.row(forms.triangulation.tail(h));
    return {first, first + forms.along(h) * dual, first - forms.along(h + 2) * dual};
}

double double_area(const std::array<Eigen::RowVector2d, 3>& p) {
    const Eigen::RowVector2d a = p[1] - p[0], b = p[2] - p[0];
    return a[0] * b[1] - a[1] * b[0];
}

void require_embedded(const FlatTorus& torus) {
    const Eigen::Matrix2d dual = dual_of(torus.generators);
    for (int t = 0; t < torus.forms->triangulation.triangle_count(); ++t)
        if (!(double_area(corners_of(torus, dual, t)) > 0))
            throw Error(Cause::not_solved,
                        "triangles are flipped or collapse on the flat torus: the mesh is too coarse, or has parts too "
                        "thin for "
                        "double precision",
                        "remesh the surface: more faces, with edges of like length side by side",
                        {Things::faces, {torus.forms->metric.faces[t]}});
}

}  // namespace

FlatTorus flat_torus(const Surface& surface) {
    require_torus(surface.topology);
    FlatTorus torus;
    torus.homology = homology_basis(surface);
    auto forms = std::make_shared<const detail::DelaunayForms>(surface, torus.homology);
    const PeriodMatrix found = period_matrix(surface, detail::basis_of(surface, torus.homology, *forms));
    const Complex tau = found.periods(0, 0);
    const TorusMarking reducing = reducing_basis(tau);
    torus.generators = found.basis * reducing;
    torus.tau = tau_in_basis(tau, reducing);
    torus.tau_error = 0.5 * std::log1p(found.defect);
    torus.lattice = forms->potentials * dual_of(torus.generators);
    torus.flips = static_cast<int>(forms->flips.size());
    torus.factorizations = 1;
    torus.forms = std::move(forms);
    require_embedded(torus);
    // The first corner of the first face goes to 0.
    const Eigen::RowVector2d origin = torus.lattice.row(surface.mesh.faces.vertices()[0]);
    torus.lattice.rowwise() -= origin;
    torus.layout = layout_of(surface, torus);
    Eigen::VectorXcd corners(surface.mesh.faces.corner_count());
    for (Eigen::Index c = 0; c < corners.size(); ++c) {
        const auto point = torus.layout.points.row(torus.layout.corners[static_cast<std::size_t>(c)]);
        corners[c] = {point[0], point[1]};
    }
    torus.distortion = beltrami::distortion(per_corner(surface.operators, surface.mesh.faces), corners);
    return torus;
}

std::vector<double> flat_areas(const FlatTorus& torus, const FaceList& faces) {
    std::vector<double> areas;
    areas.reserve(static_cast<std::size_t>(faces.size()));
    const auto place = [&](int corner) {
        const auto row = torus.layout.points.row(torus.layout.corners[corner]);
        return Complex(row[0], row[1]);
    };
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f), count = faces.degree(f);
        double twice = 0;
        for (int i = 1; i + 1 < count; ++i)
            twice += std::imag(std::conj(place(first + i) - place(first)) * (place(first + i + 1) - place(first)));
        areas.push_back(0.5 * std::abs(twice));
    }
    return areas;
}

std::vector<MeshPoint> places_on_torus(const FlatTorus& torus, const Positions& lattice_points) {
    const detail::DelaunayForms& forms = *torus.forms;
    const Eigen::Matrix2d dual = dual_of(torus.generators);
    // The triangles over the unit square, several times where they reach across its border.
    std::vector<int> owner;
    std::vector<Eigen::RowVector2d> points;
    Mesh cover;
    for (int t = 0; t < forms.triangulation.triangle_count(); ++t) {
        const std::array<Eigen::RowVector2d, 3> corners = corners_of(torus, dual, t);
        const Eigen::RowVector2d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array().floor();
        const Eigen::RowVector2d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - low;
        for (int i = 0; i <= high[0]; ++i)
            for (int j = 0; j <= high[1]; ++j) {
                const auto n = static_cast<int>(points.size());
                for (const Eigen::RowVector2d& corner : corners)
                    points.push_back(corner - low - Eigen::RowVector2d(i, j));
                cover.faces.add({n, n + 1, n + 2});
                owner.push_back(t);
            }
    }
    cover.positions.resize(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t p = 0; p < points.size(); ++p) cover.positions.row(static_cast<Eigen::Index>(p)) = points[p];
    const PlanarLocator locator(cover);

    std::vector<IntrinsicPoint> found;
    for (Eigen::Index p = 0; p < lattice_points.rows(); ++p) {
        const double x = lattice_points(p, 0), y = lattice_points(p, 1);
        const MeshPoint place = locator.nearest({x - std::floor(x), y - std::floor(y)});
        IntrinsicPoint point{owner[place.face], place.barycentric};
        double sum = 0;
        for (double& weight : point.weights) sum += weight = std::max(weight, 0.0);
        for (double& weight : point.weights) weight /= sum;
        found.push_back(point);
    }
    std::vector<MeshPoint> places;
    for (const IntrinsicPoint& point : before_flips(forms.triangulation, forms.flips, std::move(found))) {
        const auto v = forms.metric.triangles[point.triangle];
        places.push_back({forms.metric.faces[point.triangle], {v[0], v[1], v[2]}, point.weights});
    }
    return places;
}

Eigen::Vector2i torus_class(const Surface& surface, const FlatTorus& torus, std::span<const int> path) {
    const int determinant = torus.generators.determinant();
    return determinant * inverse_of(torus.generators) * homology_class(surface.topology, torus.homology, path);
}

TorusMarking marking_of_paths(const Surface& from, const FlatTorus& flat_from,
                              const std::array<std::vector<int>, 2>& paths_from, const Surface& to,
                              const FlatTorus& flat_to, const std::array<std::vector<int>, 2>& paths_to) {
    TorusMarking there, here;
    for (int i = 0; i < 2; ++i) {
        here.col(i) = torus_class(from, flat_from, paths_from[static_cast<std::size_t>(i)]);
        there.col(i) = torus_class(to, flat_to, paths_to[static_cast<std::size_t>(i)]);
    }
    const int crossings = here.determinant();
    if (crossings == 0)
        throw Error(Cause::bad_option, "two paths do not determine a marking: they cross 0 times, counted with signs",
                    "take paths along and around the tube");
    const TorusMarking product = there * inverse_of(here);
    TorusMarking marking = product / crossings;
    if (marking * crossings != product || marking.determinant() != 1)
        throw Error(Cause::bad_option,
                    "no map that keeps the orientation sends the paths to the others: they cross " +
                        std::to_string(crossings) + " and " + std::to_string(there.determinant()) +
                        " times, counted with signs",
                    "turn one path round, or take others");
    return marking;
}

}  // namespace beltrami
