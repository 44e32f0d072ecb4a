#include <beltrami/certificate/quadratic_map.h>

#include <array>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/base/stop.h>
#include <beltrami/coefficient/differential_quadrature.h>
#include <beltrami/constraints/inner_constraints.h>

namespace beltrami {

namespace {

/// Quadrature of degree 2: the points (2/3, 1/6, 1/6).
constexpr int kSamples = 3;
constexpr double kNear = 2.0 / 3, kFar = 1.0 / 6;
/// How often a triangle is divided to prove its determinant positive.
constexpr int kProofDepth = 4;
/// Rounds of straightening; one moves only the neighbours of the last.
constexpr int kMostRounds = 50;

int edge_point(const Surface& source, int face, int corner) {
    return source.operators.vertex_count + source.topology.corner_edges[source.mesh.faces.first_corner(face) + corner];
}

/// (∂f, ∂̄f) at the corners of a triangle: linear between them.
struct Derivatives {
    std::array<Complex, 3> dz, dzbar;

    std::array<Complex, 2> at(double b, double c) const {
        const double a = 1 - b - c;
        return {a * dz[0] + b * dz[1] + c * dz[2], a * dzbar[0] + b * dzbar[1] + c * dzbar[2]};
    }
};

Derivatives derivatives(const Surface& source, int face, const QuadraticMap& map) {
    const auto v = source.operators.stencil(face);
    const auto g = source.operators.gradient(face);
    std::array<Complex, 3> f, m;  // relative to the first corner
    const Complex base = map[v[0]];
    for (int j = 0; j < 3; ++j) {
        f[j] = map[v[j]] - base;
        m[j] = map[edge_point(source, face, j)] - base;
    }
    Derivatives d;
    for (int i = 0; i < 3; ++i) {
        // Gradients at corner i: 3 g_i, −g_j of the others; of the edge points 4 g_j on the edges that meet here.
        const int next = (i + 1) % 3, last = (i + 2) % 3;
        const auto sum = [&](auto&& part) {
            return 0.5 * (3.0 * part(g[i]) * f[i] - part(g[next]) * f[next] - part(g[last]) * f[last] +
                          4.0 * part(g[next]) * m[i] + 4.0 * part(g[last]) * m[last]);
        };
        d.dz[i] = sum([](Complex x) { return std::conj(x); });
        d.dzbar[i] = sum([](Complex x) { return x; });
    }
    return d;
}

bool positive(const Derivatives& d, int depth) {
    bool all = true;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
            const double coefficient = std::real(d.dz[i] * std::conj(d.dz[j]) - d.dzbar[i] * std::conj(d.dzbar[j]));
            if (coefficient > 0) continue;
            if (i == j) return false;  // or not a number
            all = false;
        }
    if (all || depth == 0) return all;
    const auto part = [&](std::array<std::array<double, 2>, 3> corners) {
        Derivatives smaller;
        for (int i = 0; i < 3; ++i) {
            const auto [dz, dzbar] = d.at(corners[i][0], corners[i][1]);
            smaller.dz[i] = dz;
            smaller.dzbar[i] = dzbar;
        }
        return positive(smaller, depth - 1);
    };
    return part({{{0, 0}, {0.5, 0}, {0, 0.5}}}) && part({{{0.5, 0}, {1, 0}, {0.5, 0.5}}}) &&
           part({{{0, 0.5}, {0.5, 0.5}, {0, 1}}}) && part({{{0.5, 0}, {0.5, 0.5}, {0, 0.5}}});
}

void require_triangles(const Surface& source) {
    for (int f = 0; f < source.mesh.face_count(); ++f)
        if (source.mesh.faces.degree(f) != 3)
            throw Error(Cause::bad_mesh, "face " + std::to_string(f) + " is not a triangle",
                        "piecewise quadratic maps need triangles", {Things::faces, {f}});
}

}  // namespace

QuadraticMap straight(const Surface& source, const Eigen::VectorXcd& map) {
    const auto& edges = source.topology.edges;
    QuadraticMap result(map.size() + static_cast<Eigen::Index>(edges.size()));
    result.head(map.size()) = map;
    for (std::size_t e = 0; e < edges.size(); ++e)
        result[map.size() + static_cast<Eigen::Index>(e)] = 0.5 * (map[edges[e][0]] + map[edges[e][1]]);
    return result;
}

Operators quadratic_operators(const Surface& source) {
    require_triangles(source);
    const Operators& linear = source.operators;
    Operators result;
    result.vertex_count = linear.vertex_count + source.topology.edge_count();
    result.face_count = linear.face_count;
    for (int f = 0; f < linear.sample_count(); ++f) {
        const auto v = linear.stencil(f);
        const auto g = linear.gradient(f);
        for (int q = 0; q < kSamples; ++q) {
            std::array<double, 3> at{kFar, kFar, kFar};
            at[q] = kNear;
            for (int j = 0; j < 3; ++j) {
                result.vertices.push_back(v[j]);
                result.gradients.push_back((4 * at[j] - 1) * g[j]);
            }
            for (int j = 0; j < 3; ++j) {
                const int next = (j + 1) % 3;
                result.vertices.push_back(edge_point(source, f, j));
                result.gradients.push_back(4.0 * (at[j] * g[next] + at[next] * g[j]));
            }
            result.offsets.push_back(static_cast<int>(result.vertices.size()));
            result.weights.push_back(linear.weights[f] / kSamples);
            result.faces.push_back(f);
        }
    }
    return result;
}

