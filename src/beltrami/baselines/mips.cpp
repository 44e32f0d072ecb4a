#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <beltrami/base/error.h>
#include <beltrami/baselines/start.h>
#include <beltrami/linear/element_assembly.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// Every vertex that is not fixed in the mean of its neighbours: an embedding if the outer loop goes to a convex
/// polygon and the mesh is 3-connected; other loops, free, are faces (Tutte 1963, Floater 1997).
Eigen::VectorXcd tutte_map(const Surface& source, const std::vector<Freedom>& freedoms,
                           const Eigen::VectorXcd& fixed_values) {
    std::vector<int> unknown(freedoms.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (freedoms[v] != Freedom::fixed) unknown[v] = count++;
    Eigen::VectorXcd map = fixed_values;
    if (count == 0) return map;

    std::vector<int> offsets{0}, unknowns;
    for (const auto& [a, b] : source.topology.edges) {
        unknowns.insert(unknowns.end(), {unknown[a], unknown[b]});
        offsets.push_back(static_cast<int>(unknowns.size()));
    }
    const ElementAssembly assembly(std::move(offsets), std::move(unknowns), count);
    SymmetricSolver solver(assembly.pattern(), 1);
    double* values = solver.matrix().valuePtr();
    Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(count, 2);
    const auto pull = [&](int u, Complex towards) {
        rhs(u, 0) += towards.real();
        rhs(u, 1) += towards.imag();
    };
    for (int e = 0; e < source.topology.edge_count(); ++e) {
        const auto [a, b] = source.topology.edges[e];
        const auto slots = assembly.slots(e);
        if (slots[0] >= 0) values[slots[0]] += 1;
        if (slots[1] >= 0) values[slots[1]] -= 1;
        if (slots[2] >= 0) values[slots[2]] += 1;
        if (unknown[a] >= 0 && unknown[b] < 0) pull(unknown[a], fixed_values[b]);
        if (unknown[b] >= 0 && unknown[a] < 0) pull(unknown[b], fixed_values[a]);
    }
    solver.factorize();
    const Eigen::MatrixXd solution = solver.solve(rhs);
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (unknown[v] >= 0) map[static_cast<Eigen::Index>(v)] = {solution(unknown[v], 0), solution(unknown[v], 1)};
    return map;
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

/// Tutte's map where it is known to have no folds: the one boundary loop goes to a convex polygon and nothing else is
/// prescribed; or nothing is prescribed at all, and the outer loop goes to a circle by arc length.
std::optional<Eigen::VectorXcd> convex_start(const Surface& source, const BoundaryCondition& boundary) {
    if (source.topology.components != 1 || source.topology.genus != 0) return {};
    const auto& loop = source.topology.boundary_loops[0];
    BoundaryCondition ring = boundary;
    if (boundary.empty()) {
        double along = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            ring.pin(loop[i], std::polar(1.0, 2 * std::numbers::pi * along / source.topology.loop_lengths[0]));
            along += (source.mesh.point(loop[(i + 1) % loop.size()]) - source.mesh.point(loop[i])).norm();
        }
    } else {
        if (source.topology.boundary_loops.size() != 1 || boundary.vertices.size() != loop.size() ||
            !unprescribed_boundary(boundary, source).empty())
            return {};
        const Eigen::VectorXcd images = prescribed_values(boundary, source);
        std::vector<Complex> polygon;
        for (const int v : loop) polygon.push_back(images[v]);
        if (!is_convex(polygon)) return {};
    }
    return tutte_map(source, freedoms(ring, source), prescribed_values(ring, source));
}

}  // namespace

BaselineMap mips_baseline(const Surface& source, const BoundaryCondition& boundary, const BaselineOptions& options) {
    detail::check_baseline(source, boundary, options);
    BaselineMap result;
    result.map = detail::linear_map(source, boundary, result.factorizations);
    if (detail::must_fold(source, boundary, result)) return result;

    if (!detail::has_no_folds(source, result.map)) {
        std::optional<Eigen::VectorXcd> convex = convex_start(source, boundary);
        if (convex) ++result.factorizations;
        if (convex && detail::has_no_folds(source, *convex)) {
            result.map = std::move(*convex);
            result.warnings.push_back("the linear start has folds; started from Tutte's map instead");
        } else {
            result.warnings.push_back("the linear start has folds and was untangled");
        }
    }
    FoldFreeOptions descent;
    descent.max_iterations = options.max_iterations;
    descent.tolerance = options.tolerance;
    descent.progress = options.progress;
    FoldFreeMap minimum = fold_free_map(source, freedoms(boundary, source),
                                        Eigen::VectorXcd::Zero(source.operators.sample_count()), result.map, descent);
    result.map = std::move(minimum.map);
    result.iterations = minimum.iterations;
    result.factorizations += minimum.factorizations;
    result.converged = minimum.fold_free && minimum.status == FoldFreeStatus::converged;
    if (!minimum.fold_free)
        result.warnings.push_back(
            "folds remain: the prescribed vertices admit no map without folds, or none was found");
    else if (!result.converged)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " steps before the gradient vanished");
    detail::warn_of_flips(source, result);
    return result;
}

}  // namespace beltrami
