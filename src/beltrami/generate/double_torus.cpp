#include <beltrami/generate/double_torus.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/delaunay.h>

// The planar region where z² ≥ 0, bounded by an ellipse and two circles, is triangulated; two copies of it, lifted to z
// and −z and glued along the boundary, have the right topology. Relaxation and edge flips on the surface then make good
// triangles.

namespace beltrami {
namespace {

constexpr double half_length = 2.0, half_width = 1.2, hole_radius = 0.4, hole_offset = 0.85, height_square = 0.25;
constexpr double planar_share = 0.86;

/// z² − ¼ E C₁ C₂ and its gradient.
struct Level {
    double value;
    Eigen::Vector3d gradient;
};

Level level(const Eigen::Vector3d& p) {
    const Eigen::Vector2d q = p.head<2>();
    std::array<double, 3> factor{1.0 - std::pow(q.x() / half_length, 2) - std::pow(q.y() / half_width, 2), 0.0, 0.0};
    std::array<Eigen::Vector2d, 3> slope{
        Eigen::Vector2d(-2.0 * q.x() / (half_length * half_length), -2.0 * q.y() / (half_width * half_width))};
    for (const int side : {0, 1}) {
        const Eigen::Vector2d d = q - Eigen::Vector2d(side == 0 ? -hole_offset : hole_offset, 0.0);
        const double s = d.squaredNorm();
        factor[side + 1] = 1.0 - hole_radius * hole_radius / s;
        slope[side + 1] = 2.0 * hole_radius * hole_radius / (s * s) * d;
    }
    const Eigen::Vector2d planar =
        slope[0] * factor[1] * factor[2] + slope[1] * factor[0] * factor[2] + slope[2] * factor[0] * factor[1];
    return {p.z() * p.z() - height_square * factor[0] * factor[1] * factor[2],
            {-height_square * planar.x(), -height_square * planar.y(), 2.0 * p.z()}};
}

/// Newton along the gradient.
Eigen::Vector3d onto_surface(Eigen::Vector3d p) {
    for (int step = 0; step < 20; ++step) {
        const Level here = level(p);
        const Eigen::Vector3d shift = here.value / here.gradient.squaredNorm() * here.gradient;
        p -= shift;
        if (shift.norm() < 1e-14) break;
    }
    return p;
}

PlanarDomain shadow(double edge_length) {
    PlanarDomain domain;
    domain.project = [](int curve, const Eigen::Vector2d& p) -> Eigen::Vector2d {
        if (curve == 0) return p / std::hypot(p.x() / half_length, p.y() / half_width);
        const Eigen::Vector2d centre(curve == 1 ? -hole_offset : hole_offset, 0.0);
        return centre + hole_radius * (p - centre).normalized();
    };
    for (const int curve : {0, 1, 2}) {
        const auto place = [&](double t) -> Eigen::Vector2d {
            const double angle = 2.0 * std::numbers::pi * t;
            if (curve == 0) return {half_length * std::cos(angle), half_width * std::sin(angle)};
            const double centre = curve == 1 ? -hole_offset : hole_offset;
            return {centre + hole_radius * std::cos(angle), hole_radius * std::sin(angle)};
        };
        // Speed-weighted size: equal steps of arc length on the ellipse too.
        const std::vector<double> t = spread(
            1.0, [&](double s) { return edge_length / ((place(s + 1e-5) - place(s - 1e-5)).norm() / 2e-5); }, 8);
        const int first = static_cast<int>(domain.points.size()), n = static_cast<int>(t.size()) - 1;
        for (int k = 0; k < n; ++k) {
            domain.points.push_back(place(t[k]));
            domain.segments.push_back({first + k, first + (k + 1) % n});
            domain.curves.push_back(curve);
        }
    }
    return domain;
}

/// Flips every edge whose opposite angles add up to more than π, unless it would double an edge; one round.
/// @return the number of flips
int flip_round(Mesh& mesh) {
    const Topology topo = topology(mesh);
    std::vector<std::array<int, 3>> faces(mesh.face_count());
    for (int f = 0; f < mesh.face_count(); ++f) std::copy_n(mesh.faces[f].begin(), 3, faces[f].begin());
    std::vector<char> touched(mesh.face_count(), 0);
    int flips = 0;
    const auto apex = [&](int face, int a, int b) {
        return *std::find_if(faces[face].begin(), faces[face].end(), [&](int v) { return v != a && v != b; });
    };
    const auto angle = [&](int v, int a, int b) {
        const Eigen::Vector3d p = mesh.point(a) - mesh.point(v), q = mesh.point(b) - mesh.point(v);
        return std::atan2(p.cross(q).norm(), p.dot(q));
    };
    for (int e = 0; e < topo.edge_count(); ++e) {
        const auto& [a, b] = topo.edges[e];
        const auto& [left, right] = topo.edge_faces[e];
        if (touched[left] || touched[right]) continue;
        const int c = apex(left, a, b), d = apex(right, a, b);
        if (angle(c, a, b) + angle(d, a, b) <= std::numbers::pi + 1e-9) continue;
        const std::array<int, 2> other{std::min(c, d), std::max(c, d)};
        if (std::binary_search(topo.edges.begin(), topo.edges.end(), other)) continue;
        faces[left] = {a, d, c};
        faces[right] = {d, b, c};
        touched[left] = touched[right] = 1;
        ++flips;
    }
    mesh.faces = {};
    for (const auto& face : faces) mesh.faces.add(face);
    return flips;
}

/// Moves every vertex to the area-weighted mean of the centres of its faces, and back onto the surface.
void relax(Mesh& mesh) {
    Positions sum = Positions::Zero(mesh.vertex_count(), 3);
    std::vector<double> weight(mesh.vertex_count(), 0.0);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const double area = face_vector_area(mesh, f).norm();
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const int v : mesh.faces[f]) centre += mesh.point(v) / 3.0;
        for (const int v : mesh.faces[f]) {
            sum.row(v) += area * centre.transpose();
            weight[v] += area;
        }
    }
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        mesh.positions.row(v) = onto_surface(sum.row(v).transpose() / weight[v]).transpose();
    }
}

}  // namespace