QuadraticStep::QuadraticStep(const Surface& source, const BoundaryCondition& boundary, const Chart& chart,
                             const DifferentialSpace& space, const Eigen::VectorXcd& coefficients)
    : quadratic_(source) {
    quadratic_.operators = quadratic_operators(source);
    const Topology& topology = source.topology;
    std::vector<Freedom> freedom = freedoms(boundary, source);
    const std::vector<EdgeConstraint> inner = edge_constraints(boundary, source);
    for (int e = 0; e < topology.edge_count(); ++e) {
        const bool rim = topology.edge_faces[e][0] < 0 || topology.edge_faces[e][1] < 0;
        freedom.push_back(rim || inner[e] == EdgeConstraint::pinned ? Freedom::fixed : Freedom::free);
        quadratic_.topology.on_boundary.push_back(rim);
    }
    std::vector<FacePoint> points;
    points.reserve(quadratic_.operators.weights.size());
    for (int f = 0; f < source.operators.sample_count(); ++f)
        for (int q = 0; q < kSamples; ++q)
            points.push_back({f, {q == 1 ? kNear : kFar, q == 2 ? kNear : kFar}, 0.0, 0.0});
    towards_ = space.combination(chart_points(source, chart, points), coefficients);
    for (Eigen::Index s = 0; s < towards_.size(); ++s) {
        const double size = std::abs(towards_[s]);
        const bool known = size > 0 && std::isfinite(size) && !chart.excluded[points[s].sample];
        towards_[s] = known ? std::conj(towards_[s]) / size : 0.0;
    }
    prescribed_ = straight(source, prescribed_values(boundary, source));
    solver_ = std::make_unique<BeltramiSolver>(quadratic_, std::move(freedom), 1);
}

QuadraticMap QuadraticStep::solve(double k) {
    const Eigen::VectorXcd nu = k * towards_;
    if (last_.size()) {
        last_ = solver_->solve_near(nu, prescribed_, last_);
    } else {
        solver_->factorize(nu);
        last_ = solver_->solve(prescribed_);
    }
    return last_;
}

std::vector<int> straighten(const Surface& source, QuadraticMap& map) {
    const int vertices = source.operators.vertex_count;
    std::vector<int> bad;
    for (int round = 0; round < kMostRounds; ++round) {
        stop_if_wanted();
        bad.clear();
        for (int f = 0; f < source.operators.sample_count(); ++f)
            if (!positive(derivatives(source, f, map), kProofDepth)) bad.push_back(f);
        bool moved = false;
        for (const int f : bad)
            for (int j = 0; j < 3; ++j) {
                const int point = edge_point(source, f, j);
                const auto& [a, b] = source.topology.edges[point - vertices];
                const Complex middle = 0.5 * (map[a] + map[b]);
                moved = moved || map[point] != middle;
                map[point] = middle;
            }
        if (!moved) break;
    }
    return bad;
}

std::vector<int> mend(const Surface& source, QuadraticMap& map, const Eigen::VectorXcd& other) {
    const QuadraticMap plain = straight(source, other);
    for (;;) {
        std::vector<int> bad = straighten(source, map);
        bool moved = false;
        for (const int f : bad) {
            const auto take = [&](int point) {
                moved = moved || map[point] != plain[point];
                map[point] = plain[point];
            };
            for (const int v : source.operators.stencil(f)) take(v);
            for (int j = 0; j < 3; ++j) take(edge_point(source, f, j));
        }
        // Where nothing moves the other map is turned over itself.
        if (!moved) return bad;
    }
}

ReichStrebel reich_strebel_quadratic(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                                     const Eigen::VectorXcd& coefficients, const QuadraticMap& map) {
    require_triangles(source);
    stop_if_wanted();
    std::vector<Derivatives> linear;
    linear.reserve(source.operators.weights.size());
    for (int f = 0; f < source.operators.sample_count(); ++f) {
        linear.push_back(derivatives(source, f, map));
        if (!chart.excluded[f] && !positive(linear.back(), kProofDepth)) return {};
    }
    double total = 0, norm = 0, pairing = 0;
    QuadratureOptions options;
    options.least_depth = 1;  // μ varies, too
    const double unresolved = visit_quadrature(
        source, chart, space, coefficients,
        [&](const FacePoint& p) {
            const auto [dz, dzbar] = linear[p.sample].at(p.place[0], p.place[1]);
            const double size = std::abs(p.phi), determinant = std::norm(dz) - std::norm(dzbar);
            total += p.weight * size;
            norm += p.weight * size * (std::norm(dz) + std::norm(dzbar)) / determinant;
            pairing += p.weight * 2 * std::real(dzbar * std::conj(dz) * p.phi) / determinant;
        },
        options);
    return reich_strebel_of(total, norm, pairing, unresolved);
}

}  // namespace beltrami
