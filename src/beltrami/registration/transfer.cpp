#include <beltrami/registration/transfer.h>

#include <algorithm>
#include <array>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/registration/boundary_match.h>
#include <beltrami/registration/drawn_surface.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/surface_landmarks.h>

namespace beltrami {

namespace {

std::vector<MeshPoint> carried(const DrawnSurface& from, const DrawnSurface& to, std::span<const MeshPoint> places) {
    std::vector<MeshPoint> result(places.size());
    parallel_for(0, static_cast<int>(places.size()), [&](int first, int last) {
        for (int i = first; i < last; ++i) result[i] = to.locate(from.point_of(places[i]));
    });
    return result;
}

void require_sizes(const Mesh& source, const Mesh& target, std::size_t places, Eigen::Index points) {
    if (static_cast<int>(places) != source.vertex_count() || points != target.vertex_count())
        throw Error(Cause::bad_option, "the places or the sphere or circle domain belong to other meshes",
                    "give a place for every vertex of the source, and a point for every vertex of the target");
}

/// A correspondence as one way sees it: what is given, what is to get it, and where a place of that comes from.
struct Seen {
    const SurfaceCorrespondence& map;
    TransferWay way;
    const Mesh& from() const { return way == TransferWay::to_target ? map.source() : map.target(); }
    const Mesh& to() const { return way == TransferWay::to_target ? map.target() : map.source(); }
    std::vector<MeshPoint> origins(std::span<const MeshPoint> places) const {
        return way == TransferWay::to_target ? map.back(places) : map.forward(places);
    }
};

/// A place inside a face.
MeshPoint middle_of_face(const Mesh& mesh, int face) {
    const auto v = mesh.faces[face];
    return {face, {v[0], v[1], v[2]}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
}

}  // namespace

SurfaceCorrespondence::SurfaceCorrespondence(const Mesh& source, const Mesh& target, const Positions& target_sphere,
                                             std::span<const MeshPoint> places)
    : source_(source), target_(target) {
    require_sizes(source, target, places.size(), target_sphere.rows());
    on_target_ = std::make_unique<DrawnSurface>(target.faces, target_sphere, DrawnSurface::On::sphere);
    Positions drawn(source.vertex_count(), 3);
    for (std::size_t v = 0; v < places.size(); ++v) {
        drawn.row(static_cast<Eigen::Index>(v)) = sphere_place(target_sphere, places[v]);
        partners_.push_back(vertex_at(places[v]));
    }
    on_source_ = std::make_unique<DrawnSurface>(source.faces, drawn, DrawnSurface::On::sphere);
    require_upright();
}

SurfaceCorrespondence::SurfaceCorrespondence(const Surface& source, const Surface& target,
                                             const CircleDomainChart& circles, std::span<const MeshPoint> places)
    : source_(source.mesh), target_(target.mesh) {
    require_sizes(source_, target_, places.size(), circles.chart.vertices.size());
    BoundaryMatch match = match_boundaries(source, target, circles, places);
    on_source_ = std::make_unique<DrawnSurface>(source_.faces, std::move(match.source), DrawnSurface::On::plane,
                                                match.source_bends);
    on_target_ = std::make_unique<DrawnSurface>(target_.faces, std::move(match.target), DrawnSurface::On::plane,
                                                match.target_bends);
    partners_ = std::move(match.partners);
    require_upright();
}

void SurfaceCorrespondence::require_upright() const {
    const std::vector<int> flipped = on_source_->flipped();
    if (!flipped.empty())
        throw Error(Cause::bad_mesh, counted(flipped.size(), "face is", "faces are") + " flipped between their places",
                    "give places that a registration of these two meshes wrote, onto the same outer loop of the target",
                    {Things::faces, flipped});
}

SurfaceCorrespondence::~SurfaceCorrespondence() = default;
SurfaceCorrespondence::SurfaceCorrespondence(SurfaceCorrespondence&&) noexcept = default;
SurfaceCorrespondence& SurfaceCorrespondence::operator=(SurfaceCorrespondence&&) noexcept = default;

std::vector<MeshPoint> SurfaceCorrespondence::forward(std::span<const MeshPoint> places) const {
    return carried(*on_source_, *on_target_, places);
}

std::vector<MeshPoint> SurfaceCorrespondence::back(std::span<const MeshPoint> places) const {
    return carried(*on_target_, *on_source_, places);
}

std::vector<MeshPoint> places_of_vertices(const Mesh& mesh) {
    std::vector<MeshPoint> places(static_cast<std::size_t>(mesh.vertex_count()));
    for (int f = mesh.face_count() - 1; f >= 0; --f) {
        const auto v = mesh.faces[f];
        for (std::size_t i = 0; i < v.size(); ++i)
            places[v[i]] = {f, {v[i], v[(i + 1) % v.size()], v[(i + v.size() - 1) % v.size()]}, {1, 0, 0}};
    }
    return places;
}

Positions transferred_vertex_values(const SurfaceCorrespondence& map, const Positions& values, TransferWay way) {
    const Seen seen{map, way};
    if (values.rows() != seen.from().vertex_count())
        throw Error(Cause::bad_option, std::to_string(values.rows()) + " rows of values for " +
                                           std::to_string(seen.from().vertex_count()) + " vertices");
    Positions result = Positions::Zero(seen.to().vertex_count(), values.cols());
    std::vector<MeshPoint> places;
    std::vector<int> vertices;
    for (const MeshPoint& place : places_of_vertices(seen.to()))
        if (place.face >= 0) places.push_back(place), vertices.push_back(place.vertices[0]);
    const std::vector<MeshPoint> there = seen.origins(places);
    for (std::size_t i = 0; i < there.size(); ++i)
        for (int j = 0; j < 3; ++j)
            result.row(vertices[i]) += there[i].barycentric[j] * values.row(there[i].vertices[j]);
    return result;
}

Positions transferred_face_values(const SurfaceCorrespondence& map, const Positions& values, TransferWay way) {
    const Seen seen{map, way};
    if (values.rows() != seen.from().face_count())
        throw Error(Cause::bad_option, std::to_string(values.rows()) + " rows of values for " +
                                           std::to_string(seen.from().face_count()) + " faces");
    Positions result = Positions::Zero(seen.to().face_count(), values.cols());
    Eigen::VectorXd covered = Eigen::VectorXd::Zero(seen.to().face_count());
    for (const Overlay::Piece& piece : overlay(map).pieces) {
        const bool back = way == TransferWay::to_source;
        const int from = back ? piece.target_face : piece.source_face,
                  to = back ? piece.source_face : piece.target_face;
        const auto& [a, b, c] = back ? piece.source_triangle : piece.target_triangle;
        const Eigen::Vector3d side = seen.to().point(b) - seen.to().point(a),
                              other = seen.to().point(c) - seen.to().point(a);
        const double area = (back ? piece.part_of_source : piece.part_of_target) * side.cross(other).norm();
        result.row(to) += area * values.row(from);
        covered[to] += area;
    }
    for (int f = 0; f < seen.to().face_count(); ++f) {
        if (covered[f] > 0)
            result.row(f) /= covered[f];
        else
            result.row(f) = values.row(seen.origins(std::array{middle_of_face(seen.to(), f)})[0].face);
    }
    return result;
}

Eigen::RowVector2d texture_at(const Mesh& mesh, const MeshPoint& place) {
    const auto of_face = mesh.faces[place.face];
    Eigen::RowVector2d point = Eigen::RowVector2d::Zero();
    for (int j = 0; j < 3; ++j) {
        const auto at = std::find(of_face.begin(), of_face.end(), place.vertices[j]) - of_face.begin();
        const int number = mesh.texture->corners[static_cast<std::size_t>(mesh.faces.first_corner(place.face) + at)];
        if (number < 0)
            throw Error(Cause::bad_mesh, "a corner of face " + std::to_string(place.face) + " has no texture point",
                        "give every corner one", {Things::faces, {place.face}});
        point += place.barycentric[j] * mesh.texture->points.row(number);
    }
    return point;
}

TextureCoordinates transferred_texture(const SurfaceCorrespondence& map, TransferWay way) {
    const Seen seen{map, way};
    const Mesh &source = seen.from(), &target = seen.to();
    if (!source.texture) throw Error(Cause::bad_mesh, "the mesh has no texture coordinates", "give one that has");
    constexpr double kInward = 0.02;  // of the way to the face's middle, at which corners look
    TextureCoordinates result;
    result.points.resize(target.faces.corner_count(), 2);
    for (int f = 0; f < target.face_count(); ++f) {
        const auto v = target.faces[f];
        std::vector<MeshPoint> corners;
        for (std::size_t i = 0; i < v.size(); ++i)
            corners.push_back({f,
                               {v[i], v[(i + 1) % v.size()], v[(i + v.size() - 1) % v.size()]},
                               {1 - 2 * kInward, kInward, kInward}});
        const std::vector<MeshPoint> there = seen.origins(corners);
        for (std::size_t i = 0; i < v.size(); ++i) {
            const int corner = target.faces.first_corner(f) + static_cast<int>(i);
            result.points.row(corner) = texture_at(source, there[i]);
            result.corners.push_back(corner);
        }
    }
    return result;
}

}  // namespace beltrami
