#include <beltrami/unfold/sphere_repair.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/edge_table.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr int kMostRings = 8, kMostEvenRings = 32;
constexpr double kHemisphere = 0.05;   // least cosine of the angle from a patch' middle to its vertices
constexpr double kLeastWeight = 1e-3;  // of a face, relative to the median, where folds are opened
constexpr int kUnfoldingSteps = 200;

/// The faces at every vertex.
class FacesAround {
  public:
    FacesAround(const FaceList& faces, int vertex_count) : starts_(static_cast<std::size_t>(vertex_count) + 1, 0) {
        for (const int v : faces.vertices()) ++starts_[v + 1];
        for (int v = 0; v < vertex_count; ++v) starts_[v + 1] += starts_[v];
        faces_.resize(faces.vertices().size());
        std::vector<int> filled(starts_.begin(), starts_.end() - 1);
        for (int f = 0; f < faces.size(); ++f)
            for (const int v : faces[f]) faces_[filled[v]++] = f;
    }
    std::span<const int> operator[](int vertex) const {
        return {faces_.data() + starts_[vertex], static_cast<std::size_t>(starts_[vertex + 1] - starts_[vertex])};
    }

  private:
    std::vector<int> starts_, faces_;
};

/// A part of the map in the plane: the faces around some vertices, which may move.
struct Patch {
    Submesh part;
    std::vector<char> moves;  // per vertex of the part
    GnomonicChart chart;
    Eigen::VectorXcd plane;  // of the part's vertices
};

class Repair {
  public:
    Repair(const Surface& source, const SphereFaces& faces, Positions& points, std::span<const int> held)
        : source_(source),
          faces_(faces),
          points_(points),
          around_(source.mesh.faces, source.mesh.vertex_count()),
          held_(static_cast<std::size_t>(source.mesh.vertex_count()), 0) {
        for (const int v : held) held_[v] = 1;
    }

    SphereRepair run() {
        result_.flipped = faces_.flipped(points_);
        for (int rings = 1; rings <= kMostRings && !result_.flipped.empty(); ++rings)
            pass(rings, result_.averaged,
                 [&](const Patch& patch) { return averaged(patch, ConvexWeights::mean_value); });
        for (int rings = 2; rings <= kMostRings && !result_.flipped.empty(); rings += 2)
            pass(rings, result_.unfolded, [&](const Patch& patch) { return unfolded(patch); });
        for (int rings = 1; rings <= kMostEvenRings && !result_.flipped.empty(); rings *= 2)
            pass(rings, result_.averaged, [&](const Patch& patch) { return averaged(patch, ConvexWeights::uniform); });
        return std::move(result_);
    }

  private:
    /// Tries one method on every patch around flipped faces; keeps what leaves fewer of them flipped.
    template <class Method>
    void pass(int rings, int& moved, Method&& method) {
        for (const std::vector<int>& vertices : patches(rings)) {
            const std::optional<Patch> patch = patch_of(vertices);
            if (!patch) continue;
            const std::optional<Eigen::VectorXcd> plane = method(*patch);
            if (!plane || !plane->allFinite()) continue;
            const auto flips = [&] {
                return std::ranges::count_if(patch->part.faces, [&](int f) { return !faces_.upright(f, points_); });
            };
            const auto before = flips();
            Positions old(static_cast<Eigen::Index>(vertices.size()), 3);
            for (std::size_t i = 0; i < vertices.size(); ++i) old.row(i) = points_.row(vertices[i]);
            for (std::size_t v = 0; v < patch->moves.size(); ++v)
                if (patch->moves[v]) points_.row(patch->part.vertices[v]) = patch->chart.point((*plane)[v]);
            if (flips() < before) {
                moved += static_cast<int>(vertices.size());
            } else {
                for (std::size_t i = 0; i < vertices.size(); ++i) points_.row(vertices[i]) = old.row(i);
            }
        }
        result_.flipped = faces_.flipped(points_);
    }

    /// Vertices of flipped faces with some rings around them, in connected sets, each ascending.
    std::vector<std::vector<int>> patches(int rings) const {
        std::vector<char> marked(static_cast<std::size_t>(source_.mesh.vertex_count()), 0);
        std::vector<int> vertices;
        const auto mark = [&](int face) {
            for (const int v : source_.mesh.faces[face])
                if (!std::exchange(marked[v], 1)) vertices.push_back(v);
        };
        for (const int f : result_.flipped) mark(f);
        for (int ring = 1; ring < rings; ++ring) {
            const std::size_t count = vertices.size();
            for (std::size_t i = 0; i < count; ++i)
                for (const int f : around_[vertices[i]]) mark(f);
        }
        std::ranges::sort(vertices);
        DisjointSets sets(source_.mesh.vertex_count());
        for (const int v : vertices)
            for (const int f : around_[v])
                for (const int w : source_.mesh.faces[f])
                    if (marked[w]) sets.join(v, w);
        std::vector<int> number(marked.size(), -1);
        std::vector<std::vector<int>> result;
        for (const int v : vertices) {
            int& of_set = number[sets.find(v)];
            if (of_set < 0) {
                of_set = static_cast<int>(result.size());
                result.emplace_back();
            }
            result[of_set].push_back(v);
        }
        return result;
    }

