#include <beltrami/mesh/cut.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/quad_split.h>

namespace beltrami {
namespace {

/// Signed distances to the plane, those within rounding set to 0.
std::vector<double> distances(const Mesh& mesh, const HalfSpace& kept) {
    const double length = kept.normal.norm();
    if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(kept.offset)) {
        throw Error(Cause::bad_option, "the cutting plane has no finite normal and offset",
                    "give a normal that is not zero");
    }
    if (mesh.vertex_count() == 0) return {};
    const double diameter = (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
    std::vector<double> distance(mesh.vertex_count());
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        const double d = (kept.normal.dot(mesh.point(vertex)) - kept.offset) / length;
        distance[vertex] = std::abs(d) <= 1e-12 * diameter ? 0.0 : d;
    }
    return distance;
}

/// One corner of a clipped face: a place between two corners of the whole face (the same one twice for a vertex).
struct Place {
    int from, to;  // vertices, from < to on an edge
    int texture_from, texture_to;
    double t;  // position on from → to
};

class Cutter {
  public:
    Cutter(const Mesh& mesh, const HalfSpace& kept) : mesh_(mesh), distance_(distances(mesh, kept)) {}

    CutMesh run() {
        for (int face = 0; face < mesh_.face_count(); ++face) cut_face(face);
        Mesh whole;  // all old vertices, then the crossings
        whole.positions.resize(mesh_.vertex_count() + static_cast<Eigen::Index>(crossings_.size()),
                               mesh_.positions.cols());
        whole.positions.topRows(mesh_.vertex_count()) = mesh_.positions;
        for (const auto& [edge, crossing] : crossings_) {
            whole.positions.row(crossing.index) =
                (1.0 - crossing.t) * mesh_.positions.row(edge.first) + crossing.t * mesh_.positions.row(edge.second);
        }
        std::vector<int> origin;
        for (const auto& [face, places] : polygons_) add_polygon(face, places, whole, origin);
        if (mesh_.texture) finish_texture(whole);

        Submesh part = remove_unreferenced(whole);
        CutMesh result;
        result.edges.assign(part.vertices.size(), {-1, -1});
        std::vector<std::array<int, 2>> edge_of(crossings_.size());
        for (const auto& [edge, crossing] : crossings_) {
            edge_of[crossing.index - mesh_.vertex_count()] = {edge.first, edge.second};
        }
        for (std::size_t i = 0; i < part.vertices.size(); ++i) {
            if (part.vertices[i] < mesh_.vertex_count()) continue;
            result.edges[i] = edge_of[part.vertices[i] - mesh_.vertex_count()];
            part.vertices[i] = -1;
        }
        result.mesh = std::move(part.mesh);
        result.vertices = std::move(part.vertices);
        result.faces = std::move(origin);
        return result;
    }

  private:
    struct Crossing {
        double t;
        int index;
    };
    using Edge = std::pair<int, int>;

