#include <beltrami/registration/transfer.h>

#include <algorithm>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

std::vector<MeshPoint> carried(const Positions& from, const SphereLocator& to, std::span<const MeshPoint> places) {
    std::vector<MeshPoint> result(places.size());
    parallel_for(0, static_cast<int>(places.size()), [&](int first, int last) {
        for (int i = first; i < last; ++i) result[i] = to.locate(sphere_place(from, places[i]));
    });
    return result;
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

}  // namespace

SurfaceCorrespondence::SurfaceCorrespondence(const Mesh& source, const Mesh& target, const Positions& target_sphere,
                                             std::span<const MeshPoint> places)
    : source_(source), target_(target), source_sphere_(source.vertex_count(), 3), target_sphere_(target_sphere) {
    if (static_cast<int>(places.size()) != source.vertex_count() || target_sphere.rows() != target.vertex_count())
        throw Error(Cause::bad_option, "the places or the sphere belong to other meshes",
                    "give a place for every vertex of the source, and a point for every vertex of the target");
    for (std::size_t v = 0; v < places.size(); ++v)
        source_sphere_.row(static_cast<Eigen::Index>(v)) = sphere_place(target_sphere_, places[v]);
    std::vector<int> faces, flipped;
    const std::vector<std::array<int, 3>> triangles = as_triangles(source_.faces, source_sphere_, faces);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto [a, b, c] = triangles[t];
        if (!(oriented_volume(source_sphere_.row(a), source_sphere_.row(b), source_sphere_.row(c)) > 0))
            flipped.push_back(faces[t]);
    }
    if (!flipped.empty())
        throw Error(Cause::bad_mesh, std::to_string(flipped.size()) + " faces are flipped between their places",
                    "give places that a registration of these two meshes wrote", {Things::faces, flipped});
    on_source_ = std::make_unique<SphereLocator>(source_.faces, source_sphere_);
    on_target_ = std::make_unique<SphereLocator>(target_.faces, target_sphere_);
}

SurfaceCorrespondence::~SurfaceCorrespondence() = default;
SurfaceCorrespondence::SurfaceCorrespondence(SurfaceCorrespondence&&) noexcept = default;
SurfaceCorrespondence& SurfaceCorrespondence::operator=(SurfaceCorrespondence&&) noexcept = default;

std::vector<MeshPoint> SurfaceCorrespondence::forward(std::span<const MeshPoint> places) const {
    return carried(source_sphere_, *on_target_, places);
}

std::vector<MeshPoint> SurfaceCorrespondence::back(std::span<const MeshPoint> places) const {
    return carried(target_sphere_, *on_source_, places);
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
    for (Eigen::Index f = 0; f < covered.size(); ++f)
        if (covered[f] > 0) result.row(f) /= covered[f];
    return result;
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
            const int first = source.faces.first_corner(there[i].face);
            const auto of_face = source.faces[there[i].face];
            Eigen::RowVector2d point = Eigen::RowVector2d::Zero();
            for (int j = 0; j < 3; ++j) {
                const auto at = std::find(of_face.begin(), of_face.end(), there[i].vertices[j]) - of_face.begin();
                const int number = source.texture->corners[static_cast<std::size_t>(first + at)];
                if (number < 0)
                    throw Error(Cause::bad_mesh,
                                "a corner of face " + std::to_string(there[i].face) + " has no texture point",
                                "give every corner one", {Things::faces, {there[i].face}});
                point += there[i].barycentric[j] * source.texture->points.row(number);
            }
            const int corner = target.faces.first_corner(f) + static_cast<int>(i);
            result.points.row(corner) = point;
            result.corners.push_back(corner);
        }
    }
    return result;
}

}  // namespace beltrami
