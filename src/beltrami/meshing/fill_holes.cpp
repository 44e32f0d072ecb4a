#include <beltrami/meshing/fill_holes.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/meshing/polygon_fill.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// The fill of one loop: its rim in the direction in which the fill's faces run, and the fill over it.
struct Cap {
    std::vector<int> rim;
    std::vector<Complex> corners;  ///< shape of the rim; empty: a cone
    PolygonFill fill;
    double slant = 0;  ///< of a cone: distance of its tip from the rim
    Positions added;   ///< positions of the added vertices
};

std::vector<int> reversed(const std::vector<int>& loop) {
    return {loop.rbegin(), loop.rend()};
}

/// Fans of a cone over n sides.
PolygonFill cone(int n) {
    PolygonFill fill;
    fill.added.emplace_back(0);
    for (int i = 0; i < n; ++i) fill.triangles.push_back({i, (i + 1) % n, n});
    return fill;
}

/// Caps that lie in the plane; empty if some loop is not a simple polygon.
std::vector<Cap> planar_caps(const Surface& source, const std::vector<int>& loops) {
    const Eigen::VectorXcd& z = *source.coordinate();
    const double side = seen_from_below(source.mesh) ? -1 : 1;
    std::vector<Cap> caps;
    for (const int l : loops) {
        Cap cap;
        cap.rim = reversed(source.topology.boundary_loops[l]);
        for (const int v : cap.rim) cap.corners.push_back(z[v]);
        try {
            require_simple_polygon(cap.corners);
            cap.fill = fill_polygon(cap.corners);
        } catch (const Error&) {
            return {};
        }
        cap.added = Positions::Zero(cap.fill.added.size(), source.mesh.positions.cols());
        for (std::size_t i = 0; i < cap.fill.added.size(); ++i)
            cap.added.row(i).head(2) << cap.fill.added[i].real(), side * cap.fill.added[i].imag();
        caps.push_back(std::move(cap));
    }
    return caps;
}

/// Positions over the inside of a circle from those of points on it: Poisson's integral.
/// @param rim positions of the corners
Positions harmonic_positions(const Positions& rim, const Cap& cap) {
    const int n = static_cast<int>(cap.rim.size());
    const double radius = std::abs(cap.corners[0]);
    std::vector<double> arc(n);
    for (int i = 0; i < n; ++i)
        arc[i] = std::arg(cap.corners[(i + 1) % n] / cap.corners[i]) +
                 std::arg(cap.corners[i] / cap.corners[(i + n - 1) % n]);
    Positions result = Positions::Zero(cap.fill.added.size(), rim.cols());
    for (std::size_t j = 0; j < cap.fill.added.size(); ++j) {
        double total = 0;
        for (int i = 0; i < n; ++i) {
            const double weight = arc[i] * radius * radius / std::norm(cap.corners[i] - cap.fill.added[j]);
            result.row(j) += weight * rim.row(i);
            total += weight;
        }
        result.row(j) /= total;
    }
    return result;
}

/// Corners of the triangle with the given sides; empty if it has hardly any area.
std::vector<Complex> triangle(const std::vector<double>& sides) {
    const double a = sides[0], b = sides[1], c = sides[2];
    if (a + b + c - 2 * std::max({a, b, c}) < 1e-3 * std::max({a, b, c})) return {};
    const double x = (a * a + c * c - b * b) / (2 * a);
    return {0, a, Complex(x, std::sqrt(c * c - x * x))};
}

/// A cap of its own shape.
/// @param normals of the source's vertices
/// @param raised  whether its vertices have to leave the plane of the source, which they would cover twice
Cap intrinsic_cap(const Surface& source, int loop, const Positions& normals, bool raised) {
    const auto& vertices = source.topology.boundary_loops[loop];
    const int n = static_cast<int>(vertices.size());
    Cap cap;
    cap.rim = reversed(vertices);
    // Side i of the rim runs from vertices[n−1−i] to vertices[n−2−i].
    std::vector<double> lengths(n);
    double longest = 0, total = 0;
    for (int i = 0; i < n; ++i) {
        lengths[i] = source.boundary_edge_lengths[loop][(2 * n - 2 - i) % n];
        longest = std::max(longest, lengths[i]);
        total += lengths[i];
    }
    cap.corners = n == 3 && !(raised && loop == 0) ? triangle(lengths) : cyclic_polygon(lengths);
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    for (const int v : vertices) up += normals.row(v).transpose();
    up = up.norm() > 0 ? up.normalized().eval() : Eigen::Vector3d::UnitZ();
    const int columns = raised ? 3 : static_cast<int>(source.mesh.positions.cols());
    Positions rim = Positions::Zero(n, columns);
    for (int i = 0; i < n; ++i) rim.row(i).head(source.mesh.positions.cols()) = source.mesh.positions.row(cap.rim[i]);
    if (!cap.corners.empty()) {
        cap.fill = fill_polygon(cap.corners);
        if (!cap.fill.added.empty())
            cap.added = harmonic_positions(rim, cap);
        else
            cap.added = Positions::Zero(0, columns);
        const double radius = std::abs(cap.corners[0]);
        for (std::size_t i = 0; raised && i < cap.fill.added.size(); ++i)
            cap.added.row(i) += 0.5 * (radius - std::norm(cap.fill.added[i]) / radius) * up.transpose();
        return cap;
    }
    cap.fill = cone(n);
    cap.slant = std::max(0.6 * longest, total / (2 * std::numbers::pi));
    cap.added = Positions::Zero(1, columns);
    for (int i = 0; i < n; ++i) cap.added.row(0) += (lengths[i] + lengths[(i + n - 1) % n]) / (2 * total) * rim.row(i);
    if (columns == 3) cap.added.row(0) += 0.5 * cap.slant * up.transpose();  // the loop may have no area of its own
    return cap;
}

}  // namespace