Mesh double_torus(double edge_length, double scale) {
    if (!(edge_length > 1e-3 && edge_length <= 0.25) || !(scale > 0.0) || !std::isfinite(scale)) {
        throw Error(Cause::bad_option,
                    "a double torus with edges of length " + std::to_string(edge_length) + " is impossible",
                    "give an edge length from 0.001 to 0.25 and a positive scale");
    }
    TriangulateOptions options;
    // Lifting lengthens the edges, by a factor of 1 / planar_share in the mean.
    options.size = [&](const Eigen::Vector2d&) { return planar_share * edge_length; };
    const Mesh sheet = triangulate(shadow(planar_share * edge_length), options);
    const Topology topo = topology(sheet);

    Mesh mesh;
    std::vector<int> below(sheet.vertex_count());
    int count = sheet.vertex_count();
    for (int v = 0; v < sheet.vertex_count(); ++v) below[v] = topo.on_boundary[v] ? v : count++;
    mesh.positions.resize(count, 3);
    for (int v = 0; v < sheet.vertex_count(); ++v) {
        const Eigen::Vector3d flat = sheet.point(v);
        const double z = std::sqrt(std::max(0.0, -level(flat).value));
        mesh.positions.row(v) << flat.x(), flat.y(), topo.on_boundary[v] ? 0.0 : z;
        if (!topo.on_boundary[v]) mesh.positions.row(below[v]) << flat.x(), flat.y(), -z;
    }
    for (int f = 0; f < sheet.face_count(); ++f) mesh.faces.add(sheet.faces[f]);
    for (int f = 0; f < sheet.face_count(); ++f) {
        const std::span<const int> v = sheet.faces[f];
        mesh.faces.add({below[v[0]], below[v[2]], below[v[1]]});
    }
    // Relaxation carries density over about one edge a round.
    const int rounds = std::max(40, static_cast<int>(2.0 / edge_length));
    for (int round = 0; round < rounds; ++round) {
        relax(mesh);
        while (flip_round(mesh) > mesh.face_count() / 1000) {
        }
    }
    mesh.positions *= scale;
    return mesh;
}

}  // namespace beltrami
