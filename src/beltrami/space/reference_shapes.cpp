#include <beltrami/space/reference_shapes.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {

namespace {

constexpr double kAngleTolerance = 1e-6;    // of the sum of a face's angles, radians
constexpr double kLargestKept = 0.9 * kPi;  // a corner has to stay one

double angle_sum(int degree) {
    return (degree - 2) * kPi;
}

/// Of a regular polygon with side 1.
double regular_area(int degree) {
    return degree / (4 * std::tan(kPi / degree));
}

/// The polygon around a circle with these angles: its edges are cot(α/2) + cot(β/2) long.
void tangential_polygon(const double* angles, int n, Complex* points) {
    double direction = 0;
    points[0] = 0;
    for (int j = 0; j + 1 < n; ++j) {
        const double length = 1 / std::tan(angles[j] / 2) + 1 / std::tan(angles[j + 1] / 2);
        points[j + 1] = points[j] + std::polar(length, direction);
        direction += kPi - angles[j + 1];
    }
}

double polygon_area(const Complex* points, int n) {
    double area = 0;
    for (int j = 0; j < n; ++j) area += 0.5 * std::imag(std::conj(points[j]) * points[(j + 1) % n]);
    return area;
}

/// Angles that a face's vertices want, changed so that they add up to what those of a face do.
void balance(double* angles, int n) {
    const double total = angle_sum(n), sum = std::accumulate(angles, angles + n, 0.0);
    const double* const largest = std::max_element(angles, angles + n);
    const bool alone = std::count_if(angles, angles + n, [&](double a) { return a > *largest - 1e-12; }) == 1;
    double kept = alone && *largest < kLargestKept ? *largest : *largest * total / sum;
    if (alone) kept = std::min(kept, kLargestKept);
    const double others = alone ? (total - kept) / (sum - *largest) : total / sum;
    for (int j = 0; j < n; ++j) angles[j] = alone && angles + j == largest ? kept : others * angles[j];
}

}  // namespace

Positions regular_shapes(const FaceList& faces) {
    Positions corners(faces.corner_count(), 2);
    for (int f = 0, c = 0; f < faces.size(); ++f) {
        Complex point = 0;
        for (int j = 0; j < faces.degree(f); ++j, ++c) {
            corners.row(c) << point.real(), point.imag();
            point += std::polar(1.0, 2 * kPi * j / faces.degree(f));
        }
    }
    return corners;
}

Positions valence_shapes(const Mesh& mesh) {
    const Topology combinatorics = topology(mesh);
    std::vector<int> valence(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const int v : mesh.faces.vertices()) ++valence[v];
    Eigen::VectorXd angles(mesh.faces.corner_count());
    for (int f = 0; f < mesh.face_count(); ++f) {
        double* const first = angles.data() + mesh.faces.first_corner(f);
        const auto vertices = mesh.faces[f];
        for (std::size_t j = 0; j < vertices.size(); ++j)
            first[j] = (combinatorics.on_boundary[vertices[j]] ? kPi : 2 * kPi) / valence[vertices[j]];
        balance(first, static_cast<int>(vertices.size()));
    }
    return shapes_from_angles(mesh.faces, angles);
}

Positions shapes_from_angles(const FaceList& faces, const Eigen::VectorXd& angles) {
    if (angles.size() != faces.corner_count())
        throw Error(Cause::bad_option, "there are " + std::to_string(angles.size()) + " angles for " +
                                           std::to_string(faces.corner_count()) + " corners");
    std::vector<int> bad;
    Positions corners(faces.corner_count(), 2);
    std::vector<Complex> points;
    for (int f = 0; f < faces.size(); ++f) {
        const int n = faces.degree(f), first = faces.first_corner(f);
        const auto own = angles.segment(first, n);
        if (!((own.array() > 0).all() && (own.array() < kPi).all() &&
              std::abs(own.sum() - angle_sum(n)) < kAngleTolerance)) {
            bad.push_back(f);
            continue;
        }
        points.resize(static_cast<std::size_t>(n));
        tangential_polygon(own.data(), n, points.data());
        const double scale = std::sqrt(regular_area(n) / polygon_area(points.data(), n));
        for (int j = 0; j < n; ++j) corners.row(first + j) << scale * points[j].real(), scale * points[j].imag();
    }
    if (!bad.empty()) {
        const std::string sentence =
            "the angles of face " + std::to_string(bad[0]) + " are not those of a convex polygon";
        throw Error(Cause::bad_option, sentence, "those of a triangle add up to 180 degrees, of a quad to 360",
                    {Things::faces, std::move(bad)});
    }
    return corners;
}

}  // namespace beltrami
