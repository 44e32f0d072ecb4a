#include <beltrami/space/corner_elements.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/mesh/planar.h>

namespace beltrami {

namespace {

using Vector3 = Eigen::Vector3d;

/// Corner triangles that stand for a polygon: one for a triangle, whose three are the same.
int corner_triangles(int degree) {
    return degree == 3 ? 1 : degree;
}

/// Part of the area of a corner triangle with which it counts: all of them together cover a regular polygon once.
double corner_weight(int degree) {
    if (degree == 3) return 1;
    const double sine = std::sin(std::numbers::pi / degree);
    return 1 / (4 * sine * sine);
}

/// The element's real axis, not normalised.
template <class Point>
Vector3 element_axis(int degree, const Point& point) {
    Vector3 axis = Vector3::Zero();
    for (int j = 0; j < degree; ++j) {
        // The regular polygon with its first edge below and horizontal.
        const double angle = std::numbers::pi * (2.0 * j - 1) / degree - std::numbers::pi / 2;
        axis += std::cos(angle) * point(j);
    }
    return axis;
}

template <class Point>
Vector3 vector_area(int degree, const Point& point) {
    Vector3 area = Vector3::Zero();
    for (int j = 1; j + 1 < degree; ++j) area += (point(j) - point(0)).cross(point(j + 1) - point(0));
    return area;
}

struct Builder {
    CornerElements result;
    std::vector<int> bad;

    explicit Builder(const Mesh& mesh) {
        result.operators.vertex_count = mesh.vertex_count();
        result.operators.face_count = mesh.face_count();
        result.edge_direction.resize(mesh.faces.corner_count());
    }

    /// @param axis of the frame, zero for the element's own
    template <class Point>
    void add(const Mesh& mesh, int face, const Point& point, Vector3 axis) {
        const auto vertices = mesh.faces[face];
        const int n = static_cast<int>(vertices.size()), first = mesh.faces.first_corner(face);
        if (axis.isZero()) axis = element_axis(n, point);
        const Vector3 up = vector_area(n, point).normalized();
        const Vector3 r = (axis - axis.dot(up) * up).normalized(), t = up.cross(r);
        for (int j = 0; j < n; ++j) {
            const Vector3 edge = point((j + 1) % n) - point(j);
            const Complex z(edge.dot(r), edge.dot(t));
            result.edge_direction[first + j] = z / std::abs(z);
        }
        for (int j = 0; j < corner_triangles(n); ++j) {
            const std::array<int, 3> at{j, (j + 1) % n, (j + n - 1) % n};
            triangle(face, {vertices[at[0]], vertices[at[1]], vertices[at[2]]}, point(at[1]) - point(at[0]),
                     point(at[2]) - point(at[0]), axis, up, corner_weight(n));
        }
    }

    CornerElements finish() {
        if (bad.empty()) return std::move(result);
        const std::string sentence =
            "face " + std::to_string(bad[0]) +
            (bad.size() > 1 ? " and " + std::to_string(bad.size() - 1) + " more have" : " has") +
            " a corner triangle without positive area";
        throw Error(Cause::bad_mesh, sentence, "remove zero-area faces, split reflex quads, turn folded faces over",
                    {Things::faces, std::move(bad)});
    }

  private:
    /// The triangle with edges u, v from its first corner.
    void triangle(int face, const std::array<int, 3>& vertices, const Vector3& u, const Vector3& v, const Vector3& axis,
                  const Vector3& up, double weight) {
        Operators& operators = result.operators;
        const Vector3 normal = u.cross(v);
        const double twice = normal.norm();
        if (!(twice > 0) || !(normal.dot(up) > 0)) {
            if (bad.empty() || bad.back() != face) bad.push_back(face);
        }
        const Vector3 n = normal / twice, e1 = (axis - axis.dot(n) * n).normalized(), e2 = n.cross(e1);
        const Complex zu(u.dot(e1), u.dot(e2)), zv(v.dot(e1), v.dot(e2)), factor(0, 1 / twice);
        operators.vertices.insert(operators.vertices.end(), vertices.begin(), vertices.end());
        operators.gradients.insert(operators.gradients.end(), {factor * (zv - zu), -factor * zv, factor * zu});
        operators.offsets.push_back(static_cast<int>(operators.vertices.size()));
        operators.weights.push_back(0.5 * twice * weight);
        operators.faces.push_back(face);
    }
};

}  // namespace

CornerElements corner_elements(const Mesh& mesh) {
    Builder builder(mesh);
    if (!is_planar(mesh)) return corner_elements(mesh, corner_positions(mesh));
    const Eigen::VectorXcd z = planar_coordinates(mesh);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto point = [&](int j) {
            const Complex at = z[mesh.faces[f][j]];
            return Vector3(at.real(), at.imag(), 0);
        };
        builder.add(mesh, f, point, Vector3::UnitX());
    }
    return builder.finish();
}

CornerElements corner_elements(const Mesh& mesh, const Positions& corners) {
    Builder builder(mesh);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const int first = mesh.faces.first_corner(f);
        const auto point = [&](int j) {
            return Vector3(corners(first + j, 0), corners(first + j, 1),
                           corners.cols() > 2 ? corners(first + j, 2) : 0.0);
        };
        builder.add(mesh, f, point, Vector3::Zero());
    }
    return builder.finish();
}

Positions corner_normals(const Mesh& mesh) {
    int samples = 0;
    for (int f = 0; f < mesh.face_count(); ++f) samples += corner_triangles(mesh.faces.degree(f));
    Positions normals(samples, 3);
    for (int f = 0, s = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        const int n = static_cast<int>(v.size());
        for (int j = 0; j < corner_triangles(n); ++j, ++s) {
            const Vector3 at = mesh.point(v[j]);
            const Vector3 normal = (mesh.point(v[(j + 1) % n]) - at).cross(mesh.point(v[(j + n - 1) % n]) - at);
            normals.row(s) = normal.normalized();  // Eigen leaves a zero vector as it is
        }
    }
    return normals;
}

Eigen::VectorXcd face_means(const Operators& operators, const Eigen::VectorXcd& samples) {
    Eigen::VectorXcd sums = Eigen::VectorXcd::Zero(operators.face_count);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(operators.face_count);
    for (int s = 0; s < operators.sample_count(); ++s) {
        sums[operators.faces[s]] += operators.weights[s] * samples[s];
        weights[operators.faces[s]] += operators.weights[s];
    }
    return sums.array() / weights.array();
}

Eigen::VectorXcd face_values_at_samples(const Operators& operators, const Eigen::VectorXcd& faces) {
    Eigen::VectorXcd samples(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) samples[s] = faces[operators.faces[s]];
    return samples;
}

}  // namespace beltrami
