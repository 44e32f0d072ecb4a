#include <beltrami/operators/operators.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/face_areas.h>

namespace beltrami {

namespace {

using Vector3 = Eigen::Vector3d;

/// Gauss points of the 2×2 rule on [−1,1]², in the order of the corners.
constexpr double kGauss = 0.57735026918962576451;
constexpr double kCorner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

struct Builder {
    Operators result;
    std::vector<int> bad_faces;

    Builder(const Mesh& mesh) {
        result.vertex_count = mesh.vertex_count();
        result.face_count = mesh.face_count();
        result.vertices.reserve(mesh.faces.corner_count());
        result.gradients.reserve(mesh.faces.corner_count());
        result.weights.reserve(mesh.face_count());
        result.faces.reserve(mesh.face_count());
        result.offsets.reserve(mesh.face_count() + 1);
    }

    /// A triangle from its corners in a complex frame.
    void triangle(int face, std::span<const int> vertices, Complex z0, Complex z1, Complex z2) {
        const double area = 0.5 * std::imag(std::conj(z1 - z0) * (z2 - z0));
        if (!(area > 0)) bad_faces.push_back(face);
        const Complex factor(0, 0.5 / area);  // i / 2A
        const Complex gradients[3] = {factor * (z2 - z1), factor * (z0 - z2), factor * (z1 - z0)};
        add(face, vertices, gradients, area);
    }

    /// A quad from its corners in space (z = 0 in the plane); frame_axis is the real axis of its samples, projected.
    /// up ≠ 0 demands that the samples' normals agree with it.
    void quad(int face, std::span<const int> vertices, const Vector3 (&p)[4], const Vector3& frame_axis,
              const Vector3& up) {
        for (const auto& at : kCorner) {
            const double xi = kGauss * at[0], eta = kGauss * at[1];
            double n_xi[4], n_eta[4];
            Vector3 a = Vector3::Zero(), b = Vector3::Zero();
            for (int j = 0; j < 4; ++j) {
                n_xi[j] = 0.25 * kCorner[j][0] * (1 + kCorner[j][1] * eta);
                n_eta[j] = 0.25 * kCorner[j][1] * (1 + kCorner[j][0] * xi);
                a += n_xi[j] * p[j];
                b += n_eta[j] * p[j];
            }
            const Vector3 normal = a.cross(b);
            const double area = normal.norm();  // each Gauss point has weight 1 on [−1,1]²
            if (!(area > 0) || normal.dot(up) <= 0) {
                bad_faces.push_back(face);
            }
            const Vector3 n = normal / area;
            const Vector3 e1 = (frame_axis - frame_axis.dot(n) * n).normalized(), e2 = n.cross(e1);
            const Complex za(a.dot(e1), a.dot(e2)), zb(b.dot(e1), b.dot(e2));
            const Complex factor(0, 1 / area);
            Complex gradients[4];
            for (int j = 0; j < 4; ++j) gradients[j] = factor * (n_eta[j] * za - n_xi[j] * zb);
            add(face, vertices, gradients, area);
        }
    }

    std::vector<int> without_area() {
        bad_faces.erase(std::unique(bad_faces.begin(), bad_faces.end()), bad_faces.end());
        return bad_faces;
    }

    Operators finish() {
        if (!bad_faces.empty()) {
            without_area();
            const std::string sentence =
                "face " + std::to_string(bad_faces[0]) +
                (bad_faces.size() > 1 ? " and " + std::to_string(bad_faces.size() - 1) + " more have" : " has") +
                " no positive area in the metric";
            throw Error(Cause::bad_mesh, sentence, "remove zero-area faces, split reflex quads, turn folded faces over",
                        {Things::faces, std::move(bad_faces)});
        }
        return std::move(result);
    }