FilledSurface fill_holes(const Surface& source, int outer_loop) {
    return fill_holes(source, std::vector<int>{outer_loop});
}

FilledSurface fill_holes(const Surface& source, const std::vector<int>& open) {
    const auto& boundary = source.topology.boundary_loops;
    for (const int l : open)
        if (l < 0 || l >= static_cast<int>(boundary.size()))
            throw Error(Cause::bad_option,
                        "there is no boundary loop " + std::to_string(l) + " to leave open: the surface has " +
                            std::to_string(boundary.size()),
                        "loops are counted from 0, the outer one first");
    const auto stays_open = [&](int l) { return std::find(open.begin(), open.end(), l) != open.end(); };
    std::vector<int> loops;
    for (int l = 0; l < static_cast<int>(boundary.size()); ++l)
        if (!stays_open(l)) loops.push_back(l);

    FilledSurface result;
    result.mesh.positions = source.mesh.positions;
    result.mesh.faces = source.mesh.faces;
    std::vector<Cap> caps;
    if (source.in_plane() && stays_open(0)) {
        caps = planar_caps(source, loops);
        result.planar = caps.size() == loops.size();
    }
    if (!result.planar) {
        caps.clear();
        const bool raised = is_planar(source.mesh);
        if (raised && result.mesh.positions.cols() == 2) {
            result.mesh.positions.conservativeResize(Eigen::NoChange, 3);
            result.mesh.positions.col(2).setZero();
        }
        const Positions normals = vertex_normals(source.mesh);
        for (const int l : loops) caps.push_back(intrinsic_cap(source, l, normals, raised));
    }

    Eigen::Index vertices = source.mesh.vertex_count();
    for (const Cap& cap : caps) vertices += cap.added.rows();
    result.mesh.positions.conservativeResize(vertices, Eigen::NoChange);
    int next_vertex = source.mesh.vertex_count();
    for (std::size_t c = 0; c < caps.size(); ++c) {
        const Cap& cap = caps[c];
        const int n = static_cast<int>(cap.rim.size()), added = static_cast<int>(cap.added.rows());
        result.mesh.positions.middleRows(next_vertex, added) = cap.added;
        result.fills.push_back(
            {loops[c], next_vertex, added, result.mesh.face_count(), static_cast<int>(cap.fill.triangles.size())});
        const auto vertex = [&](int i) { return i < n ? cap.rim[i] : next_vertex + i - n; };
        for (const auto& t : cap.fill.triangles) result.mesh.faces.add({vertex(t[0]), vertex(t[1]), vertex(t[2])});
        next_vertex += added;
    }
    if (result.planar) return result;

    Positions corners = source.metric ? *source.metric : corner_positions(source.mesh);
    const Eigen::Index old = corners.rows();
    corners.conservativeResize(result.mesh.faces.corner_count(), Eigen::NoChange);
    corners.bottomRows(corners.rows() - old).setZero();
    Eigen::Index row = old;
    for (std::size_t c = 0; c < caps.size(); ++c) {
        const Cap& cap = caps[c];
        const int n = static_cast<int>(cap.rim.size());
        for (std::size_t t = 0; t < cap.fill.triangles.size(); ++t) {
            std::array<Complex, 3> shape;
            if (cap.corners.empty()) {
                const double side = source.boundary_edge_lengths[loops[c]][(2 * n - 2 - t) % n];
                shape = {0, side, Complex(0.5 * side, std::sqrt(cap.slant * cap.slant - 0.25 * side * side))};
            } else {
                for (int j = 0; j < 3; ++j) {
                    const int i = cap.fill.triangles[t][j];
                    shape[j] = i < n ? cap.corners[i] : cap.fill.added[i - n];
                }
            }
            for (const Complex p : shape) corners.row(row++).head(2) << p.real(), p.imag();
        }
    }
    result.metric = std::move(corners);
    return result;
}

}  // namespace beltrami
