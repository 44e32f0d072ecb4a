#include <beltrami/registration/drawn_surface.h>

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

using Weights = std::array<double, 3>;

constexpr std::array<Weights, 3> kCorners{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Weights of parts' corners for a place of the whole; the least of them is the larger the farther inside it lies.
Eigen::Vector3d within(const std::array<Weights, 3>& corners, const Weights& place) {
    Eigen::Matrix3d matrix;
    for (int i = 0; i < 3; ++i) matrix.col(i) = Eigen::Map<const Eigen::Vector3d>(corners[i].data());
    return matrix.inverse() * Eigen::Map<const Eigen::Vector3d>(place.data());
}

}  // namespace

DrawnSurface::DrawnSurface(const FaceList& faces, Positions points, On on, std::span<const BoundaryPoint> bends)
    : points_(std::move(points)), on_(on) {
    wholes_ = as_triangles(faces, points_, face_of_whole_);
    first_of_face_.assign(static_cast<std::size_t>(faces.size()) + 1, static_cast<int>(wholes_.size()));
    for (std::size_t w = wholes_.size(); w-- > 0;) first_of_face_[face_of_whole_[w]] = static_cast<int>(w);
    const Eigen::Index own = points_.rows();
    points_.conservativeResize(own + static_cast<Eigen::Index>(bends.size()), 3);
    std::map<std::array<int, 2>, std::vector<int>> of_edge;
    for (std::size_t i = 0; i < bends.size(); ++i) {
        points_.row(own + static_cast<Eigen::Index>(i)) = bends[i].point;
        of_edge[bends[i].edge].push_back(static_cast<int>(i));
    }
    for (auto& [edge, list] : of_edge)
        std::sort(list.begin(), list.end(), [&](int a, int b) { return bends[a].fraction < bends[b].fraction; });

    for (std::size_t w = 0; w < wholes_.size(); ++w) {
        const int whole = static_cast<int>(w);
        first_part_.push_back(static_cast<int>(parts_.size()));
        Polygon around;
        int bent = 0, last_bent = 0;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            around.push_back({wholes_[w][i], kCorners[i]});
            const auto found = of_edge.find({wholes_[w][i], wholes_[w][j]});
            if (found == of_edge.end()) continue;
            ++bent;
            last_bent = i;
            for (const int b : found->second) {
                Corner corner{static_cast<int>(own) + b, {0, 0, 0}};
                corner.weights[i] = 1 - bends[b].fraction;
                corner.weights[j] = bends[b].fraction;
                around.push_back(corner);
            }
        }
        if (bent == 1) {
            // From the corner opposite to the edge: the polygon begins behind that.
            const Corner apex{wholes_[w][(last_bent + 2) % 3], kCorners[(last_bent + 2) % 3]};
            const auto at = std::find_if(around.begin(), around.end(),
                                         [&](const Corner& corner) { return corner.vertex == apex.vertex; });
            std::rotate(around.begin(), at, around.end());
            if (add_fan(whole, apex, {around.begin() + 1, around.end()}, false)) continue;
        }
        if (bent > 0) add_centre(whole, around);
        if (static_cast<int>(parts_.size()) > first_part_.back()) continue;
        parts_.push_back({whole, kCorners});
        triangles_.add(wholes_[w]);
    }
    first_part_.push_back(static_cast<int>(parts_.size()));
    locator_.emplace(triangles_, points_);
}

/// Adds triangles from an apex to the sides of a polygon, if all of them run around as they should. @return whether
bool DrawnSurface::add_fan(int whole, const Corner& apex, const Polygon& around, bool closed) {
    const std::size_t n = around.size(), sides = closed ? n : n - 1;
    for (std::size_t i = 0; i < sides; ++i)
        if (!(oriented_volume(points_.row(apex.vertex), points_.row(around[i].vertex),
                              points_.row(around[(i + 1) % n].vertex)) > 0))
            return false;
    for (std::size_t i = 0; i < sides; ++i) {
        const Corner &a = around[i], &b = around[(i + 1) % n];
        parts_.push_back({whole, {apex.weights, a.weights, b.weights}});
        triangles_.add({apex.vertex, a.vertex, b.vertex});
    }
    return true;
}

/// The same from a new point in the middle.
void DrawnSurface::add_centre(int whole, const Polygon& around) {
    const Eigen::Index number = points_.rows();
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (const int v : wholes_[whole]) middle += points_.row(v) / 3;
    points_.conservativeResize(number + 1, 3);
    points_.row(number) = project(middle);
    const Corner centre{static_cast<int>(number), {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    if (!add_fan(whole, centre, around, true)) points_.conservativeResize(number, 3);
}

std::vector<int> DrawnSurface::flipped() const {
    std::vector<int> result;
    for (int t = 0; t < triangle_count(); ++t) {
        const auto& [a, b, c] = triangle(t);
        const int face = face_of_whole_[parts_[t].whole];
        if (!(oriented_volume(points_.row(a), points_.row(b), points_.row(c)) > 0) &&
            (result.empty() || result.back() != face))
            result.push_back(face);
    }
    return result;
}

Eigen::Vector3d DrawnSurface::project(const Eigen::Vector3d& mean) const {
    return on_ == On::sphere ? mean.normalized() : Eigen::Vector3d(mean / mean.z());
}

Eigen::Vector3d DrawnSurface::point_of(const MeshPoint& place) const {
    const auto mean = [&](const std::array<int, 3>& vertices, const Weights& weights) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3; ++i) sum += weights[i] * point(vertices[i]);
        return project(sum);
    };
    for (int w = first_of_face_[place.face]; w < first_of_face_[place.face + 1]; ++w) {
        if (first_part_[w + 1] == first_part_[w] + 1) continue;
        Weights weights{};
        bool same = true;
        for (int i = 0; i < 3 && same; ++i) {
            const auto at = std::find(wholes_[w].begin(), wholes_[w].end(), place.vertices[i]) - wholes_[w].begin();
            same = at < 3;
            if (same) weights[at] = place.barycentric[i];
        }
        if (!same) continue;  // the other half of a quad, or its other diagonal
        int best = first_part_[w];
        double most = -2;
        Weights of_part{};
        for (int t = first_part_[w]; t < first_part_[w + 1]; ++t) {
            const Eigen::Vector3d inside = within(parts_[t].corners, weights);
            if (!(inside.minCoeff() > most)) continue;
            most = inside.minCoeff();
            best = t;
            of_part = {inside[0], inside[1], inside[2]};
        }
        return mean(triangle(best), of_part);
    }
    return mean(place.vertices, place.barycentric);
}

MeshPoint DrawnSurface::of_face(int t, const Weights& weights) const {
    const Part& part = parts_[t];
    Weights of_whole{0, 0, 0};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) of_whole[j] += weights[i] * part.corners[i][j];
    return {face_of_whole_[part.whole], wholes_[part.whole], of_whole};
}

MeshPoint DrawnSurface::locate(const Eigen::Vector3d& point) const {
    const MeshPoint found = locator_->locate(point);
    return of_face(found.face, found.barycentric);
}

Eigen::Vector3d DrawnSurface::middle(int t) const {
    const auto& [a, b, c] = triangle(t);
    return project((point(a) + point(b) + point(c)) / 3);
}

MeshPoint DrawnSurface::place_in(int t, const Eigen::Vector3d& point) const {
    return of_face(t, locator_->place_in(t, point).barycentric);
}

}  // namespace beltrami