    /// The faces around the vertices; also those around others at which these would come apart, so that they are a
    /// manifold. Nothing if they do not fit in a hemisphere.
    std::optional<Patch> patch_of(const std::vector<int>& vertices) const {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const int v : vertices) middle += points_.row(v).transpose();
        if (!(middle.norm() > 0)) return {};
        middle.normalize();
        std::vector<int> faces, centres = vertices;
        Submesh part;
        while (!centres.empty()) {
            for (const int v : centres) faces.insert(faces.end(), around_[v].begin(), around_[v].end());
            std::ranges::sort(faces);
            faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
            part = keep_faces(source_.mesh, faces);
            for (const int v : part.vertices)
                if (!(points_.row(v).dot(middle) > kHemisphere)) return {};
            const EdgeTable table = edge_table(part.mesh.faces, part.mesh.vertex_count());
            centres = non_manifold_vertices(part.mesh.faces, table, part.mesh.vertex_count());
            for (int& v : centres) v = part.vertices[v];
        }
        Patch patch{std::move(part), {}, GnomonicChart(middle), {}};
        patch.plane.resize(static_cast<Eigen::Index>(patch.part.vertices.size()));
        for (std::size_t v = 0; v < patch.part.vertices.size(); ++v) {
            const int whole = patch.part.vertices[v];
            patch.plane[v] = patch.chart(points_.row(whole));
            patch.moves.push_back(!held_[whole] && std::ranges::binary_search(vertices, whole));
        }
        return patch;
    }

    /// The corners of the patch' faces in the source's metric.
    Positions corners_of(const Patch& patch) const {
        const FaceList& faces = source_.mesh.faces;
        if (!source_.metric) return corner_positions(patch.part.mesh);
        Positions corners(patch.part.mesh.faces.corner_count(), source_.metric->cols());
        for (std::size_t f = 0; f < patch.part.faces.size(); ++f)
            corners.middleRows(patch.part.mesh.faces.first_corner(static_cast<int>(f)),
                               faces.degree(patch.part.faces[f])) =
                source_.metric->middleRows(faces.first_corner(patch.part.faces[f]), faces.degree(patch.part.faces[f]));
        return corners;
    }

    std::optional<Eigen::VectorXcd> averaged(const Patch& patch, ConvexWeights weights) const {
        BoundaryCondition rim;
        for (std::size_t v = 0; v < patch.moves.size(); ++v)
            if (!patch.moves[v]) rim.pin(static_cast<int>(v), patch.plane[v]);
        if (rim.empty()) return {};
        try {
            return convex_combination_map(Surface(patch.part.mesh, corners_of(patch)), rim, weights);
        } catch (const Error&) {
            return {};  // singular to rounding
        }
    }

    std::optional<Eigen::VectorXcd> unfolded(const Patch& patch) const {
        const FaceList& faces = patch.part.mesh.faces;
        Positions corners = corners_of(patch);
        std::vector<Freedom> freedoms;
        freedoms.reserve(patch.moves.size());
        for (const char moves : patch.moves) freedoms.push_back(moves ? Freedom::free : Freedom::fixed);
        // Faces differ in size by orders of magnitude: each is measured in units of its own.
        const auto longest = [](int degree, auto&& point) {
            double length = 0;
            for (int i = 0; i < degree; ++i) length = std::max(length, (point((i + 1) % degree) - point(i)).norm());
            return length;
        };
        for (int f = 0; f < faces.size(); ++f) {
            const int first = faces.first_corner(f), degree = faces.degree(f);
            const double source_length = longest(degree, [&](int i) { return corners.row(first + i).eval(); });
            const double image_length = longest(degree, [&](int i) {
                const Complex z = patch.plane[faces[f][i]];
                return Eigen::Vector2d(z.real(), z.imag());
            });
            corners.middleRows(first, degree) *= image_length / source_length;
        }
        try {
            Surface surface(patch.part.mesh, std::move(corners));
            weigh(surface, patch);
            FoldFreeOptions options;
            options.max_iterations = kUnfoldingSteps;
            options.tolerance = 1e-2;
            return fold_free_map(surface, freedoms, Eigen::VectorXcd::Zero(surface.operators.sample_count()),
                                 patch.plane, options)
                .map;
        } catch (const Error&) {
            return {};
        }
    }

    /// Faces count by their area in the source up to the median, not by that in the image.
    void weigh(Surface& surface, const Patch& patch) const {
        std::vector<double> areas(patch.part.faces.size(), 0.0);
        std::vector<int> number(static_cast<std::size_t>(source_.mesh.face_count()), -1);
        for (std::size_t f = 0; f < patch.part.faces.size(); ++f) number[patch.part.faces[f]] = static_cast<int>(f);
        const Operators& operators = source_.operators;
        for (int s = 0; s < operators.sample_count(); ++s)
            if (const int f = number[operators.faces[s]]; f >= 0) areas[f] += operators.weights[s];
        std::vector<double> sorted = areas;
        std::ranges::nth_element(sorted, sorted.begin() + sorted.size() / 2);
        const double median = sorted[sorted.size() / 2];
        for (int s = 0; s < surface.operators.sample_count(); ++s) {
            const int f = surface.operators.faces[s];
            const double share = surface.mesh.faces.degree(f) == 4 ? 0.25 : 1.0;
            surface.operators.weights[s] = share * std::clamp(areas[f] / median, kLeastWeight, 1.0);
        }
    }

    const Surface& source_;
    const SphereFaces& faces_;
    Positions& points_;
    FacesAround around_;
    std::vector<char> held_;  // #V
    SphereRepair result_;
};

}  // namespace

SphereRepair repair_sphere_map(const Surface& source, const SphereFaces& faces, Positions& points,
                               std::span<const int> held) {
    return Repair(source, faces, points, held).run();
}

}  // namespace beltrami