  private:
    template <std::size_t N>
    void add(int face, std::span<const int> vertices, const Complex (&gradients)[N], double area) {
        result.vertices.insert(result.vertices.end(), vertices.begin(), vertices.end());
        result.gradients.insert(result.gradients.end(), gradients, gradients + N);
        result.offsets.push_back(static_cast<int>(result.vertices.size()));
        result.weights.push_back(area);
        result.faces.push_back(face);
    }
};

/// Corners of a triangle of space, laid out with the first edge on the real axis.
void lay_out(Builder& builder, int face, std::span<const int> vertices, const Vector3& a, const Vector3& b,
             const Vector3& c) {
    const Vector3 u = b - a, v = c - a;
    const double length = u.norm();
    builder.triangle(face, vertices, 0.0, length, Complex(u.dot(v), u.cross(v).norm()) / length);
}

template <class PointOfCorner>
Builder from_corner_points(const Mesh& mesh, PointOfCorner&& point) {
    Builder builder(mesh);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto vertices = mesh.faces[f];
        const int c = mesh.faces.first_corner(f);
        if (vertices.size() == 3) {
            lay_out(builder, f, vertices, point(c), point(c + 1), point(c + 2));
        } else {
            const Vector3 p[4] = {point(c), point(c + 1), point(c + 2), point(c + 3)};
            builder.quad(f, vertices, p, p[1] - p[0], (p[2] - p[0]).cross(p[3] - p[1]));
        }
    }
    return builder;
}

Builder planar_builder(const Mesh& mesh) {
    Builder builder(mesh);
    const Eigen::VectorXcd z = planar_coordinates(mesh);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        if (v.size() == 3) {
            builder.triangle(f, v, z[v[0]], z[v[1]], z[v[2]]);
        } else {
            Vector3 p[4];
            for (int j = 0; j < 4; ++j) p[j] = {z[v[j]].real(), z[v[j]].imag(), 0};
            builder.quad(f, v, p, Vector3::UnitX(), Vector3::UnitZ());
        }
    }
    return builder;
}

Builder builder_of(const Mesh& mesh) {
    if (is_planar(mesh)) return planar_builder(mesh);
    return from_corner_points(mesh, [&](int corner) { return mesh.point(mesh.faces.vertices()[corner]); });
}

}  // namespace

double Operators::area() const {
    double sum = 0;
    for (const double w : weights) sum += w;
    return sum;
}

