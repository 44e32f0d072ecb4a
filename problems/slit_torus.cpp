#include "problems/slit_torus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <beltrami/base/random.h>

namespace beltrami::bench {

namespace {

/// Faces with the places of their corners in the unit square, not taken modulo 1.
struct Cells {
    std::vector<std::array<int, 3>> faces;
    std::vector<std::array<Eigen::Vector2d, 3>> corners;
    std::vector<Eigen::Vector2d> places;  ///< of the vertices
};

/// Each face as four.
Cells quartered(const Cells& cells) {
    Cells result;
    result.places = cells.places;
    result.faces.reserve(4 * cells.faces.size());
    result.corners.reserve(4 * cells.faces.size());
    std::map<std::pair<int, int>, int> middles;
    for (std::size_t f = 0; f < cells.faces.size(); ++f) {
        const auto& [a, b, c] = cells.faces[f];
        const std::array<Eigen::Vector2d, 3>& p = cells.corners[f];
        const std::array<Eigen::Vector2d, 3> q{(p[0] + p[1]) / 2, (p[1] + p[2]) / 2, (p[2] + p[0]) / 2};
        const auto middle = [&](int i, int j, const Eigen::Vector2d& place) {
            const auto [at, is_new] = middles.try_emplace(std::minmax(i, j), static_cast<int>(result.places.size()));
            if (is_new) result.places.push_back(place);
            return at->second;
        };
        const std::array<int, 3> m{middle(a, b, q[0]), middle(b, c, q[1]), middle(c, a, q[2])};
        const auto add = [&](const std::array<int, 3>& face, const std::array<Eigen::Vector2d, 3>& corners) {
            result.faces.push_back(face);
            result.corners.push_back(corners);
        };
        add({a, m[0], m[2]}, {p[0], q[0], q[2]});
        add({m[0], b, m[1]}, {q[0], p[1], q[1]});
        add({m[2], m[1], c}, {q[2], q[1], p[2]});
        add({m[0], m[1], m[2]}, q);
    }
    return result;
}

/// The square less the rectangle in cells cut along random diagonals, vertices moved.
Cells cut_cells(int n, unsigned seed) {
    const int left = n / 4, right = 3 * n / 4, bottom = 3 * n / 8, top = 5 * n / 8;
    const auto removed = [&](int i, int j) { return i > left && i < right && j > bottom && j < top; };
    Random random(seed);
    std::vector<int> numbers(static_cast<std::size_t>(n * n), -1);
    Cells result;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if (removed(i, j)) continue;
            numbers[static_cast<std::size_t>(i * n + j)] = static_cast<int>(result.places.size());
            const double dx = random.uniform(-0.2, 0.2), dy = random.uniform(-0.2, 0.2);
            const bool upright = (i == left || i == right) && j >= bottom && j <= top,
                       level = (j == bottom || j == top) && i >= left && i <= right;
            result.places.emplace_back((i + (upright ? 0 : dx)) / n, (j + (level ? 0 : dy)) / n);
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if (i >= left && i < right && j >= bottom && j < top) continue;
            const std::array<std::array<int, 2>, 4> cell{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
            const auto number = [&](const std::array<int, 2>& p) {
                return numbers[static_cast<std::size_t>((p[0] % n) * n + p[1] % n)];
            };
            const auto add = [&](const std::array<std::size_t, 3>& t) {
                std::array<int, 3> face{};
                std::array<Eigen::Vector2d, 3> corners;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::array<int, 2>& corner = cell[t[k]];
                    face[k] = number(corner);
                    corners[k] = result.places[static_cast<std::size_t>(face[k])] +
                                 Eigen::Vector2d(corner[0] == n ? 1 : 0, corner[1] == n ? 1 : 0);
                }
                result.faces.push_back(face);
                result.corners.push_back(corners);
            };
            if (random.uniform() < 0.5) {
                add({0, 1, 2});
                add({0, 2, 3});
            } else {
                add({0, 1, 3});
                add({1, 2, 3});
            }
        }
    return result;
}

}  // namespace

SlitTorus slit_torus(int n, double stretch, unsigned seed, int refinements) {
    Cells cells = cut_cells(n, seed);
    for (int r = 0; r < refinements; ++r) cells = quartered(cells);
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(cells.places.size()), 3);  // only the metric counts
    Eigen::MatrixX2d places(mesh.positions.rows(), 2);
    for (std::size_t v = 0; v < cells.places.size(); ++v) {
        const auto row = static_cast<Eigen::Index>(v);
        places.row(row) = cells.places[v].transpose();
        const double a = 2 * std::numbers::pi * places(row, 0), b = 2 * std::numbers::pi * places(row, 1);
        mesh.positions.row(row) << (2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b);
    }
    Positions metric(static_cast<Eigen::Index>(3 * cells.faces.size()), 2);
    for (std::size_t f = 0; f < cells.faces.size(); ++f) {
        mesh.faces.add({cells.faces[f][0], cells.faces[f][1], cells.faces[f][2]});
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d& p = cells.corners[f][k];
            metric.row(static_cast<Eigen::Index>(3 * f + k)) << p[0], stretch * p[1];
        }
    }
    return {Surface(std::move(mesh), std::move(metric)), std::move(places)};
}

std::vector<int> same_places(const SlitTorus& from, const SlitTorus& to) {
    std::vector<int> result;
    for (Eigen::Index v = 0; v < from.places.rows(); ++v) {
        const bool on_boundary = from.surface.topology.on_boundary[static_cast<std::size_t>(v)] != 0;
        double least = std::numeric_limits<double>::infinity();
        int nearest = -1;
        for (Eigen::Index w = 0; w < to.places.rows(); ++w) {
            if (on_boundary && !to.surface.topology.on_boundary[static_cast<std::size_t>(w)]) continue;
            Eigen::RowVector2d way = to.places.row(w) - from.places.row(v);
            way -= way.array().round().matrix();
            if (way.squaredNorm() < least) {
                least = way.squaredNorm();
                nearest = static_cast<int>(w);
            }
        }
        result.push_back(nearest);
    }
    return result;
}

}  // namespace beltrami::bench
