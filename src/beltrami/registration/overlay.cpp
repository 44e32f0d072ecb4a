#include <beltrami/registration/overlay.h>

#include <algorithm>
#include <array>
#include <map>

#include <Eigen/Geometry>

#include <beltrami/charts/chart_places.h>
#include <beltrami/registration/drawn_surface.h>

namespace beltrami {

namespace {

constexpr double kNothing = 1e-13;  // part of both triangles below which a piece is none

/// Which point a corner is: a vertex of the source (first two numbers alike) or of the target, which has its name where
/// both are one, or a crossing of edges.
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

/// How far a corner lies to the left of a line through an edge of the target: 0 for the edge's own ends, whatever
/// rounding says.
double height_over(const Corner& corner, const Eigen::Vector3d& normal, const Edge& edge) {
    if (corner.name[0] < 0 && (corner.name[2] == edge[0] || corner.name[2] == edge[1])) return 0;
    return normal.dot(corner.point);
}

/// What lies to the left of an edge of the target (Sutherland and Hodgman 1974).
/// @param normal of the plane through the edge and the centre of projection, to the left
Polygon clipped(const Polygon& polygon, const Eigen::Vector3d& normal, const Edge& edge) {
    const std::size_t n = polygon.corners.size();
    std::vector<double> height(n);
    bool some = false;
    for (std::size_t i = 0; i < n; ++i) {
        height[i] = height_over(polygon.corners[i], normal, edge);
        some = some || height[i] > 0;
    }
    Polygon result;
    if (!some) return result;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        const Polygon::Side& side = polygon.sides[i];
        if (height[i] >= 0) {
            result.corners.push_back(polygon.corners[i]);
            result.sides.push_back(height[i] == 0 && height[j] < 0 ? Polygon::Side{true, edge} : side);
        }
        if (!(height[i] < 0 && height[j] > 0) && !(height[i] > 0 && height[j] < 0)) continue;
        const double t = height[i] / (height[i] - height[j]);
        Corner crossing{(1 - t) * polygon.corners[i].point + t * polygon.corners[j].point, {}};
        if (side.of_target) {
            const int vertex = common(side.edge, edge);
            crossing.name = {-1, -1, vertex, vertex};
        } else {
            crossing.name = {side.edge[0], side.edge[1], edge[0], edge[1]};
        }
        result.corners.push_back(std::move(crossing));
        result.sides.push_back(height[i] > 0 ? Polygon::Side{true, edge} : side);
    }
    return result;
}

/// Area of a polygon in barycentric coordinates, as part of the triangle's.
double part(const std::vector<std::array<double, 3>>& corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
        sum += a[1] * b[2] - a[2] * b[1];
    }
    return std::max(sum, 0.0);
}

class Overlaying {
  public:
    explicit Overlaying(const SurfaceCorrespondence& map)
        : source_(map.on_source()), target_(map.on_target()), partners_(map.partners()) {}

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
            polygon.corners.push_back({source_.point(mine[i]), name_of(mine[i])});
            polygon.sides.push_back({false, edge_of(mine, i)});
        }
        for (int i = 0; i < 3 && polygon.corners.size() > 2; ++i) {
            // The same numbers from both sides of the edge, but for their sign.
            const Edge edge = edge_of(its, i);
            const Eigen::Vector3d from = target_.point(edge[0]), normal = from.cross(target_.point(edge[1]) - from);
            polygon = clipped(polygon, edge[0] == its[i] ? normal : Eigen::Vector3d(-normal), edge);
        }
        if (polygon.corners.size() < 3) return false;
        Overlay::Piece piece{};
        std::vector<MeshPoint> on_source, on_target;
        for (const Corner& corner : polygon.corners) {
            on_source.push_back(source_.place_in(s, source_.project(corner.point)));
            on_target.push_back(target_.place_in(t, target_.project(corner.point)));
            piece.in_source.push_back(on_source.back().barycentric);
            piece.in_target.push_back(on_target.back().barycentric);
        }
        piece.source_face = on_source[0].face;
        piece.target_face = on_target[0].face;
        piece.source_triangle = on_source[0].vertices;
        piece.target_triangle = on_target[0].vertices;
        piece.part_of_source = part(piece.in_source);
        piece.part_of_target = part(piece.in_target);
        if (!(std::max(piece.part_of_target, piece.part_of_source) > kNothing)) return false;
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            const auto [it, is_new] =
                numbers_.emplace(polygon.corners[i].name, static_cast<int>(result_.corners.size()));
            if (is_new) result_.corners.push_back({on_source[i], on_target[i]});
            piece.corners.push_back(it->second);
        }
        result_.pieces.push_back(std::move(piece));
        return true;
    }

    Name name_of(int vertex) const {
        const bool known = vertex < static_cast<int>(partners_.size()) && partners_[vertex] >= 0;
        return known ? Name{-1, -1, partners_[vertex], partners_[vertex]} : Name{vertex, vertex, -1, -1};
    }

    const DrawnSurface &source_, &target_;
    const std::vector<int>& partners_;
    std::map<Name, int> numbers_;
    Overlay result_;
};

