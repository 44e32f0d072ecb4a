#include <beltrami/applications/handled_surface.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/element_system.h>
#include <beltrami/space/corner_elements.h>

namespace beltrami {

namespace {

constexpr int kExpectedFactorizations = 1;
constexpr double kSettled = 1e-4;  // of the diagonal: motion in one iteration

/// Rows of the cotangent Laplacian: for every vertex its neighbours with their entries, itself among them.
std::vector<std::map<int, double>> laplacian_rows(const Operators& operators) {
    std::vector<std::map<int, double>> rows(static_cast<std::size_t>(operators.vertex_count));
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto v = operators.stencil(s);
        const auto g = operators.gradient(s);
        for (std::size_t j = 0; j < v.size(); ++j)
            for (std::size_t k = 0; k < v.size(); ++k)
                rows[v[j]][v[k]] += operators.weights[s] * (std::conj(g[j]) * g[k]).real();
    }
    return rows;
}

/// Lower triangle of the matrix l lᵀ scaled.
std::vector<double> outer_product(const std::vector<double>& l, double scale) {
    std::vector<double> lower;
    for (std::size_t i = 0; i < l.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j) lower.push_back(scale * l[i] * l[j]);
    return lower;
}

double diagonal_of(const Positions& points) {
    return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& covariance) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d v = svd.matrixV();
    if ((v * svd.matrixU().transpose()).determinant() < 0) v.col(2) *= -1;
    return v * svd.matrixU().transpose();
}

void require_handles_everywhere(const Surface& source, const std::vector<int>& handles) {
    DisjointSets sets(source.mesh.vertex_count());
    for (int f = 0; f < source.mesh.face_count(); ++f)
        for (const int v : source.mesh.faces[f]) sets.join(v, source.mesh.faces[f][0]);
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : handles) held[sets.find(v)] = 1;
    for (const int v : source.mesh.faces.vertices())
        if (!held[sets.find(v)])
            throw Error(Cause::bad_boundary, "the component of vertex " + std::to_string(v) + " has no handle",
                        "pin a vertex of every component", {Things::vertices, {v}});
}

}  // namespace

struct HandledSurface::Systems {
    std::vector<std::map<int, double>> rows;
    Eigen::VectorXd areas;
    Positions points;        // #V×3 of the source
    std::vector<int> place;  // #V among the free, −1 elsewhere
    std::unique_ptr<ElementSystem> plate, harmonic;

    /// Right hand sides of all columns in the free vertices.
    Eigen::MatrixXd free_rows(const Positions& values) const {
        Eigen::MatrixXd result(std::count_if(place.begin(), place.end(), [](int p) { return p >= 0; }), 3);
        for (std::size_t v = 0; v < place.size(); ++v)
            if (place[v] >= 0) result.row(place[v]) = values.row(static_cast<Eigen::Index>(v));
        return result;
    }
    Positions applied(const Positions& values) const {  // L values
        Positions result = Positions::Zero(values.rows(), 3);
        for (std::size_t v = 0; v < rows.size(); ++v)
            for (const auto& [w, entry] : rows[v]) result.row(static_cast<Eigen::Index>(v)) += entry * values.row(w);
        return result;
    }
    /// Writes a solution in the free vertices over values.
    void place_free(const Eigen::MatrixXd& solution, Positions& values) const {
        for (std::size_t v = 0; v < place.size(); ++v)
            if (place[v] >= 0) values.row(static_cast<Eigen::Index>(v)) += solution.row(place[v]);
    }
};

HandledSurface::HandledSurface(const Surface& source, std::vector<int> handles)
    : systems_(std::make_unique<Systems>()), source_(source), handles_(std::move(handles)) {
    require_handles_everywhere(source, handles_);
    const CornerElements elements = corner_elements(source.mesh);
    Systems& s = *systems_;
    s.rows = laplacian_rows(elements.operators);
    s.areas = vertex_areas(elements.operators);
    s.points.resize(source.mesh.vertex_count(), 3);
    for (int v = 0; v < source.mesh.vertex_count(); ++v) s.points.row(v) = source.mesh.point(v);
    std::vector<char> fixed(s.rows.size(), 0);
    for (const int v : handles_) fixed[v] = 1;
    int free = 0;
    for (std::size_t v = 0; v < fixed.size(); ++v) s.place.push_back(fixed[v] || s.rows[v].empty() ? -1 : free++);

    std::vector<int> offsets{0}, nodes;
    for (const auto& row : s.rows) {
        for (const auto& entry : row) nodes.push_back(s.place[entry.first]);
        offsets.push_back(static_cast<int>(nodes.size()));
    }
    s.plate = std::make_unique<ElementSystem>(offsets, nodes, free, kExpectedFactorizations);
    for (std::size_t v = 0; v < s.rows.size(); ++v) {
        if (s.rows[v].empty()) continue;
        std::vector<double> l;
        for (const auto& entry : s.rows[v]) l.push_back(entry.second);
        s.plate->add(static_cast<int>(v), outer_product(l, 1 / s.areas[static_cast<Eigen::Index>(v)]));
    }
    s.plate->factorize();
}

