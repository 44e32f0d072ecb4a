#include <beltrami/curves/surface_curve.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/curves/straight_path.h>

namespace beltrami {

namespace {

constexpr double kApart = 1e-9;  // of an edge, below which two crossings are one point

std::string name(std::size_t curve) {
    return "curve " + std::to_string(curve + 1);
}

void require(bool holds, std::size_t curve, const std::string& what, const char* next_step, std::vector<int> at = {}) {
    if (!holds)
        throw Error(Cause::bad_boundary, name(curve) + " " + what, next_step, {Things::vertices, std::move(at)});
}

/// Divides the faces that curves cross.
class Embedding {
  public:
    Embedding(const Mesh& mesh, std::size_t curves)
        : mesh_(mesh), old_(mesh.vertex_count()), owner_(static_cast<std::size_t>(old_), -1) {
        result_.curves.resize(curves);
    }

    void add(std::size_t curve, const CurveThrough& through);
    int vertex_at(const MeshPoint& place) { return mesh_.vertex_at(place); }
    MeshWithCurves finish(const Mesh& mesh);

  private:
    struct Crossing {
        double t;  ///< from the lower end
        int vertex;
    };
    using Edge = std::array<int, 2>;
    using Polygon = std::vector<int>;

    int vertex_of(std::size_t curve, const PathNode& node);
    void occupy(std::size_t curve, int vertex);
    int add_point(const Eigen::Vector3d& point, int triangle);
    void divide(const Polygon& polygon, std::vector<std::array<int, 2>> chords, int face);
    void triangulate(const Polygon& polygon, int face);
    void divide_faces(const Mesh& mesh);
    void divide_bridges();
    const Eigen::Vector3d& point(int vertex) const {
        return vertex < mesh_.vertex_count() ? mesh_.point(vertex) : crossings_[vertex - mesh_.vertex_count()];
    }

    CurveMesh mesh_;
    int old_;
    std::vector<int> owner_;                  ///< curve of every vertex, −1 of others
    std::vector<Eigen::Vector3d> crossings_;  ///< with edges, and middles of bridges
    std::vector<MeshPoint> given_, places_;   ///< of points given inside faces or edges, and of the other new ones
    std::vector<int> triangle_of_;            ///< of mesh_, for every new face
    std::map<Edge, std::vector<Crossing>> on_edge_;
    std::map<int, std::vector<std::array<int, 2>>> chords_;  ///< of triangles
    MeshWithCurves result_;
};

void Embedding::occupy(std::size_t curve, int vertex) {
    if (vertex >= static_cast<int>(owner_.size())) owner_.resize(static_cast<std::size_t>(vertex) + 1, -1);
    const int owner = owner_[vertex];
    require(owner != static_cast<int>(curve), curve, "meets itself at a vertex or crosses its own way",
            "give points in the order in which the curve passes them, nearer to each other", {vertex});
    require(owner < 0, curve, "meets " + (owner < 0 ? std::string() : name(static_cast<std::size_t>(owner))),
            "curves must not touch: move one of them, or give more points", {vertex});
    owner_[vertex] = static_cast<int>(curve);
}

/// A vertex of the new mesh in a triangle.
int Embedding::add_point(const Eigen::Vector3d& point, int triangle) {
    crossings_.push_back(point);
    places_.push_back(mesh_.place(triangle, point));
    return mesh_.vertex_count() + static_cast<int>(crossings_.size()) - 1;
}

/// The new mesh's vertex of a node.
int Embedding::vertex_of(std::size_t curve, const PathNode& node) {
    if (node.b < 0) return node.a;
    const bool ascending = node.a < node.b;
    std::vector<Crossing>& there = on_edge_[{std::min(node.a, node.b), std::max(node.a, node.b)}];
    const double t = ascending ? node.t : 1 - node.t;
    for (const Crossing& other : there)
        require(std::abs(other.t - t) > kApart, curve, "meets itself or another curve on an edge",
                "curves must not touch: move one of them, or give more points", {node.a, node.b});
    const int vertex = add_point(node.point, std::max(mesh_.left_of(node.a, node.b), mesh_.left_of(node.b, node.a)));
    there.insert(std::upper_bound(there.begin(), there.end(), t,
                                  [](double value, const Crossing& crossing) { return value < crossing.t; }),
                 {t, vertex});
    return vertex;
}

void Embedding::add(std::size_t curve, const CurveThrough& through) {
    MeshWithCurves::Chain& chain = result_.curves[curve];
    chain.closed = through.closed;
    std::vector<int> given;
    given.reserve(through.points.size());
    for (const MeshPoint& place : through.points) given.push_back(mesh_.vertex_at(place));
    const std::size_t pieces = given.size() - (through.closed ? 0 : 1);
    int previous = given[0];
    occupy(curve, previous);
    chain.vertices.push_back(previous);
    chain.lengths.push_back(0);
    chain.given.push_back(0);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const int to = given[(piece + 1) % given.size()];
        require(to != given[piece], curve, "has two points that coincide", "leave one of them out", {to});
        const std::vector<PathNode> nodes = straight_path(mesh_, given[piece], to);
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const bool closing = piece + 1 == given.size() && i + 1 == nodes.size();
            const int vertex = closing ? chain.vertices[0] : vertex_of(curve, nodes[i]);
            if (!closing) occupy(curve, vertex);
            // The triangle between two nodes: to the left of the edge that was crossed last, or behind the next one.
            int triangle = -1;
            if (nodes[i - 1].b >= 0)
                triangle = mesh_.left_of(nodes[i - 1].a, nodes[i - 1].b);
            else if (nodes[i].b >= 0)
                triangle = mesh_.left_of(nodes[i].b, nodes[i].a);
            if (triangle >= 0) chords_[triangle].push_back({previous, vertex});
            chain.length += (nodes[i].point - nodes[i - 1].point).norm();
            if (!closing) {
                chain.vertices.push_back(vertex);
                chain.lengths.push_back(chain.length);
                if (i + 1 == nodes.size()) chain.given.push_back(static_cast<int>(chain.vertices.size()) - 1);
            }
            previous = vertex;
        }
    }
}