Operators::Matrix Operators::d_zbar() const {
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(vertices.size());
    for (int s = 0; s < sample_count(); ++s)
        for (int j = offsets[s]; j < offsets[s + 1]; ++j) entries.emplace_back(s, vertices[j], 0.5 * gradients[j]);
    Matrix matrix(sample_count(), vertex_count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Operators::Matrix Operators::d_z() const {
    return d_zbar().conjugate();
}

Operators operators(const Mesh& mesh) {
    return builder_of(mesh).finish();
}

std::vector<int> faces_without_area(const Mesh& mesh) {
    return builder_of(mesh).without_area();
}

Operators operators_from_corners(const Mesh& mesh, const Positions& corners) {
    return from_corner_points(
               mesh,
               [&](int corner) -> Vector3 {
                   return {corners(corner, 0), corners(corner, 1), corners.cols() > 2 ? corners(corner, 2) : 0.0};
               })
        .finish();
}

Positions corners_from_lengths(const Mesh& mesh, std::span<const EdgeLength> lengths) {
    const Topology top = topology(mesh);
    std::vector<double> edge_length(top.edge_count(), -1.0);
    for (const auto& [a, b, length] : lengths) {
        const std::array<int, 2> key{std::min(a, b), std::max(a, b)};
        const auto it = std::lower_bound(top.edges.begin(), top.edges.end(), key);
        const std::string name = std::to_string(a) + " " + std::to_string(b);
        if (it == top.edges.end() || *it != key)
            throw Error(Cause::bad_mesh, "the metric names " + name + ", which is not an edge of the mesh",
                        "give one line per edge: i j length", {Things::edges, {a, b}});
        if (!(length > 0) || !std::isfinite(length))
            throw Error(Cause::bad_mesh, "the metric gives edge " + name + " a length that is not positive",
                        "lengths are positive numbers", {Things::edges, {a, b}});
        double& slot = edge_length[it - top.edges.begin()];
        if (slot >= 0)
            throw Error(Cause::bad_mesh, "the metric names edge " + name + " twice", "give one line per edge",
                        {Things::edges, {a, b}});
        slot = length;
    }
    for (int e = 0; e < top.edge_count(); ++e)
        if (edge_length[e] < 0)
            throw Error(Cause::bad_mesh,
                        "the metric gives no length for edge " + std::to_string(top.edges[e][0]) + " " +
                            std::to_string(top.edges[e][1]),
                        "give one line per edge: i j length", {Things::edges, {top.edges[e][0], top.edges[e][1]}});
    Positions corners = Positions::Zero(mesh.faces.corner_count(), 2);
    for (int f = 0; f < mesh.face_count(); ++f) {
        if (mesh.faces.degree(f) != 3)
            throw Error(Cause::bad_mesh,
                        "face " + std::to_string(f) + " is a quad, whose shape edge lengths do not determine",
                        "split the quads, or give the metric as texture coordinates", {Things::faces, {f}});
        const int c = mesh.faces.first_corner(f);
        const double l01 = edge_length[top.corner_edges[c]], l12 = edge_length[top.corner_edges[c + 1]],
                     l20 = edge_length[top.corner_edges[c + 2]];
        // Heron's formula in Kahan's order: stable for needles.
        double s[3] = {l01, l12, l20};
        std::sort(s, s + 3, std::greater<>());
        const double heron =
            (s[0] + (s[1] + s[2])) * (s[2] - (s[0] - s[1])) * (s[2] + (s[0] - s[1])) * (s[0] + (s[1] - s[2]));
        if (!(heron > 0))
            throw Error(Cause::bad_mesh,
                        "the lengths of face " + std::to_string(f) + " violate the triangle inequality",
                        "check the metric of its three edges", {Things::faces, {f}});
        const double x = (l01 * l01 + l20 * l20 - l12 * l12) / (2 * l01), height = 0.5 * std::sqrt(heron) / l01;
        corners(c + 1, 0) = l01;
        corners.row(c + 2) << x, height;
    }
    return corners;
}

Operators per_corner(const Operators& operators, const FaceList& faces) {
    Operators result = operators;
    result.vertex_count = faces.corner_count();
    for (int s = 0; s < result.sample_count(); ++s) {
        const auto face = faces[result.faces[s]];
        const int first = faces.first_corner(result.faces[s]);
        for (int j = result.offsets[s]; j < result.offsets[s + 1]; ++j)
            result.vertices[j] =
                first + static_cast<int>(std::find(face.begin(), face.end(), result.vertices[j]) - face.begin());
    }
    return result;
}

Eigen::VectorXd vertex_areas(const Operators& operators) {
    Eigen::VectorXd area = Eigen::VectorXd::Zero(operators.vertex_count);
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto stencil = operators.stencil(s);
        for (const int v : stencil) area[v] += operators.weights[s] / static_cast<double>(stencil.size());
    }
    return area;
}

Positions texture_corners(const Mesh& mesh) {
    if (!mesh.texture)
        throw Error(Cause::bad_mesh, "the mesh has no texture coordinates", "give a file with vt, or another map");
    Positions corners(mesh.faces.corner_count(), 2);
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int c = mesh.faces.offsets()[f]; c < mesh.faces.offsets()[f + 1]; ++c) {
            const int t = mesh.texture->corners[c];
            if (t < 0)
                throw Error(Cause::bad_mesh, "face " + std::to_string(f) + " has a corner without texture coordinates",
                            "every face needs vt", {Things::faces, {f}});
            corners.row(c) = mesh.texture->points.row(t).head(2);
            if (!corners.row(c).allFinite())
                throw Error(Cause::bad_mesh,
                            "face " + std::to_string(f) + " has texture coordinates that are not finite",
                            "repair the vt of its corners", {Things::faces, {f}});
        }
    return corners;
}

}  // namespace beltrami
