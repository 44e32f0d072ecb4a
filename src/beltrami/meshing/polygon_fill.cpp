#include <beltrami/meshing/polygon_fill.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/mesh/edge_table.h>
#include <beltrami/meshing/delaunay.h>

namespace beltrami {

namespace {

constexpr double kGrading = 0.5;  // growth of the edges per distance from the sides
constexpr double kSlack = 1.4;    // edges at a side may be so much longer than it: sides are not to be split
constexpr double kFrameDigits = 1 << 30;
constexpr double kClearance = 0.4;  // an added vertex keeps this part of a side's length away from it

double distance(Complex p, Complex a, Complex b) {
    const double t = std::real(std::conj(b - a) * (p - a)) / std::norm(b - a);
    return std::abs(p - (a + std::clamp(t, 0.0, 1.0) * (b - a)));
}

PlanarDomain domain_of(const std::vector<Complex>& corners, const std::vector<Complex>& inner) {
    PlanarDomain domain;
    const int n = static_cast<int>(corners.size());
    for (const Complex z : corners) domain.points.emplace_back(z.real(), z.imag());
    for (int i = 0; i < n; ++i) {
        domain.segments.push_back({i, (i + 1) % n});
        domain.curves.push_back(i);
    }
    for (const Complex z : inner) domain.points.emplace_back(z.real(), z.imag());
    return domain;
}

/// Vertices for the inside: those of a refined triangulation, which may split sides, away from the sides.
std::vector<Complex> inner_points(const std::vector<Complex>& corners) {
    const std::size_t n = corners.size();
    const auto for_sides = [&](Complex p, const auto& body) {
        for (std::size_t i = 0; i < n; ++i) {
            const Complex a = corners[i], b = corners[i + 1 < n ? i + 1 : 0];
            body(std::abs(b - a), distance(p, a, b));
        }
    };
    TriangulateOptions options;
    options.min_angle = 0.35;
    options.smoothing_passes = 2;
    options.split_ears = false;
    std::vector<std::pair<Complex, double>> sides;  // middle and the size there
    for_sides(0, [&](double length, double) { sides.emplace_back(0.0, kSlack * length); });
    for (std::size_t i = 0; i < n; ++i) sides[i].first = 0.5 * (corners[i] + corners[i + 1 < n ? i + 1 : 0]);
    options.size = [&](const Eigen::Vector2d& p) {
        double size = std::numeric_limits<double>::infinity();
        for (const auto& [middle, at_side] : sides) {
            const double reach = (size - at_side) / kGrading;  // the side matters within this distance
            const double dx = p.x() - middle.real(), dy = p.y() - middle.imag(), square = dx * dx + dy * dy;
            if (reach > 0 && square < reach * reach) size = at_side + kGrading * std::sqrt(square);
        }
        return size;
    };
    const Mesh refined = triangulate(domain_of(corners, {}), options);
    std::vector<Complex> inner;
    for (int v = static_cast<int>(n); v < refined.vertex_count(); ++v) {
        const Complex p(refined.positions(v, 0), refined.positions(v, 1));
        bool clear = true;
        for_sides(p, [&](double length, double d) { clear = clear && d > kClearance * length; });
        if (clear) inner.push_back(p);
    }
    return inner;
}

/// Puts a vertex on the middle of every chord.
void split_chords(const std::vector<Complex>& corners, PolygonFill& fill) {
    const int n = static_cast<int>(corners.size());
    FaceList faces;
    for (const auto& t : fill.triangles) faces.add({t[0], t[1], t[2]});
    const EdgeTable table = edge_table(faces, n + static_cast<int>(fill.added.size()));
    std::vector<int> middle(table.edge_count(), -1);
    bool any = false;
    for (int e = 0; e < table.edge_count(); ++e) {
        const auto [a, b] = table.edges[e];
        if (b >= n || table.corners_of(e).size() < 2) continue;
        any = true;
        middle[e] = n + static_cast<int>(fill.added.size());
        fill.added.push_back(0.5 * (corners[a] + corners[b]));
    }
    if (!any) return;
    std::vector<std::array<int, 3>> triangles;
    for (int f = 0; f < faces.size(); ++f) {
        // The triangle with its split sides as a polygon, cut into triangles.
        std::vector<int> ring;
        std::vector<int> middles;
        for (int j = 0; j < 3; ++j) {
            ring.push_back(faces[f][j]);
            const int m = middle[table.corner_edges[3 * f + j]];
            if (m < 0) continue;
            middles.push_back(static_cast<int>(ring.size()));
            ring.push_back(m);
        }
        const int size = static_cast<int>(ring.size());
        const auto at = [&](int i) { return ring[(i + size) % size]; };
        if (middles.empty()) {
            triangles.push_back({ring[0], ring[1], ring[2]});
        } else if (middles.size() == 1) {
            const int m = middles[0];
            triangles.push_back({at(m), at(m + 1), at(m + 2)});
            triangles.push_back({at(m), at(m + 2), at(m + 3)});
        } else if (middles.size() == 2) {
            // The corner between the two middles is cut off; the rest is a quad.
            const int m = middles[1] - middles[0] == 2 ? middles[0] : middles[1];
            triangles.push_back({at(m), at(m + 1), at(m + 2)});
            triangles.push_back({at(m), at(m + 2), at(m + 3)});
            triangles.push_back({at(m), at(m + 3), at(m + 4)});
        } else {
            triangles.push_back({ring[1], ring[2], ring[3]});
            triangles.push_back({ring[3], ring[4], ring[5]});
            triangles.push_back({ring[5], ring[0], ring[1]});
            triangles.push_back({ring[1], ring[3], ring[5]});
        }
    }
    fill.triangles = std::move(triangles);
}

}  // namespace

PolygonFill fill_polygon(const std::vector<Complex>& corners) {
    if (corners.size() == 3) return {{}, {{0, 1, 2}}};
    // In a frame of its own, where rounding is cut off: many corners of a hole lie on one circle, and which triangles
    // are Delaunay there is not to depend on the polygon's place, size or direction.
    Complex middle = 0;
    for (const Complex z : corners) middle += z / static_cast<double>(corners.size());
    Complex axis = corners[0] - middle;
    double scale = 0;
    for (const Complex z : corners) scale = std::max(scale, std::abs(z - middle));
    if (std::abs(axis) < 0.1 * scale) axis = scale;
    std::vector<Complex> scaled;
    for (const Complex z : corners) {
        const Complex p = (z - middle) / axis;
        scaled.emplace_back(std::round(p.real() * kFrameDigits) / kFrameDigits,
                            std::round(p.imag() * kFrameDigits) / kFrameDigits);
    }

    PolygonFill fill;
    fill.added = inner_points(scaled);
    TriangulateOptions plain;
    plain.min_angle = 0;
    plain.smoothing_passes = 0;
    plain.split_ears = false;
    const Mesh mesh = triangulate(domain_of(scaled, fill.added), plain);
    for (int f = 0; f < mesh.face_count(); ++f)
        fill.triangles.push_back({mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]});
    split_chords(scaled, fill);
    for (Complex& z : fill.added) z = middle + axis * z;
    return fill;
}

std::vector<Complex> cyclic_polygon(const std::vector<double>& lengths) {
    double longest = 0, total = 0;
    for (const double length : lengths) {
        longest = std::max(longest, length);
        total += length;
    }
    const auto turn = [&](double radius) {  // half the angle that the sides subtend at the centre
        double sum = 0;
        for (const double length : lengths) sum += std::asin(std::min(1.0, 0.5 * length / radius));
        return sum;
    };
    double low = 0.5 * longest, high = total;
    if (!(turn(low) > std::numbers::pi)) return {};
    for (int step = 0; step < 100 && high - low > 1e-16 * high; ++step) {
        const double radius = 0.5 * (low + high);
        (turn(radius) > std::numbers::pi ? low : high) = radius;
    }
    const double radius = 0.5 * (low + high);
    std::vector<Complex> corners;
    double angle = 0;
    for (const double length : lengths) {
        corners.push_back(std::polar(radius, angle));
        angle += 2 * std::asin(std::min(1.0, 0.5 * length / radius));
    }
    return corners;
}

}  // namespace beltrami
