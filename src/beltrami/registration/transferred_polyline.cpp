#include <beltrami/registration/transferred_polyline.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <beltrami/curves/straight_path.h>
#include <beltrami/locate/point_at.h>

namespace beltrami {

namespace {

constexpr int kHalvings = 40;
constexpr double kOnSide = 1e-8;  // of barycentric coordinates
constexpr double kApart = 1e-11;  // of the diagonal, below which two points of the image are one

/// A part of a segment, which lies in one triangle of the surface that is left: from its point to that of the next
/// part.
struct Part {
    MeshPoint from, image;
    int given = -1;       ///< the number of the given point that it begins with
    bool joined = false;  ///< the next part belongs to the same triangle
    MeshPoint to = {};    ///< the end, where it is joined: with the corners of from
};

bool same_triangle(const MeshPoint& a, const MeshPoint& b) {
    std::array<int, 3> first = a.vertices, second = b.vertices;
    std::sort(first.begin(), first.end());
    std::sort(second.begin(), second.end());
    return a.face == b.face && first == second;
}

MeshPoint halfway(const MeshPoint& a, const MeshPoint& b) {
    MeshPoint result = a;
    for (int i = 0; i < 3; ++i) result.barycentric[i] = 0.5 * (a.barycentric[i] + b.barycentric[i]);
    return result;
}

/// The triangles of a mesh by their corners and by their sides.
class Triangles {
  public:
    explicit Triangles(const CurveMesh& mesh) {
        for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
            std::array<int, 3> v = mesh.triangles()[t];
            std::sort(v.begin(), v.end());
            for (const std::vector<int>& part :
                 {std::vector{v[0], v[1], v[2]}, std::vector{v[0], v[1]}, std::vector{v[0], v[2]},
                  std::vector{v[1], v[2]}, std::vector{v[0]}, std::vector{v[1]}, std::vector{v[2]}})
                with_.emplace(part, std::pair(mesh.face_of(static_cast<int>(t)), v));
        }
    }

    /// Two points of one triangle, with the corners of that; nothing if there is none.
    std::optional<std::array<MeshPoint, 2>> together(const MeshPoint& a, const MeshPoint& b) const {
        std::vector<int> corners;
        for (const MeshPoint* point : {&a, &b})
            for (int i = 0; i < 3; ++i)
                if (point->barycentric[i] > kOnSide) corners.push_back(point->vertices[i]);
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        const auto found = with_.find(corners);
        if (found == with_.end()) return {};
        return std::array{seen_in(a, found->second), seen_in(b, found->second)};
    }

  private:
    static MeshPoint seen_in(const MeshPoint& point, const std::pair<int, std::array<int, 3>>& triangle) {
        MeshPoint result{triangle.first, triangle.second, {0, 0, 0}};
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (triangle.second[i] == point.vertices[j]) sum += result.barycentric[i] = point.barycentric[j];
        for (double& weight : result.barycentric) weight /= sum;
        return result;
    }

    std::map<std::vector<int>, std::pair<int, std::array<int, 3>>> with_;
};

/// The triangle in which a path runs from one node to the next.
int triangle_between(const CurveMesh& mesh, const PathNode& from, const PathNode& to) {
    if (from.b >= 0) return mesh.left_of(from.a, from.b);
    if (to.b >= 0) return mesh.left_of(to.b, to.a);
    return std::max(mesh.left_of(from.a, to.a), mesh.left_of(to.a, from.a));
}

/// The geodesics between given points, a part for each triangle that they cross; the last part is the last point.
std::vector<Part> geodesic_parts(const Mesh& surface, std::span<const MeshPoint> points) {
    CurveMesh mesh(surface);
    const Triangles triangles(mesh);
    std::vector<Part> parts;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto given = static_cast<int>(i);
        if (const auto both = triangles.together(points[i], points[i + 1])) {
            parts.push_back({(*both)[0], {}, given, true, (*both)[1]});
            continue;
        }
        const int from = mesh.vertex_at(points[i]), to = mesh.vertex_at(points[i + 1]);
        if (from == to) continue;
        const std::vector<PathNode> nodes = straight_path(mesh, from, to);
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            const int triangle = triangle_between(mesh, nodes[k], nodes[k + 1]);
            parts.push_back({mesh.place(triangle, nodes[k].point),
                             {},
                             k == 0 ? given : -1,
                             true,
                             mesh.place(triangle, nodes[k + 1].point)});
        }
    }
    parts.push_back({points.back(), {}, static_cast<int>(points.size()) - 1, false, {}});
    return parts;
}

}  // namespace

TransferredPolyline transferred_polyline(const SurfaceCorrespondence& map, std::span<const MeshPoint> points,
                                         TransferWay way) {
    TransferredPolyline result;
    if (points.empty()) return result;
    const auto images = [&](const std::vector<MeshPoint>& places) {
        return way == TransferWay::to_target ? map.forward(places) : map.back(places);
    };
    const std::vector<Part> parts = geodesic_parts(way == TransferWay::to_target ? map.source() : map.target(), points);
    // Every part between images of two triangles is halved until the edges between them are met.
    struct Piece {
        std::size_t part;
        MeshPoint from, to, image, image_of_end;
    };
    std::vector<MeshPoint> ends;
    ends.reserve(2 * parts.size());
    for (const Part& part : parts) {
        ends.push_back(part.from);
        ends.push_back(part.joined ? part.to : part.from);
    }
    const std::vector<MeshPoint> there = images(ends);
    std::vector<Piece> pieces;
    pieces.reserve(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        pieces.push_back({i, ends[2 * i], ends[2 * i + 1], there[2 * i], there[2 * i + 1]});
    for (int halving = 0; halving < kHalvings; ++halving) {
        std::vector<MeshPoint> middles;
        for (const Piece& piece : pieces)
            if (!same_triangle(piece.image, piece.image_of_end)) middles.push_back(halfway(piece.from, piece.to));
        if (middles.empty()) break;
        const std::vector<MeshPoint> found = images(middles);
        std::vector<Piece> finer;
        finer.reserve(pieces.size() + middles.size());
        std::size_t next = 0;
        for (const Piece& piece : pieces) {
            if (same_triangle(piece.image, piece.image_of_end)) {
                finer.push_back(piece);
                continue;
            }
            finer.push_back({piece.part, piece.from, middles[next], piece.image, found[next]});
            finer.push_back({piece.part, middles[next], piece.to, found[next], piece.image_of_end});
            ++next;
        }
        pieces = std::move(finer);
    }
    // What is left open is at an edge; pieces of one triangle on either side of a middle are one.
    result.given.assign(points.size(), -1);
    const Mesh& to = way == TransferWay::to_target ? map.target() : map.source();
    const double size = (to.positions.colwise().maxCoeff() - to.positions.colwise().minCoeff()).norm();
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const bool begins = i == 0 || pieces[i - 1].part != pieces[i].part;
        const bool at_edge = i > 0 && !same_triangle(pieces[i - 1].image, pieces[i - 1].image_of_end);
        if (!begins && !at_edge) continue;
        const Eigen::Vector3d point = point_at(to, pieces[i].image);
        if (result.places.empty() || (point - last).norm() > kApart * size) result.places.push_back(pieces[i].image);
        last = point_at(to, result.places.back());
        if (const int given = parts[pieces[i].part].given; begins && given >= 0)
            result.given[given] = static_cast<int>(result.places.size()) - 1;
    }
    // Points that have no part of their own are the next one.
    for (std::size_t i = points.size() - 1; i-- > 0;)
        if (result.given[i] < 0) result.given[i] = result.given[i + 1];
    return result;
}

}  // namespace beltrami