    void cut_face(int face) {
        const std::span<const int> v = mesh_.faces[face];
        bool above = false, below = false;
        for (const int vertex : v) {
            if (vertex < 0 || vertex >= mesh_.vertex_count()) {
                throw Error(Cause::bad_mesh, "face " + std::to_string(face) + " names a vertex that does not exist",
                            "diagnose the mesh and repair it", {Things::faces, {face}});
            }
            above = above || distance_[vertex] > 0.0;
            below = below || distance_[vertex] < 0.0;
        }
        if (below && !above) return;
        if (v.size() == 4 && above && below) {
            for (const auto& [a, b, c] :
                 split_quad({mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]), mesh_.point(v[3])}))
                clip(face, {a, b, c});
        } else {
            clip(face, v.size() == 4 ? std::vector{0, 1, 2, 3} : std::vector{0, 1, 2});
        }
    }

    /// Clips the polygon of some corners of a face.
    void clip(int face, const std::vector<int>& corners) {
        std::vector<Place> places;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const int a = mesh_.faces.first_corner(face) + corners[i];
            const int b = mesh_.faces.first_corner(face) + corners[(i + 1) % corners.size()];
            const double da = distance_of(a), db = distance_of(b);
            if (da >= 0.0) places.push_back(between(a, a, 0.0));
            if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
                // Always from the smaller vertex, so that both faces of the edge compute the same point.
                places.push_back(vertex_of(a) < vertex_of(b) ? between(a, b, da / (da - db))
                                                             : between(b, a, db / (db - da)));
                const int next = mesh_.vertex_count() + static_cast<int>(crossings_.size());
                crossings_.insert({{places.back().from, places.back().to}, {places.back().t, next}});
            }
        }
        if (places.size() >= 3) polygons_.push_back({face, std::move(places)});
    }

    /// Adds a clipped polygon as it is, or as two triangles if the plane made a quad of a triangle.
    void add_polygon(int face, const std::vector<Place>& places, Mesh& whole, std::vector<int>& origin) {
        std::vector<int> indices;
        bool original = true;
        for (const Place& place : places) {
            original = original && place.from == place.to;
            indices.push_back(place.from == place.to ? place.from : crossings_.at({place.from, place.to}).index);
        }
        std::vector<std::vector<int>> pieces;
        if (places.size() == 3) {
            pieces = {{0, 1, 2}};
        } else if (original) {
            pieces = {{0, 1, 2, 3}};
        } else {
            for (const auto& [a, b, c] : split_quad({whole.point(indices[0]), whole.point(indices[1]),
                                                     whole.point(indices[2]), whole.point(indices[3])}))
                pieces.push_back({a, b, c});
        }
        for (std::vector<int>& piece : pieces) {
            for (int& i : piece) {
                if (mesh_.texture) texture_corners_.push_back(texture_point(places[i]));
                i = indices[i];
            }
            whole.faces.add(piece);
            origin.push_back(face);
        }
    }

    int texture_point(const Place& place) {
        if (place.from == place.to) return place.texture_from;
        if (place.texture_from < 0 || place.texture_to < 0) return -1;
        const auto [entry, added] = texture_crossings_.insert({{place.texture_from, place.texture_to}, 0});
        if (added) {
            entry->second = static_cast<int>(mesh_.texture->points.rows() + new_texture_points_.size());
            new_texture_points_.push_back((1.0 - place.t) * mesh_.texture->points.row(place.texture_from) +
                                          place.t * mesh_.texture->points.row(place.texture_to));
        }
        return entry->second;
    }

    void finish_texture(Mesh& whole) {
        const Positions& old = mesh_.texture->points;
        TextureCoordinates texture{
            Positions(old.rows() + static_cast<Eigen::Index>(new_texture_points_.size()), old.cols()),
            std::move(texture_corners_)};
        texture.points.topRows(old.rows()) = old;
        for (std::size_t i = 0; i < new_texture_points_.size(); ++i) {
            texture.points.row(old.rows() + static_cast<Eigen::Index>(i)) = new_texture_points_[i];
        }
        whole.texture = std::move(texture);
    }

    int vertex_of(int corner) const { return mesh_.faces.vertices()[corner]; }
    double distance_of(int corner) const { return distance_[vertex_of(corner)]; }
    Place between(int a, int b, double t) const {
        return {vertex_of(a), vertex_of(b), mesh_.texture ? mesh_.texture->corners[a] : -1,
                mesh_.texture ? mesh_.texture->corners[b] : -1, t};
    }

    const Mesh& mesh_;
    std::vector<double> distance_;
    std::vector<std::pair<int, std::vector<Place>>> polygons_;
    std::map<Edge, Crossing> crossings_;  // numbered as the faces meet them
    std::vector<int> texture_corners_;
    std::map<Edge, int> texture_crossings_;
    std::vector<Eigen::RowVectorXd> new_texture_points_;
};

}  // namespace

CutMesh cut_by_plane(const Mesh& mesh, const HalfSpace& kept) {
    return Cutter(mesh, kept).run();
}

}  // namespace beltrami