/// The corner of a convex polygon from which the smallest triangle of a fan is largest.
/// @param at barycentric coordinates of its corners
std::size_t fan_root(const std::vector<std::array<double, 3>>& at) {
    const std::size_t n = at.size();
    std::size_t best = 0;
    double most = -1;
    for (std::size_t root = 0; root < n; ++root) {
        double least = 1;
        for (std::size_t i = 1; i + 1 < n; ++i)
            least = std::min(least, part({at[root], at[(root + i) % n], at[(root + i + 1) % n]}));
        if (least > most) most = least, best = root;
    }
    return best;
}

}  // namespace

Overlay overlay(const SurfaceCorrespondence& map) {
    return Overlaying(map).run();
}

OverlayMesh overlay_mesh(const SurfaceCorrespondence& map, TransferWay way) {
    const Overlay both = overlay(map);
    const bool back = way == TransferWay::to_source;
    const Mesh &from = back ? map.target() : map.source(), &to = back ? map.source() : map.target();
    OverlayMesh result;
    std::vector<MeshPoint> places;
    places.reserve(both.corners.size());
    for (const Overlay::Corner& corner : both.corners) places.push_back(back ? corner.on_source : corner.on_target);
    result.mesh.positions = positions_on(to, places);
    std::vector<Eigen::RowVector2d> texture;
    for (const Overlay::Piece& piece : both.pieces) {
        const auto& where = piece.part_of_source > piece.part_of_target ? piece.in_source : piece.in_target;
        const std::size_t n = piece.corners.size(), root = fan_root(where);
        for (std::size_t i = 1; i + 1 < n; ++i) {
            const std::array<std::size_t, 3> corners{root, (root + i) % n, (root + i + 1) % n};
            result.mesh.faces.add({piece.corners[corners[0]], piece.corners[corners[1]], piece.corners[corners[2]]});
            result.source_faces.push_back(piece.source_face);
            result.target_faces.push_back(piece.target_face);
            if (!from.texture) continue;
            for (const std::size_t c : corners)
                texture.push_back(
                    texture_at(from, back ? MeshPoint{piece.target_face, piece.target_triangle, piece.in_target[c]}
                                          : MeshPoint{piece.source_face, piece.source_triangle, piece.in_source[c]}));
        }
    }
    if (!from.texture) return result;
    result.mesh.texture.emplace();
    result.mesh.texture->points.resize(static_cast<Eigen::Index>(texture.size()), 2);
    for (std::size_t i = 0; i < texture.size(); ++i) {
        result.mesh.texture->points.row(static_cast<Eigen::Index>(i)) = texture[i];
        result.mesh.texture->corners.push_back(static_cast<int>(i));
    }
    return result;
}

}  // namespace beltrami
