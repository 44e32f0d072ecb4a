#include <beltrami/flow/unfolded_patches.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/solve/image_frame.h>
#include <beltrami/solve/target_step.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr int kRings[] = {2, 4, 8, 16};
constexpr double kFacing = 0.2;  // of normals of a patch along that of its middle, at least
constexpr double kUnfolded = 1e-3;
constexpr int kMostSteps = 100;

std::vector<char> flipped_faces(const Operators& operators, const TargetMap& map, int faces) {
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    std::vector<char> result(static_cast<std::size_t>(faces), 0);
    for (int s = 0; s < operators.sample_count(); ++s)
        if (!image_frame(operators, s, points, normals).upright) result[operators.faces[s]] = 1;
    return result;
}

/// Faces around faces.
class Neighbourhoods {
  public:
    explicit Neighbourhoods(const Mesh& mesh) : mesh_(mesh), faces_at_(static_cast<std::size_t>(mesh.vertex_count())) {
        for (int f = 0; f < mesh.face_count(); ++f)
            for (const int v : mesh.faces[f]) faces_at_[v].push_back(f);
    }
    /// The faces within so many rings of some, ascending.
    std::vector<int> within(std::vector<int> faces, int rings) const {
        std::set<int> found(faces.begin(), faces.end());
        for (int ring = 0; ring < rings; ++ring) {
            std::vector<int> next;
            for (const int f : faces)
                for (const int v : mesh_.faces[f])
                    for (const int g : faces_at_[v])
                        if (found.insert(g).second) next.push_back(g);
            faces = std::move(next);
        }
        return {found.begin(), found.end()};
    }

  private:
    const Mesh& mesh_;
    std::vector<std::vector<int>> faces_at_;
};

/// Flipped faces that lie together, ascending.
std::vector<std::vector<int>> clusters_of(const Neighbourhoods& around, const std::vector<char>& flipped) {
    std::vector<std::vector<int>> clusters;
    std::vector<char> seen(flipped.size(), 0);
    for (std::size_t f = 0; f < flipped.size(); ++f) {
        if (!flipped[f] || seen[f]) continue;
        std::vector<int> cluster{static_cast<int>(f)};
        seen[f] = 1;
        for (std::size_t i = 0; i < cluster.size(); ++i)
            for (const int g : around.within({cluster[i]}, 1))
                if (flipped[g] && !std::exchange(seen[g], 1)) cluster.push_back(g);
        clusters.push_back(std::move(cluster));
    }
    return clusters;
}

/// Points of a target in the tangent plane at one of them, along their own normals, and back: of the sphere the central
/// projection, which keeps the orientation of faces exactly.
class TangentChart {
  public:
    TangentChart(const Target& target, const Target::Point& middle)
        : target_(target), middle_(middle), frame_(middle.normal) {}
    /// Nothing for points that face elsewhere.
    std::optional<Complex> operator()(const Target::Point& point) const {
        const double facing = point.normal.dot(middle_.normal);
        if (facing < kFacing) return {};
        const Eigen::Vector3d from = point.position - middle_.position,
                              there = from - from.dot(middle_.normal) / facing * point.normal;
        return Complex(there.dot(frame_.first), there.dot(frame_.second));
    }
    Target::Point point(Complex z) const {
        return target_.nearest(middle_.position + z.real() * frame_.first + z.imag() * frame_.second);
    }

  private:
    const Target& target_;
    Target::Point middle_;
    TangentFrame frame_;
};

/// Of patches that reach around the sphere: the stereographic projection from the point opposite.
class StereographicChart {
  public:
    explicit StereographicChart(const Target::Point& middle) : middle_(middle.normal), frame_(middle.normal) {}
    std::optional<Complex> operator()(const Target::Point& point) const {
        const double height = 1 + point.position.dot(middle_);
        if (height < kFacing) return {};
        return Complex(point.position.dot(frame_.first), point.position.dot(frame_.second)) / height;
    }
    Target::Point point(Complex z) const {
        const double square = std::norm(z);
        const Eigen::Vector3d on_sphere =
            (2 * z.real() * frame_.first + 2 * z.imag() * frame_.second + (1 - square) * middle_) / (1 + square);
        return SphereTarget().nearest(on_sphere);
    }