/// Divides a convex polygon along chords.
void Embedding::divide(const Polygon& polygon, std::vector<std::array<int, 2>> chords, int face) {
    while (!chords.empty()) {
        const auto [a, b] = chords.back();
        chords.pop_back();
        auto i = std::find(polygon.begin(), polygon.end(), a) - polygon.begin(),
             j = std::find(polygon.begin(), polygon.end(), b) - polygon.begin();
        if (i > j) std::swap(i, j);
        const auto n = static_cast<std::ptrdiff_t>(polygon.size());
        if (j - i == 1 || j - i == n - 1) continue;  // along a side
        const Polygon one(polygon.begin() + i, polygon.begin() + j + 1);
        Polygon other(polygon.begin() + j, polygon.end());
        other.insert(other.end(), polygon.begin(), polygon.begin() + i + 1);
        std::vector<std::array<int, 2>> in_one, in_other;
        const auto inside = [](const Polygon& part, const std::array<int, 2>& chord) {
            return std::all_of(chord.begin(), chord.end(),
                               [&](int v) { return std::find(part.begin(), part.end(), v) != part.end(); });
        };
        for (const auto& chord : chords) {
            if (inside(one, chord))
                in_one.push_back(chord);
            else if (inside(other, chord))
                in_other.push_back(chord);
            else
                require(false, static_cast<std::size_t>(std::max(0, owner_[chord[0]])),
                        "crosses itself or " + name(static_cast<std::size_t>(std::max(0, owner_[a]))),
                        "curves must not cross: move one of them, or give more points", {chord[0], chord[1], a, b});
        }
        divide(one, std::move(in_one), face);
        divide(other, std::move(in_other), face);
        return;
    }
    triangulate(polygon, face);
}

/// The triangulation whose worst triangle is best; points may lie on the sides.
void Embedding::triangulate(const Polygon& polygon, int face) {
    const int n = static_cast<int>(polygon.size());
    const auto quality = [&](int i, int j, int k) {
        const Eigen::Vector3d &a = point(polygon[i]), &b = point(polygon[j]), &c = point(polygon[k]);
        return (b - a).cross(c - a).norm() /
               std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    };
    std::vector<std::vector<double>> best(static_cast<std::size_t>(n),
                                          std::vector<double>(static_cast<std::size_t>(n), 9));
    std::vector<std::vector<int>> apex(static_cast<std::size_t>(n), std::vector<int>(static_cast<std::size_t>(n), -1));
    for (int span = 2; span < n; ++span)
        for (int i = 0; i + span < n; ++i) {
            const int k = i + span;
            best[i][k] = -1;
            for (int j = i + 1; j < k; ++j) {
                const double worst = std::min({best[i][j], best[j][k], quality(i, j, k)});
                if (worst > best[i][k]) best[i][k] = worst, apex[i][k] = j;
            }
        }
    std::vector<std::array<int, 2>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, k] = open.back();
        open.pop_back();
        if (k - i < 2) continue;
        const int j = apex[i][k];
        result_.mesh.faces.add({polygon[i], polygon[j], polygon[k]});
        result_.faces.push_back(face);
        open.push_back({i, j});
        open.push_back({j, k});
    }
}