HandledSurface::~HandledSurface() = default;

Positions HandledSurface::thin_plate(const Positions& places) const {
    const Systems& s = *systems_;
    Positions displacement = Positions::Zero(s.points.rows(), 3);
    for (std::size_t i = 0; i < handles_.size(); ++i)
        displacement.row(handles_[i]) = places.row(static_cast<Eigen::Index>(i)) - s.points.row(handles_[i]);
    if (s.plate->unknown_count() > 0) {
        Positions bent = s.applied(displacement);
        for (Eigen::Index v = 0; v < bent.rows(); ++v)
            if (s.areas[v] > 0) bent.row(v) /= s.areas[v];
        s.place_free(s.plate->solve(-s.free_rows(s.applied(bent))), displacement);
    }
    return s.points + displacement;
}

Positions HandledSurface::as_rigid_as_possible(const Positions& places, Positions start, int iterations) const {
    Systems& s = *systems_;
    // Weights are those of the edges where positive, so that the system is one of them.
    std::vector<std::vector<std::pair<int, double>>> weights(s.rows.size());
    for (std::size_t v = 0; v < s.rows.size(); ++v)
        for (const auto& [w, entry] : s.rows[v])
            if (w != static_cast<int>(v) && entry < 0) weights[v].emplace_back(w, -entry);
    if (!s.harmonic) {
        std::vector<int> offsets{0}, nodes;
        std::vector<double> values;
        for (std::size_t v = 0; v < weights.size(); ++v)
            for (const auto& [w, weight] : weights[v]) {
                if (w < static_cast<int>(v)) continue;
                nodes.insert(nodes.end(), {s.place[v], s.place[w]});
                offsets.push_back(static_cast<int>(nodes.size()));
                values.push_back(weight);
            }
        const int free = static_cast<int>(std::count_if(s.place.begin(), s.place.end(), [](int p) { return p >= 0; }));
        s.harmonic =
            std::make_unique<ElementSystem>(std::move(offsets), std::move(nodes), free, kExpectedFactorizations);
        for (std::size_t e = 0; e < values.size(); ++e)
            s.harmonic->add(static_cast<int>(e), std::array<double, 3>{values[e], -values[e], values[e]});
        s.harmonic->factorize();
    }
    for (std::size_t i = 0; i < handles_.size(); ++i) start.row(handles_[i]) = places.row(static_cast<Eigen::Index>(i));
    if (s.harmonic->unknown_count() == 0) return start;
    const double settled = kSettled * diagonal_of(s.points);
    std::vector<Eigen::Matrix3d> rotation(s.rows.size());
    for (int iteration = 0; iteration < iterations; ++iteration) {
        parallel_for(
            0, static_cast<int>(rotation.size()),
            [&](int first, int last) {
                for (int v = first; v < last; ++v) {
                    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
                    for (const auto& [w, weight] : weights[v])
                        covariance +=
                            weight * (s.points.row(v) - s.points.row(w)).transpose() * (start.row(v) - start.row(w));
                    rotation[v] = rotation_of(covariance);
                }
            },
            kDefaultGrain / 16);
        Positions rest = Positions::Zero(start.rows(), 3);  // what the rotations want less what the positions have
        for (std::size_t v = 0; v < weights.size(); ++v) {
            const auto i = static_cast<Eigen::Index>(v);
            for (const auto& [w, weight] : weights[v])
                rest.row(i) +=
                    weight * (0.5 * (s.points.row(i) - s.points.row(w)) * (rotation[v] + rotation[w]).transpose() -
                              (start.row(i) - start.row(w)));
        }
        const Eigen::MatrixXd step = s.harmonic->solve(s.free_rows(rest));
        s.place_free(step, start);
        if (step.rowwise().norm().maxCoeff() < settled) break;
    }
    return start;
}

int HandledSurface::factorization_count() const {
    return systems_->plate->factorization_count() +
           (systems_->harmonic ? systems_->harmonic->factorization_count() : 0);
}

std::vector<std::array<int, 2>> fold_edges(const Surface& source, const Positions& image) {
    const Mesh mesh{image, source.mesh.faces, {}};
    std::vector<std::array<int, 2>> result;
    for (int e = 0; e < source.topology.edge_count(); ++e) {
        const auto [left, right] = source.topology.edge_faces[e];
        if (left < 0 || right < 0) continue;
        const bool before = face_vector_area(source.mesh, left).dot(face_vector_area(source.mesh, right)) > 0,
                   after = face_vector_area(mesh, left).dot(face_vector_area(mesh, right)) < 0;
        if (before && after) result.push_back(source.topology.edges[e]);
    }
    return result;
}

}  // namespace beltrami
