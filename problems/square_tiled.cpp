#include "problems/square_tiled.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/random.h>

namespace beltrami::bench {

namespace {

void glue(SquareTiling& tiling, Side a, Side b) {
    tiling.gluing[a] = b;
    tiling.gluing[b] = a;
}

SquareTiling random_tiling(int squares, Random& random) {
    SquareTiling tiling{squares, {}};
    for (const int parity : {0, 1}) {
        std::vector<Side> sides;
        for (int s = 0; s < squares; ++s) sides.insert(sides.end(), {Side{s, parity}, Side{s, parity + 2}});
        for (std::size_t i = sides.size() - 1; i > 0; --i) std::swap(sides[i], sides[random.next() % (i + 1)]);
        for (std::size_t i = 0; i < sides.size(); i += 2) glue(tiling, sides[i], sides[i + 1]);
    }
    return tiling;
}

/// Sorted, in units of π/2.
std::vector<int> corner_angles(const SquareTiling& tiling) {
    std::map<Side, bool> seen;
    std::vector<int> angles;
    for (int s = 0; s < tiling.squares; ++s)
        for (int c = 0; c < 4; ++c) {
            Side x{s, c};
            int count = 0;
            while (!seen[x]) {
                seen[x] = true;
                ++count;
                x = tiling.gluing.at({x[0], (x[1] + 3) % 4});
            }
            if (count > 0) angles.push_back(count);
        }
    std::sort(angles.begin(), angles.end());
    return angles;
}

/// Whether all squares hang together, and some way turns by half a turn.
bool connected_with_half_turn(const SquareTiling& tiling) {
    std::vector<int> sign(static_cast<std::size_t>(tiling.squares), 0), queue{0};
    sign[0] = 1;
    bool turned = false;
    for (std::size_t next = 0; next < queue.size(); ++next)
        for (int a = 0; a < 4; ++a) {
            const auto [t, b] = tiling.gluing.at({queue[next], a});
            const int here =
                sign[static_cast<std::size_t>(queue[next])] * ((a - b) % 4 == 2 || (b - a) % 4 == 2 ? 1 : -1);
            int& there = sign[static_cast<std::size_t>(t)];
            if (there == 0) {
                there = here;
                queue.push_back(t);
            }
            turned = turned || there != here;
        }
    return turned && queue.size() == static_cast<std::size_t>(tiling.squares);
}

/// The point t/k along a side.
std::array<int, 2> on_side(int side, int t, int k) {
    const std::array<std::array<int, 2>, 4> points{{{t, 0}, {k, t}, {k - t, k}, {0, k - t}}};
    return points[static_cast<std::size_t>(side)];
}

std::map<std::array<int, 3>, int> number_vertices(const SquareTiling& tiling, int k, int& count) {
    const int n = k + 1;
    const auto slot = [&](int s, std::array<int, 2> p) { return (s * n + p[0]) * n + p[1]; };
    DisjointSets sets(tiling.squares * n * n);
    for (const auto& [a, b] : tiling.gluing)
        for (int t = 0; t <= k; ++t) sets.join(slot(a[0], on_side(a[1], t, k)), slot(b[0], on_side(b[1], k - t, k)));
    std::map<int, int> numbers;
    std::map<std::array<int, 3>, int> vertices;
    for (int s = 0; s < tiling.squares; ++s)
        for (int i = 0; i <= k; ++i)
            for (int j = 0; j <= k; ++j)
                vertices[{s, i, j}] =
                    numbers.try_emplace(sets.find(slot(s, {i, j})), static_cast<int>(numbers.size())).first->second;
    count = static_cast<int>(numbers.size());
    return vertices;
}

}  // namespace

SquareTiling l_shaped() {
    SquareTiling tiling{3, {}};  // 0 the corner, 1 on its right, 2 above
    glue(tiling, {0, 1}, {1, 3});
    glue(tiling, {1, 1}, {0, 3});
    glue(tiling, {2, 1}, {2, 3});
    glue(tiling, {0, 2}, {2, 0});
    glue(tiling, {2, 2}, {0, 0});
    glue(tiling, {1, 2}, {1, 0});
    return tiling;
}

SquareTiling half_translation(int squares, const std::vector<int>& angles) {
    Random random(1);
    while (true) {
        SquareTiling tiling = random_tiling(squares, random);
        if (connected_with_half_turn(tiling) && corner_angles(tiling) == angles) return tiling;
    }
}

TiledSurface tiled_surface(const SquareTiling& tiling, int k, Complex mu, double jitter) {
    int count = 0;
    const bool turns = connected_with_half_turn(tiling);
    std::map<std::array<int, 3>, int> vertices = number_vertices(tiling, k, count);
    Random random(1);
    Mesh mesh;
    mesh.positions.resize(count, 3);  // anywhere: only the metric counts
    for (int v = 0; v < count; ++v) mesh.positions.row(v) << std::cos(v), std::sin(v), 0.01 * v;
    std::vector<Complex> corners;
    for (int s = 0; s < tiling.squares; ++s) {
        std::map<std::array<int, 2>, Complex> places;
        for (int i = 0; i <= k; ++i)
            for (int j = 0; j <= k; ++j) {
                Complex z(i, j);
                if (jitter > 0 && i > 0 && i < k && j > 0 && j < k)
                    z += jitter * Complex(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
                places[{i, j}] = (z + mu * std::conj(z)) / static_cast<double>(k);
            }
        for (int i = 0; i < k; ++i)
            for (int j = 0; j < k; ++j) {
                const std::array<std::array<int, 2>, 4> q{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
                bool rising = jitter > 0 ? random.uniform() < 0.5 : (i + j) % 2 == 0;
                // With half-turns not through the corners of the square: two edges could join the same vertices.
                if (turns && (i == 0 || i == k - 1) && (j == 0 || j == k - 1)) rising = (i == 0) != (j == 0);
                const auto add = [&](std::array<std::size_t, 3> t) {
                    mesh.faces.add({vertices.at({s, q[t[0]][0], q[t[0]][1]}), vertices.at({s, q[t[1]][0], q[t[1]][1]}),
                                    vertices.at({s, q[t[2]][0], q[t[2]][1]})});
                    for (const std::size_t c : t) corners.push_back(places.at(q[c]));
                };
                if (rising) {
                    add({0, 1, 2});
                    add({0, 2, 3});
                } else {
                    add({0, 1, 3});
                    add({1, 2, 3});
                }
            }
    }
    Positions metric(static_cast<Eigen::Index>(corners.size()), 2);
    for (std::size_t c = 0; c < corners.size(); ++c)
        metric.row(static_cast<Eigen::Index>(c)) << corners[c].real(), corners[c].imag();
    return {Surface(std::move(mesh), std::move(metric)), std::move(vertices), k};
}

std::vector<int> same_places(const TiledSurface& from, const TiledSurface& to) {
    std::vector<int> result(static_cast<std::size_t>(from.surface.mesh.vertex_count()), -1);
    const auto nearest = [&](int i) {
        return static_cast<int>(std::floor(static_cast<double>(i * to.cells) / from.cells + 0.5));
    };
    for (const auto& [place, v] : from.vertices)
        result[static_cast<std::size_t>(v)] = to.vertex(place[0], nearest(place[1]), nearest(place[2]));
    return result;
}

}  // namespace beltrami::bench