/// Divides edges that join two vertices of one curve without running along it, in the middle.
void Embedding::divide_bridges() {
    owner_.resize(static_cast<std::size_t>(mesh_.vertex_count()) + crossings_.size(), -1);
    std::vector<int> at(owner_.size(), 0);
    for (const MeshWithCurves::Chain& chain : result_.curves)
        for (std::size_t i = 0; i < chain.vertices.size(); ++i) at[chain.vertices[i]] = static_cast<int>(i);
    const auto bridges = [&](int a, int b) {
        if (owner_[a] < 0 || owner_[a] != owner_[b]) return false;
        const MeshWithCurves::Chain& chain = result_.curves[owner_[a]];
        const int apart = std::abs(at[a] - at[b]);
        return apart > 1 && !(chain.closed && apart + 1 == static_cast<int>(chain.vertices.size()));
    };
    FaceList before;
    std::swap(before, result_.mesh.faces);
    const std::vector<int> face_of = std::exchange(result_.faces, {});
    const std::vector<int> triangle_of = std::exchange(triangle_of_, {});
    std::map<Edge, int> middles;
    for (int f = 0; f < before.size(); ++f) {
        Polygon polygon;
        for (int i = 0; i < before.degree(f); ++i) {
            const int a = before[f][i], b = before[f][(i + 1) % before.degree(f)];
            polygon.push_back(a);
            if (!bridges(a, b)) continue;
            const auto [it, is_new] = middles.emplace(Edge{std::min(a, b), std::max(a, b)}, 0);
            if (is_new) it->second = add_point(0.5 * (point(a) + point(b)), triangle_of[f]);
            polygon.push_back(it->second);
        }
        if (static_cast<int>(polygon.size()) > before.degree(f)) {
            triangulate(polygon, face_of[f]);
        } else {
            result_.mesh.faces.add(before[f]);
            result_.faces.push_back(face_of[f]);
        }
    }
}

MeshWithCurves Embedding::finish(const Mesh& mesh) {
    divide_faces(mesh);
    divide_bridges();
    result_.mesh.positions.resize(mesh_.vertex_count() + static_cast<Eigen::Index>(crossings_.size()), 3);
    for (Eigen::Index v = 0; v < result_.mesh.positions.rows(); ++v)
        result_.mesh.positions.row(v) = point(static_cast<int>(v));
    result_.places = std::move(given_);
    result_.places.insert(result_.places.end(), places_.begin(), places_.end());
    return std::move(result_);
}

/// Divides the faces that curves cross along them.
void Embedding::divide_faces(const Mesh& mesh) {
    owner_.resize(static_cast<std::size_t>(mesh_.vertex_count()) + crossings_.size(), -1);
    // Faces stay as they are unless one of their triangles has more corners now than it had, or is one of several.
    std::vector<std::vector<int>> triangles_of(static_cast<std::size_t>(mesh.face_count()));
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t)
        triangles_of[mesh_.face_of(static_cast<int>(t))].push_back(static_cast<int>(t));
    std::vector<Polygon> polygons;
    given_.resize(static_cast<std::size_t>(mesh_.vertex_count() - old_));
    for (int f = 0; f < mesh.face_count(); ++f) {
        polygons.clear();
        bool touched = triangles_of[f].size() != mesh.faces[f].size() - 2;
        for (const int t : triangles_of[f]) {
            const auto& corners = mesh_.triangles()[t];
            Polygon polygon;
            for (int i = 0; i < 3; ++i) {
                const int a = corners[i], b = corners[(i + 1) % 3];
                polygon.push_back(a);
                if (a >= old_) given_[a - old_] = mesh_.place(t, mesh_.point(a));
                const auto there = on_edge_.find({std::min(a, b), std::max(a, b)});
                if (there == on_edge_.end()) continue;
                std::vector<int> between;
                for (const Crossing& crossing : there->second) between.push_back(crossing.vertex);
                if (a > b) std::reverse(between.begin(), between.end());
                polygon.insert(polygon.end(), between.begin(), between.end());
            }
            touched = touched || polygon.size() > 3 || chords_.count(t) > 0;
            polygons.push_back(std::move(polygon));
        }
        // A curve along a diagonal of a quad needs it as an edge.
        if (mesh.faces[f].size() == 4)
            touched = touched || std::count_if(mesh.faces[f].begin(), mesh.faces[f].end(),
                                               [&](int v) { return owner_[v] >= 0; }) > 1;
        if (!touched) {
            result_.mesh.faces.add(mesh.faces[f]);
            result_.faces.push_back(f);
            triangle_of_.push_back(triangles_of[f][0]);
            continue;
        }
        for (std::size_t i = 0; i < polygons.size(); ++i) {
            const auto chords = chords_.find(triangles_of[f][i]);
            divide(polygons[i], chords == chords_.end() ? std::vector<std::array<int, 2>>{} : chords->second, f);
            triangle_of_.resize(result_.faces.size(), triangles_of[f][i]);
        }
    }
}

}  // namespace

MeshWithCurves mesh_with_curves(const Mesh& mesh, std::span<const CurveThrough> curves) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
        require(curves[c].points.size() >= (curves[c].closed ? 3U : 2U), c, "has too few points",
                "give at least two, and three of a closed one");
        for (const MeshPoint& place : curves[c].points) {
            bool known = place.face >= 0 && place.face < mesh.face_count();
            for (const int v : place.vertices) known = known && v >= 0 && v < mesh.vertex_count();
            require(known, c, "has a point that is not on the surface", "name faces and vertices of the mesh",
                    {place.vertices[0]});
        }
    }
    Embedding embedding(mesh, curves.size());
    // All given points first: crossings are counted after them.
    for (const CurveThrough& curve : curves)
        for (const MeshPoint& place : curve.points) embedding.vertex_at(place);
    for (std::size_t c = 0; c < curves.size(); ++c) embedding.add(c, curves[c]);
    return embedding.finish(mesh);
}

}  // namespace beltrami
