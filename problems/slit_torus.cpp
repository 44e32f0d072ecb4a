#include "problems/slit_torus.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <beltrami/base/random.h>

namespace beltrami::bench {

SlitTorus slit_torus(int n, double stretch, unsigned seed) {
    const int left = n / 4, right = 3 * n / 4, bottom = 3 * n / 8, top = 5 * n / 8;
    const auto removed = [&](int i, int j) { return i > left && i < right && j > bottom && j < top; };
    Random random(seed);
    std::vector<int> numbers(static_cast<std::size_t>(n * n), -1);
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if (removed(i, j)) continue;
            numbers[static_cast<std::size_t>(i * n + j)] = static_cast<int>(places.size());
            const double dx = random.uniform(-0.2, 0.2), dy = random.uniform(-0.2, 0.2);
            const bool upright = (i == left || i == right) && j >= bottom && j <= top,
                       level = (j == bottom || j == top) && i >= left && i <= right;
            places.emplace_back(i + (upright ? 0 : dx), j + (level ? 0 : dy));
        }
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(places.size()), 3);  // only the metric counts
    for (std::size_t v = 0; v < places.size(); ++v) {
        const double a = 2 * std::numbers::pi / n * places[v][0], b = 2 * std::numbers::pi / n * places[v][1];
        mesh.positions.row(static_cast<Eigen::Index>(v)) << (2 + std::cos(b)) * std::cos(a),
            (2 + std::cos(b)) * std::sin(a), std::sin(b);
    }
    std::vector<Eigen::RowVector2d> corners;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            if (i >= left && i < right && j >= bottom && j < top) continue;
            const std::array<std::array<int, 2>, 4> cell{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
            const auto number = [&](const std::array<int, 2>& p) {
                return numbers[static_cast<std::size_t>((p[0] % n) * n + p[1] % n)];
            };
            const auto add = [&](std::array<std::size_t, 3> t) {
                mesh.faces.add({number(cell[t[0]]), number(cell[t[1]]), number(cell[t[2]])});
                for (const std::size_t c : t) {
                    const Eigen::Vector2d& place = places[static_cast<std::size_t>(number(cell[c]))];
                    const double x = place[0] + (cell[c][0] == n ? n : 0), y = place[1] + (cell[c][1] == n ? n : 0);
                    corners.emplace_back(x / n, stretch * y / n);
                }
            };
            if (random.uniform() < 0.5) {
                add({0, 1, 2});
                add({0, 2, 3});
            } else {
                add({0, 1, 3});
                add({1, 2, 3});
            }
        }
    Positions metric(static_cast<Eigen::Index>(corners.size()), 2);
    for (std::size_t c = 0; c < corners.size(); ++c) metric.row(static_cast<Eigen::Index>(c)) = corners[c];
    SlitTorus result{Surface(std::move(mesh), std::move(metric)), {}};
    result.places.resize(static_cast<Eigen::Index>(places.size()), 2);
    for (std::size_t v = 0; v < places.size(); ++v)
        result.places.row(static_cast<Eigen::Index>(v)) = places[v].transpose() / n;
    return result;
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