  private:
    Eigen::Vector3d middle_;
    TangentFrame frame_;
};

/// #V of a patch in the plane; nothing where the chart does not reach.
template <class Chart>
std::optional<Eigen::VectorXcd> in_plane(const Chart& chart, const TargetMap& map, const std::vector<int>& vertices) {
    Eigen::VectorXcd plane(static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::optional<Complex> z = chart(map.points[vertices[i]]);
        if (!z) return {};
        plane[static_cast<Eigen::Index>(i)] = *z;
    }
    return plane;
}

/// The middle of the images of faces.
Target::Point middle_of(const Mesh& mesh, const std::vector<int>& faces, const Target& target, const TargetMap& map) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (const int f : faces)
        for (const int v : mesh.faces[f]) sum += map.points[v].position, ++count;
    return target.nearest(sum / std::max(count, 1));
}

/// The map with one patch unfolded in a chart; nothing where that cannot be tried.
template <class Chart>
std::optional<TargetMap> with_patch(const Chart& chart, const std::vector<char>& held, const TargetMap& map,
                                    const Submesh& patch) {
    const std::optional<Eigen::VectorXcd> plane = in_plane(chart, map, patch.vertices);
    if (!plane) return {};
    FoldFreeOptions options;
    options.tolerance = kUnfolded;
    options.max_iterations = kMostSteps;
    TargetMap result = map;
    try {
        const Surface part(patch.mesh);
        std::vector<Freedom> freedoms(patch.vertices.size(), Freedom::free);
        std::size_t moving = 0;
        for (std::size_t i = 0; i < freedoms.size(); ++i)
            if (held[patch.vertices[i]] || part.topology.on_boundary[i])
                freedoms[i] = Freedom::fixed;
            else
                ++moving;
        if (moving == 0 || 2 * moving > held.size()) return {};
        const Eigen::VectorXcd opened =
            fold_free_map(part, freedoms, Eigen::VectorXcd::Zero(part.operators.sample_count()), *plane, options).map;
        for (std::size_t i = 0; i < freedoms.size(); ++i)
            if (freedoms[i] == Freedom::free)
                result.points[patch.vertices[i]] = chart.point(opened[static_cast<Eigen::Index>(i)]);
    } catch (const Error& error) {  // patches may touch themselves at a vertex
        if (error.cause() != Cause::bad_boundary && error.cause() != Cause::not_solved &&
            error.cause() != Cause::bad_mesh)
            throw;
        return {};
    }
    return result;
}

std::optional<TargetMap> with_patch(const Target& target, const std::vector<char>& held, const TargetMap& map,
                                    const Submesh& patch, const Target::Point& middle) {
    std::optional<TargetMap> result = with_patch(TangentChart(target, middle), held, map, patch);
    if (!result && dynamic_cast<const SphereTarget*>(&target) != nullptr)
        result = with_patch(StereographicChart(middle), held, map, patch);
    return result;
}

}  // namespace

int unfold_flipped_patches(const Surface& source, const Target& target, const std::vector<char>& held, TargetMap& map) {
    int flips = flipped_samples(source.operators, map);
    if (flips == 0) return 0;
    const Neighbourhoods around(source.mesh);
    for (const int rings : kRings) {
        const std::vector<char> flipped = flipped_faces(source.operators, map, source.mesh.face_count());
        for (const std::vector<int>& cluster : clusters_of(around, flipped)) {
            std::optional<TargetMap> trial =
                with_patch(target, held, map, keep_faces(source.mesh, around.within(cluster, rings)),
                           middle_of(source.mesh, cluster, target, map));
            if (!trial) continue;
            const int now = flipped_samples(source.operators, *trial);
            if (now >= flips) continue;
            flips = now;
            map = std::move(*trial);
        }
        if (flips == 0) break;
    }
    return flips;
}

}  // namespace beltrami
