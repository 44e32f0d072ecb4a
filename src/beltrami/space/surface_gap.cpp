#include <beltrami/space/surface_gap.h>

#include <algorithm>

#include <beltrami/base/parallel.h>
#include <beltrami/locate/nearest_on_triangle.h>
#include <beltrami/locate/surface_locator.h>

namespace beltrami {

namespace {

constexpr int kGrain = 256;

using Vector3 = Eigen::Vector3d;

double distance_from(const Vector3& point, const Vector3& a, const Vector3& b, const Vector3& c) {
    const std::array<double, 3> weights = nearest_weights(point, a, b, c);
    return (weights[0] * a + weights[1] * b + weights[2] * c - point).norm();
}

}  // namespace

SurfaceGap::SurfaceGap(const Mesh& start, const Target& target)
    : faces_(start.faces), target_(target), start_(start.vertex_count(), 3) {
    for (int v = 0; v < start.vertex_count(); ++v) start_.row(v) = start.point(v);
    for (int f = 0; f < faces_.size(); ++f) only_triangles_ = only_triangles_ && faces_.degree(f) == 3;
    std::vector<int> of_triangle;
    triangles_ = as_triangles(faces_, start_, of_triangle);
    middles_ = middles_of(triangles_);
    of_start_ = middles_;
    std::vector<char> seen(static_cast<std::size_t>(start.vertex_count()), 0);
    for (const int v : faces_.vertices()) {
        if (!seen[v]) of_start_.push_back({{v, -1, -1}, {v, -1, -1, -1}});
        seen[v] = 1;
    }
    near_image_.assign(of_start_.size(), -1);
}

/// Those of triangles, then those of edges, each once.
SurfaceGap::Samples SurfaceGap::middles_of(const Triangles& triangles) {
    struct Half {
        int low, high, opposite;
    };
    Samples samples;
    std::vector<Half> halves;
    samples.reserve(3 * triangles.size());
    halves.reserve(3 * triangles.size());
    for (const auto& [a, b, c] : triangles) {
        samples.push_back({{a, b, c}, {a, b, c, -1}});
        halves.push_back({std::min(a, b), std::max(a, b), c});
        halves.push_back({std::min(b, c), std::max(b, c), a});
        halves.push_back({std::min(c, a), std::max(c, a), b});
    }
    std::sort(halves.begin(), halves.end(), [](const Half& s, const Half& t) {
        return std::array{s.low, s.high, s.opposite} < std::array{t.low, t.high, t.opposite};
    });
    for (std::size_t i = 0; i < halves.size(); ++i) {
        const Half& half = halves[i];
        if (i > 0 && halves[i - 1].low == half.low && halves[i - 1].high == half.high)
            samples.back().around[3] = half.opposite;
        else
            samples.push_back({{half.low, half.high, -1}, {half.low, half.high, half.opposite, -1}});
    }
    return samples;
}

Vector3 SurfaceGap::point_of(const Sample& sample, const Positions& positions) {
    Vector3 sum = Vector3::Zero();
    double count = 0;
    for (const int v : sample.of) {
        if (v < 0) continue;
        sum += positions.row(v).transpose();
        ++count;
    }
    return sum / count;
}

/// @param far #of_start_
void SurfaceGap::from_start(const Positions& image, const Triangles& triangles, double distance,
                            std::vector<char>& far) {
    const auto corner = [&](int t, int j) -> Vector3 { return image.row(triangles[t][j]); };
    const int count = static_cast<int>(of_start_.size());
    parallel_for(
        0, count,
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const int t = near_image_[i];
                far[i] = t < 0 || !(distance_from(point_of(of_start_[i], start_), corner(t, 0), corner(t, 1),
                                                  corner(t, 2)) <= distance);
            }
        },
        kGrain);
    if (std::find(far.begin(), far.end(), 1) == far.end()) return;
    const SurfaceLocator locator(image, triangles);
    parallel_for(
        0, count,
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                if (!far[i]) continue;
                const SurfaceLocator::Place place = locator.nearest(point_of(of_start_[i], start_), near_image_[i]);
                near_image_[i] = place.triangle;
                far[i] = place.distance > distance;
            }
        },
        kGrain);
}

/// @param far #samples
void SurfaceGap::from_image(const Positions& image, const Samples& samples, double distance, std::vector<char>& far) {
    const Mesh* const mesh = target_.mesh();
    // Of quads that are cut along the other diagonal now the triangles remembered are others', but triangles still.
    near_target_.resize(samples.size());
    parallel_for(
        0, static_cast<int>(samples.size()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const Vector3 point = point_of(samples[i], image);
                Target::Point before;
                before.place = near_target_[i];
                if (mesh && before.place.face >= 0) {
                    const auto& [a, b, c] = before.place.vertices;
                    if (distance_from(point, mesh->point(a), mesh->point(b), mesh->point(c)) <= distance) continue;
                }
                const Target::Point nearest = mesh ? target_.retract(point, before) : target_.nearest(point);
                near_target_[i] = nearest.place;
                far[i] = (nearest.position - point).norm() > distance;
            }
        },
        kGrain);
}

std::vector<int> SurfaceGap::strayed(const Positions& image, double distance) {
    Triangles own;
    Samples of_image;
    if (!only_triangles_) {  // along the diagonals that the image's own shape asks for
        std::vector<int> of_triangle;
        own = as_triangles(faces_, image, of_triangle);
        of_image = middles_of(own);
    }
    const Samples& samples = only_triangles_ ? middles_ : of_image;
    std::vector<char> far(of_start_.size(), 0), far_image(samples.size(), 0);
    from_start(image, only_triangles_ ? triangles_ : own, distance, far);
    from_image(image, samples, distance, far_image);
    std::vector<char> at(static_cast<std::size_t>(image.rows()), 0);
    const auto blame = [&](const Sample& sample) {
        for (const int v : sample.around)
            if (v >= 0) at[v] = 1;
    };
    for (std::size_t i = 0; i < far.size(); ++i)
        if (far[i]) blame({{}, {of_start_[i].of[0], of_start_[i].of[1], of_start_[i].of[2], -1}});
    for (std::size_t i = 0; i < far_image.size(); ++i)
        if (far_image[i]) blame(samples[i]);
    std::vector<int> vertices;
    for (std::size_t v = 0; v < at.size(); ++v)
        if (at[v]) vertices.push_back(static_cast<int>(v));
    return vertices;
}

}  // namespace beltrami
