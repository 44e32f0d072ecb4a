#include <beltrami/registration/overlay.h>

#include <algorithm>
#include <array>
#include <map>

#include <Eigen/Geometry>

#include <beltrami/registration/sphere_locator.h>

namespace beltrami {

namespace {

constexpr double kNothing = 1e-13;  // part of a triangle below which a piece is none

/// Which point a corner is: a vertex of the source (first two numbers alike) or of the target, or a crossing of edges.
using Name = std::array<int, 4>;

struct Corner {
    Eigen::Vector3d point;  ///< on the ray from the sphere's centre
    Name name;
};

/// An edge, its smaller vertex first.
using Edge = std::array<int, 2>;

Edge edge_of(const std::array<int, 3>& triangle, int i) {
    const int a = triangle[i], b = triangle[(i + 1) % 3];
    return {std::min(a, b), std::max(a, b)};
}

/// A convex polygon on the sphere whose side i, from corner i on, lies on an edge of the source or of the target.
struct Polygon {
    struct Side {
        bool of_target;
        Edge edge;
    };
    std::vector<Corner> corners;
    std::vector<Side> sides;
};

int common(const Edge& a, const Edge& b) {
    return a[0] == b[0] || a[0] == b[1] ? a[0] : a[1];
}

/// What lies to the left of an edge of the target (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Edge& edge) {
    const Eigen::Vector3d normal = from.cross(to - from);
    const std::size_t n = polygon.corners.size();
    std::vector<double> height(n);
    for (std::size_t i = 0; i < n; ++i) height[i] = normal.dot(polygon.corners[i].point);
    Polygon result;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        const bool inside = height[i] >= 0, next = height[j] >= 0;
        const Polygon::Side& side = polygon.sides[i];
        if (inside) {
            result.corners.push_back(polygon.corners[i]);
            result.sides.push_back(side);
        }
        if (inside == next) continue;
        const double t = height[i] / (height[i] - height[j]);
        Corner crossing{(1 - t) * polygon.corners[i].point + t * polygon.corners[j].point, {}};
        if (side.of_target) {
            const int vertex = common(side.edge, edge);
            crossing.name = {-1, -1, vertex, vertex};
        } else {
            crossing.name = {side.edge[0], side.edge[1], edge[0], edge[1]};
        }
        result.corners.push_back(std::move(crossing));
        result.sides.push_back(inside ? Polygon::Side{true, edge} : side);
    }
    return result;
}

/// Area of a polygon in barycentric coordinates, as part of the triangle's.
double part(const std::vector<MeshPoint>& places) {
    double sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto &a = places[i].barycentric, &b = places[(i + 1) % places.size()].barycentric;
        sum += a[1] * b[2] - a[2] * b[1];
    }
    return sum;
}

class Overlaying {
  public:
    Overlaying(const SphereLocator& source, const SphereLocator& target) : source_(source), target_(target) {}

    Overlay run() {
        std::vector<int> seen(static_cast<std::size_t>(source_.triangle_count()), -1);
        for (int t = 0; t < target_.triangle_count(); ++t) {
            std::vector<int> open{source_.triangle_at(target_.middle(t))};
            seen[open[0]] = t;
            while (!open.empty()) {
                const int s = open.back();
                open.pop_back();
                if (!meet(s, t) && s != source_.triangle_at(target_.middle(t))) continue;
                for (const int beyond : source_.across(s))
                    if (beyond >= 0 && seen[beyond] != t) {
                        seen[beyond] = t;
                        open.push_back(beyond);
                    }
            }
        }
        return std::move(result_);
    }

  private:
    /// Adds the piece in which two triangles meet. @return whether they do
    bool meet(int s, int t) {
        const std::array<int, 3>&mine = source_.triangle(s), &its = target_.triangle(t);
        Polygon polygon;
        for (int i = 0; i < 3; ++i) {
            polygon.corners.push_back({source_.point(mine[i]), {mine[i], mine[i], -1, -1}});
            polygon.sides.push_back({false, edge_of(mine, i)});
        }
        for (int i = 0; i < 3 && polygon.corners.size() > 2; ++i)
            polygon = clipped(polygon, target_.point(its[i]), target_.point(its[(i + 1) % 3]), edge_of(its, i));
        if (polygon.corners.size() < 3) return false;
        std::vector<MeshPoint> on_source, on_target;
        for (const Corner& corner : polygon.corners) {
            on_source.push_back(source_.place_in(s, corner.point.normalized()));
            on_target.push_back(target_.place_in(t, corner.point.normalized()));
        }
        Overlay::Piece piece{on_source[0].face, on_target[0].face, {}, part(on_source), part(on_target), mine, its};
        if (!(piece.part_of_target > kNothing && piece.part_of_source > kNothing)) return false;
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            const auto [it, is_new] =
                numbers_.emplace(polygon.corners[i].name, static_cast<int>(result_.corners.size()));
            if (is_new) result_.corners.push_back({on_source[i], on_target[i]});
            piece.corners.push_back(it->second);
        }
        result_.pieces.push_back(std::move(piece));
        return true;
    }

    const SphereLocator &source_, &target_;
    std::map<Name, int> numbers_;
    Overlay result_;
};

}  // namespace

Overlay overlay(const SurfaceCorrespondence& map) {
    return Overlaying(map.on_source(), map.on_target()).run();
}

}  // namespace beltrami
