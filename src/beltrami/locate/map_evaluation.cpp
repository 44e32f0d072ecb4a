#include <beltrami/locate/map_evaluation.h>

#include <algorithm>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/mesh/quad_split.h>

namespace beltrami {

namespace {

constexpr int kPointsPerChunk = 256;

Positions images_of_corners(const Mesh& source, const Eigen::VectorXcd& map) {
    if (map.size() != source.vertex_count())
        throw Error(Cause::bad_option, "the map has " + std::to_string(map.size()) + " images for " +
                                           std::to_string(source.vertex_count()) + " vertices");
    Positions corners(source.faces.corner_count(), 2);
    for (int c = 0; c < source.faces.corner_count(); ++c) {
        const Complex image = map[source.faces.vertices()[c]];
        corners.row(c) << image.real(), image.imag();
    }
    return corners;
}

}  // namespace

MapEvaluation::MapEvaluation(const Mesh& source, const Eigen::VectorXcd& map) : MapEvaluation(source) {
    take(images_of_corners(source, map));
}

MapEvaluation MapEvaluation::of_corners(const Mesh& source, const Positions& corner_images) {
    MapEvaluation result(source);
    result.take(corner_images);
    return result;
}

void MapEvaluation::take(const Positions& corner_images) {
    if (source_.faces.empty()) throw Error(Cause::bad_mesh, "a mesh without faces has no points to be mapped");
    if (corner_images.rows() != source_.faces.corner_count() || corner_images.cols() != 2)
        throw Error(Cause::bad_option, "the images do not fit the corners of the mesh",
                    "give one point of two coordinates for each face corner");
    if (!corner_images.allFinite()) throw Error(Cause::bad_option, "the map is not finite");
    number_images(corner_images);
    divide();
}

/// Corners of a vertex with one image share it, so that edges are known to be inside the image.
void MapEvaluation::number_images(const Positions& corner_images) {
    std::vector<std::vector<int>> of_vertex(static_cast<std::size_t>(source_.vertex_count()));
    for (int c = 0; c < source_.faces.corner_count(); ++c) {
        const Complex image(corner_images(c, 0), corner_images(c, 1));
        std::vector<int>& known = of_vertex[source_.faces.vertices()[c]];
        auto same = std::find_if(known.begin(), known.end(), [&](int i) { return images_[i] == image; });
        if (same == known.end()) {
            known.push_back(static_cast<int>(images_.size()));
            images_.push_back(image);
            same = known.end() - 1;
        }
        image_of_corner_.push_back(*same);
    }
}

void MapEvaluation::divide() {
    Mesh image;
    image.positions.resize(static_cast<Eigen::Index>(images_.size()), 2);
    for (std::size_t i = 0; i < images_.size(); ++i)
        image.positions.row(static_cast<Eigen::Index>(i)) << images_[i].real(), images_[i].imag();
    const auto add = [&](int face, std::array<int, 3> corners) {
        const int first = source_.faces.first_corner(face);
        std::array<int, 3> vertices, points;
        for (int j = 0; j < 3; ++j) {
            vertices[j] = source_.faces[face][corners[j]];
            points[j] = image_of_corner_[first + corners[j]];
        }
        face_of_triangle_.push_back(face);
        triangles_.push_back(vertices);
        image.faces.add(points);
    };
    for (int f = 0; f < source_.face_count(); ++f) {
        if (source_.faces.degree(f) == 3) {
            add(f, {0, 1, 2});
            continue;
        }
        const auto at = [&](int j) { return images_[image_of_corner_[source_.faces.first_corner(f) + j]]; };
        for (const std::array<int, 3>& triangle : split_inside({at(0), at(1), at(2), at(3)})) add(f, triangle);
    }
    in_image_.emplace(image);
    on_source_.emplace(source_.positions, triangles_);
}

MeshPoint MapEvaluation::place(int triangle, const std::array<double, 3>& barycentric) const {
    return {face_of_triangle_[triangle], triangles_[triangle], barycentric};
}

Complex MapEvaluation::image(const MeshPoint& place) const {
    const auto face = source_.faces[place.face];
    const int first = source_.faces.first_corner(place.face);
    Complex sum = 0;
    for (int j = 0; j < 3; ++j) {
        const auto corner = std::find(face.begin(), face.end(), place.vertices[j]) - face.begin();
        sum += place.barycentric[j] * images_[image_of_corner_[first + static_cast<int>(corner)]];
    }
    return sum;
}

std::optional<MeshPoint> MapEvaluation::preimage(Complex point, double tolerance) const {
    const MeshPoint found = in_image_->nearest(point);  // a triangle of the image
    if (found.face < 0) return {};
    Complex there = 0;
    for (int j = 0; j < 3; ++j) there += found.barycentric[j] * images_[found.vertices[j]];
    if (!(std::abs(there - point) <= tolerance * in_image_->diameter())) return {};
    return place(found.face, found.barycentric);
}

std::vector<MeshPoint> MapEvaluation::preimages(std::span<const Complex> points, double tolerance) const {
    std::vector<MeshPoint> places(points.size());
    std::vector<char> outside(points.size(), 0);
    parallel_for(
        0, static_cast<int>(points.size()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const std::optional<MeshPoint> found = preimage(points[i], tolerance);
                outside[i] = !found;
                if (found) places[i] = *found;
            }
        },
        kPointsPerChunk);
    std::vector<int> far;
    for (int i = 0; i < static_cast<int>(points.size()); ++i)
        if (outside[i]) far.push_back(i);
    if (!far.empty())
        throw Error(Cause::bad_boundary,
                    std::to_string(far.size()) + (far.size() == 1 ? " point lies" : " points lie") +
                        " outside the image of the map, the first is point " + std::to_string(far[0]),
                    "only points of the image have a place on the source", {Things::points, far});
    return places;
}

MapEvaluation::Nearest MapEvaluation::nearest(const Eigen::Vector3d& point) const {
    const SurfaceLocator::Place found = on_source_->nearest(point);
    return {place(found.triangle, found.barycentric), found.distance};
}

}  // namespace beltrami
