#include <beltrami/constraints/inner_constraints.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace beltrami {

namespace {

/// Lines that differ by less than this part of the data's size are one.
constexpr double kSameLine = 1e-9;

/// What is prescribed at a vertex.
struct Place {
    bool pinned = false, held = false;
    Complex at, direction;  ///< the image or a point of the line; of length 1
};

}  // namespace

std::vector<EdgeConstraint> edge_constraints(const BoundaryCondition& boundary, const Surface& source) {
    std::vector<Place> places(source.mesh.vertex_count());
    double size = 0;
    const Complex origin = boundary.images.empty() ? Complex(0) : boundary.images[0];
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
        places[boundary.vertices[i]] = {true, false, boundary.images[i], 0.0};
        size = std::max(size, std::abs(boundary.images[i] - origin));
    }
    for (const auto& line : boundary.lines)
        places[line.vertex] = {false, true, line.point, line.direction / std::abs(line.direction)};
    const auto away = [&](const Place& line, Complex point) {
        return std::abs(std::imag((point - line.at) * std::conj(line.direction)));
    };
    const Topology& topology = source.topology;
    std::vector<EdgeConstraint> result(topology.edge_count(), EdgeConstraint::none);
    for (int e = 0; e < topology.edge_count(); ++e) {
        if (topology.on_boundary[topology.edges[e][0]] && topology.on_boundary[topology.edges[e][1]]) continue;
        const Place &a = places[topology.edges[e][0]], &b = places[topology.edges[e][1]];
        if (a.pinned && b.pinned) {
            result[e] = EdgeConstraint::pinned;
        } else if ((a.held || a.pinned) && (b.held || b.pinned)) {
            const Place &line = a.held ? a : b, &other = a.held ? b : a;
            const bool parallel =
                !other.held || std::abs(std::imag(other.direction * std::conj(line.direction))) <= kSameLine;
            if (parallel && away(line, other.at) <= kSameLine * size) result[e] = EdgeConstraint::on_line;
        }
    }
    return result;
}

std::vector<ConstraintCurve> constraint_curves(const BoundaryCondition& boundary, const Surface& source) {
    const Topology& topology = source.topology;
    const std::vector<EdgeConstraint> constraints = edge_constraints(boundary, source);
    std::vector<std::vector<int>> edges_at(source.mesh.vertex_count());
    for (int e = 0; e < topology.edge_count(); ++e)
        if (constraints[e] != EdgeConstraint::none)
            for (const int v : topology.edges[e]) edges_at[v].push_back(e);
    std::vector<char> pinned(source.mesh.vertex_count(), 0);
    for (const int v : boundary.vertices) pinned[v] = 1;
    // Whether a curve runs through a vertex.
    const auto passes = [&](int v) {
        const auto& at = edges_at[v];
        return at.size() == 2 && !topology.on_boundary[v] && constraints[at[0]] == constraints[at[1]] &&
               !(pinned[v] && constraints[at[0]] == EdgeConstraint::on_line);
    };
    std::vector<char> done(topology.edge_count(), 0);
    std::vector<ConstraintCurve> curves;
    const auto follow = [&](int v, int e) {
        ConstraintCurve curve{{v}, constraints[e]};
        while (e >= 0) {
            done[e] = 1;
            v = topology.edges[e][0] == v ? topology.edges[e][1] : topology.edges[e][0];
            curve.vertices.push_back(v);
            int next = -1;
            if (passes(v))
                for (const int other : edges_at[v])
                    if (!done[other]) next = other;
            e = next;
        }
        curves.push_back(std::move(curve));
    };
    for (const bool closed : {false, true})
        for (int v = 0; v < source.mesh.vertex_count(); ++v) {
            if (passes(v) != closed) continue;
            for (const int e : edges_at[v])
                if (!done[e]) follow(v, e);
        }
    for (ConstraintCurve& curve : curves)
        if (curve.vertices.back() < curve.vertices.front()) std::reverse(curve.vertices.begin(), curve.vertices.end());
    std::sort(curves.begin(), curves.end(), [](const ConstraintCurve& a, const ConstraintCurve& b) {
        return std::tie(a.vertices.front(), a.vertices[1]) < std::tie(b.vertices.front(), b.vertices[1]);
    });
    return curves;
}

}  // namespace beltrami
