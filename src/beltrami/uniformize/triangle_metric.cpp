#include <beltrami/uniformize/triangle_metric.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/quad_split.h>

namespace beltrami {

namespace {

constexpr double kSmallestSlack = 1e-14;        // of a triangle's longest side: below, it has no area
constexpr double kSlackGiven = 1e-10;           // of the mean length
constexpr double kLargestContradiction = 1e-4;  // of a triangle's longest side, by which the inequality may fail

}  // namespace

TriangleMetric triangle_metric(const Mesh& surface, const Topology& shape, const Positions& corners) {
    const auto point = [&](int corner) { return corner_point(corners, corner); };
    std::vector<double> edge_lengths(shape.edges.size(), -1);
    for (int f = 0; f < surface.face_count(); ++f) {
        const int first = surface.faces.first_corner(f), n = surface.faces.degree(f);
        for (int i = 0; i < n; ++i) {
            const double length = (point(first + (i + 1) % n) - point(first + i)).stableNorm();
            double& known = edge_lengths[shape.corner_edges[first + i]];
            known = known < 0 ? length : std::midpoint(known, length);  // an edge has two faces at most
        }
    }

    TriangleMetric metric;
    metric.triangles.reserve(2 * surface.face_count(), 6 * surface.face_count());
    std::vector<double> lengths;
    std::vector<int>& triangle_faces = metric.faces;
    lengths.reserve(static_cast<std::size_t>(6) * surface.face_count());
    for (int f = 0; f < surface.face_count(); ++f) {
        const std::span<const int> v = surface.faces[f];
        const int first = surface.faces.first_corner(f), n = surface.faces.degree(f);
        const auto add = [&](const std::array<int, 3>& triangle) {
            metric.triangles.add({v[triangle[0]], v[triangle[1]], v[triangle[2]]});
            triangle_faces.push_back(f);
            for (int k = 0; k < 3; ++k) {
                const int from = triangle[k], to = triangle[(k + 1) % 3];
                lengths.push_back(to == (from + 1) % n ? edge_lengths[shape.corner_edges[first + from]]
                                                       : (point(first + to) - point(first + from)).stableNorm());
            }
        };
        if (n == 3) {
            add({0, 1, 2});
        } else {
            for (const auto& half : split_quad({point(first), point(first + 1), point(first + 2), point(first + 3)}))
                add(half);
        }
    }

    double mean = 0, missing = 0;
    for (const double length : lengths) mean += length;
    mean /= static_cast<double>(lengths.size());
    if (!(mean > 0) || !std::isfinite(mean))
        throw Error(Cause::bad_mesh, "the surface has no size", "all corners of its faces coincide");
    std::vector<int> broken;
    for (std::size_t t = 0; t < triangle_faces.size(); ++t) {
        const double a = lengths[3 * t], b = lengths[3 * t + 1], c = lengths[3 * t + 2];
        const double longest = std::max({a, b, c});
        const double slack = (a + b + c) - 2 * longest;
        if (slack < -kLargestContradiction * longest && (broken.empty() || broken.back() != triangle_faces[t]))
            broken.push_back(triangle_faces[t]);
        if (!(slack > kSmallestSlack * longest)) missing = std::max(missing, kSlackGiven * mean - slack);
    }
    if (!broken.empty()) {
        const std::string sentence =
            "the metric gives face " + std::to_string(broken[0]) +
            (broken.size() > 1 ? " and " + std::to_string(broken.size() - 1) + " more" : "") +
            " edges so unlike those of the neighbours that the mean lengths violate the triangle inequality";
        throw Error(Cause::bad_mesh, sentence, "bring faces that share an edge to the same scale",
                    {Things::faces, std::move(broken)});
    }
    metric.lengthened = missing;
    metric.log_unit = std::log(mean);
    metric.log_lengths.resize(lengths.size());
    for (std::size_t c = 0; c < lengths.size(); ++c)
        metric.log_lengths[c] = std::log((lengths[c] + metric.lengthened) / mean);
    return metric;
}

}  // namespace beltrami
