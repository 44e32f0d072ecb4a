#include <beltrami/unfold/convex_combination_map.h>

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/linear/graph_laplacian.h>

namespace beltrami {

namespace {

/// The numbers of the unknown vertices; −1 for the others.
struct Unknowns {
    explicit Unknowns(const std::vector<Freedom>& freedoms) : of(freedoms.size(), -1) {
        for (std::size_t v = 0; v < freedoms.size(); ++v)
            if (freedoms[v] != Freedom::fixed) of[v] = count++;
    }
    std::vector<int> of;
    int count = 0;
};

Eigen::VectorXcd with_solution(Eigen::VectorXcd map, const Unknowns& unknowns, const Eigen::MatrixXd& solution) {
    for (std::size_t v = 0; v < unknowns.of.size(); ++v)
        if (const int u = unknowns.of[v]; u >= 0) map[static_cast<Eigen::Index>(v)] = {solution(u, 0), solution(u, 1)};
    return map;
}

Eigen::VectorXcd uniform_map(const Surface& source, const Unknowns& unknowns, const Eigen::VectorXcd& fixed) {
    std::vector<char> held(unknowns.of.size());
    std::transform(unknowns.of.begin(), unknowns.of.end(), held.begin(), [](int u) { return u < 0; });
    GraphLaplacian laplacian(source.topology.edges, held);
    laplacian.set(std::vector<double>(source.topology.edges.size(), 1.0));
    laplacian.factorize();
    return laplacian.extend(fixed);
}

/// The position of a face corner in the metric.
Eigen::Vector3d corner_point(const Surface& source, int corner) {
    if (!source.metric) return source.mesh.point(source.mesh.faces.vertices()[corner]);
    const Positions& metric = *source.metric;
    return {metric(corner, 0), metric(corner, 1), metric.cols() > 2 ? metric(corner, 2) : 0.0};
}

Eigen::VectorXcd mean_value_map(const Surface& source, const Unknowns& unknowns, const Eigen::VectorXcd& fixed) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(unknowns.count, 2);
    const FaceList& faces = source.mesh.faces;
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f), degree = faces.degree(f);
        for (int i = 0; i < degree; ++i) {
            const int u = unknowns.of[faces[f][i]];
            if (u < 0) continue;
            const int next = (i + 1) % degree, previous = (i + degree - 1) % degree;
            const Eigen::Vector3d here = corner_point(source, first + i);
            const Eigen::Vector3d ahead = corner_point(source, first + next) - here,
                                  behind = corner_point(source, first + previous) - here;
            const double lengths[2] = {ahead.stableNorm(), behind.stableNorm()};
            const Eigen::Vector3d a = ahead / lengths[0], b = behind / lengths[1];
            const double tangent = std::tan(0.5 * std::atan2(a.cross(b).norm(), a.dot(b)));
            const int others[2] = {faces[f][next], faces[f][previous]};
            for (int side = 0; side < 2; ++side) {
                const double weight = tangent / lengths[side];
                entries.emplace_back(u, u, weight);
                if (const int w = unknowns.of[others[side]]; w >= 0) {
                    entries.emplace_back(u, w, -weight);
                } else {
                    rhs(u, 0) += weight * fixed[others[side]].real();
                    rhs(u, 1) += weight * fixed[others[side]].imag();
                }
            }
        }
    }
    Eigen::SparseMatrix<double> matrix(unknowns.count, unknowns.count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    // Rows are scaled: lengths differ from place to place.
    Eigen::VectorXd diagonal = matrix.diagonal();
    for (int column = 0; column < matrix.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry)
            entry.valueRef() /= diagonal[entry.row()];
    for (int column = 0; column < 2; ++column) rhs.col(column).array() /= diagonal.array();
    Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
    Eigen::MatrixXd solution;
    if (solver.info() == Eigen::Success) solution = solver.solve(rhs);
    if (solver.info() != Eigen::Success || !solution.allFinite())
        throw Error(Cause::not_solved, "the system of mean value weights is singular",
                    "prescribe a vertex in every component, and mend faces without area");
    return with_solution(fixed, unknowns, solution);
}

/// True if the polygon turns left at every corner (straight on at some) and goes round once.
bool is_convex(const std::vector<Complex>& polygon) {
    double turned = 0;
    std::vector<Complex> edges;
    for (std::size_t i = 0; i < polygon.size(); ++i) edges.push_back(polygon[(i + 1) % polygon.size()] - polygon[i]);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Complex turn = edges[(i + 1) % edges.size()] * std::conj(edges[i]);
        if (turn == 0.0 || turn.imag() < -1e-12 * std::abs(turn)) return false;
        turned += std::arg(turn);
    }
    return turned < 3 * std::numbers::pi;
}

bool has_no_folds(const Surface& source, const Eigen::VectorXcd& map) {
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [d_z, d_zbar] = source.operators.derivatives(s, map);
        if (!(std::norm(d_z) > std::norm(d_zbar))) return false;
    }
    return true;
}

}  // namespace

Eigen::VectorXcd convex_combination_map(const Surface& source, const BoundaryCondition& boundary,
                                        ConvexWeights weights) {
    const Unknowns unknowns(freedoms(boundary, source));
    const Eigen::VectorXcd fixed = prescribed_values(boundary, source);
    if (unknowns.count == 0) return fixed;
    return weights == ConvexWeights::uniform ? uniform_map(source, unknowns, fixed)
                                             : mean_value_map(source, unknowns, fixed);
}

bool has_convex_target(const Surface& source, const BoundaryCondition& boundary) {
    const Topology& topology = source.topology;
    if (topology.components != 1 || topology.genus != 0 || topology.boundary_loops.size() != 1) return false;
    const std::vector<int>& loop = topology.boundary_loops[0];
    if (!boundary.lines.empty() || boundary.vertices.size() != loop.size() ||
        !unprescribed_boundary(boundary, source).empty())
        return false;
    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    std::vector<Complex> polygon;
    polygon.reserve(loop.size());
    for (const int v : loop) polygon.push_back(images[v]);
    return is_convex(polygon);
}

std::optional<Eigen::VectorXcd> convex_embedding(const Surface& source, const BoundaryCondition& boundary,
                                                 int& factorizations) {
    if (!has_convex_target(source, boundary)) return {};
    for (const ConvexWeights weights : {ConvexWeights::uniform, ConvexWeights::mean_value}) {
        Eigen::VectorXcd map = convex_combination_map(source, boundary, weights);
        ++factorizations;
        if (has_no_folds(source, map)) return map;
    }
    return {};
}

}  // namespace beltrami
