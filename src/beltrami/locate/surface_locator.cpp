#include <beltrami/locate/surface_locator.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include <beltrami/locate/nearest_on_triangle.h>
#include <beltrami/mesh/quad_split.h>

namespace beltrami {

namespace {

/// A leaf holds no more triangles.
constexpr int kLeaf = 4;

double squared_distance(const std::array<Eigen::Array3d, 2>& box, const Eigen::Vector3d& point) {
    return (box[0] - point.array()).max(point.array() - box[1]).max(0.0).square().sum();
}

}  // namespace

SurfaceLocator::SurfaceLocator(const Positions& positions, std::vector<std::array<int, 3>> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
    points_.reserve(static_cast<std::size_t>(positions.rows()));
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
        points_.emplace_back(positions(v, 0), positions(v, 1), positions.cols() > 2 ? positions(v, 2) : 0.0);
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(order_.size());
    build(0, static_cast<int>(order_.size()));
}

SurfaceLocator::Box SurfaceLocator::box_of(int triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    return {points_[a].cwiseMin(points_[b]).cwiseMin(points_[c]).array(),
            points_[a].cwiseMax(points_[b]).cwiseMax(points_[c]).array()};
}

void SurfaceLocator::build(int first, int last) {
    const std::size_t node = nodes_.size();
    Box box = box_of(order_[first]);
    for (int i = first + 1; i < last; ++i) {
        const Box other = box_of(order_[i]);
        box = {box[0].min(other[0]), box[1].max(other[1])};
    }
    nodes_.push_back({box, first, last});
    if (last - first <= kLeaf) return;
    Eigen::Index axis = 0;
    (box[1] - box[0]).maxCoeff(&axis);
    const auto centre = [&](int t) {
        const auto& [a, b, c] = triangles_[t];
        return points_[a][axis] + points_[b][axis] + points_[c][axis];
    };
    const int middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](int s, int t) { return centre(s) != centre(t) ? centre(s) < centre(t) : s < t; });
    build(first, middle);
    nodes_[node].right = static_cast<int>(nodes_.size());
    build(middle, last);
}

SurfaceLocator::Place SurfaceLocator::on_triangle(int triangle, const Eigen::Vector3d& point) const {
    const auto& [a, b, c] = triangles_[triangle];
    const std::array<double, 3> weights = nearest_weights(point, points_[a], points_[b], points_[c]);
    const Eigen::Vector3d there = weights[0] * points_[a] + weights[1] * points_[b] + weights[2] * points_[c];
    return {triangle, weights, (there - point).norm()};
}

SurfaceLocator::Place SurfaceLocator::nearest(const Eigen::Vector3d& point, int guess) const {
    Place best;
    best.distance = std::numeric_limits<double>::infinity();
    if (guess >= 0) best = on_triangle(guess, point);
    // The distance of a node's box is known where it is put aside.
    struct Aside {
        int node;
        double square;
    };
    Aside stack[128];
    int depth = 0;
    stack[depth++] = {0, 0};
    while (depth) {
        const auto [at, square] = stack[--depth];
        if (square > best.distance * best.distance) continue;
        const Node& node = nodes_[at];
        if (node.right == 0) {
            for (int i = node.first; i < node.last; ++i) {
                const Place place = on_triangle(order_[i], point);
                if (place.distance < best.distance ||
                    (place.distance == best.distance && place.triangle < best.triangle))
                    best = place;
            }
            continue;
        }
        // The nearer child first: it narrows the search most.
        const Aside left{at + 1, squared_distance(nodes_[at + 1].box, point)},
            right{node.right, squared_distance(nodes_[node.right].box, point)};
        const bool left_first = left.square <= right.square;
        stack[depth++] = left_first ? right : left;
        stack[depth++] = left_first ? left : right;
    }
    return best;
}

std::vector<std::array<int, 3>> as_triangles(const FaceList& faces, const Positions& points,
                                             std::vector<int>& face_of_triangle) {
    std::vector<std::array<int, 3>> triangles;
    face_of_triangle.clear();
    for (int f = 0; f < faces.size(); ++f) {
        const auto v = faces[f];
        if (v.size() == 3) {
            triangles.push_back({v[0], v[1], v[2]});
            face_of_triangle.push_back(f);
            continue;
        }
        if (v.size() > 4) {  // a polygon that is convex, as those of maps are: a fan
            for (std::size_t i = 1; i + 1 < v.size(); ++i) {
                triangles.push_back({v[0], v[i], v[i + 1]});
                face_of_triangle.push_back(f);
            }
            continue;
        }
        std::array<Eigen::Vector3d, 4> corners;
        for (int i = 0; i < 4; ++i) corners[i] = points.row(v[i]);
        for (const auto& c : split_quad(corners)) {
            triangles.push_back({v[c[0]], v[c[1]], v[c[2]]});
            face_of_triangle.push_back(f);
        }
    }
    return triangles;
}

}  // namespace beltrami
