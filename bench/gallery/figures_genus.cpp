// Closed surfaces of genus 2 and 3 whose extremal maps are known exactly.
#include <cmath>
#include <numbers>

#include "gallery/handles.h"
#include "problems/square_tiled.h"

namespace beltrami::gallery {

namespace {

/// Dehn twists about the middle lines of rows of squares.
struct Twists {
    struct Row {
        std::vector<int> squares;
        int turns;
    };
    std::vector<Row> rows;
};

HyperbolicMap tiled_map(const bench::TiledSurface& a, const bench::TiledSurface& b, const Twists& twists) {
    const HyperbolicShape source(a.surface), target(b.surface);
    const IntrinsicTriangulation& triangulation = source.metric().original;
    EquivariantMap start = marking_by_vertices(a.surface, triangulation, target.group(), same_places(a, b)).map;
    for (const Twists::Row& row : twists.rows) {
        std::vector<int> path;
        for (const int square : row.squares)
            for (int i = 0; i < a.cells; ++i) path.push_back(a.vertex(square, i, a.cells / 2));
        start = twisted(a.surface, triangulation, std::move(start), path, row.turns);
    }
    return hyperbolic_map(source, target, std::move(start));
}

/// One problem: an affine map of a tiling, at several sizes.
struct Exact {
    std::string name;
    bench::SquareTiling tiling;
    std::vector<std::array<int, 2>> cells;  ///< a side of a square, of source and target
    Complex mu;                             ///< of the target
    double k;                               ///< exact
    double jitter;                          ///< of the target
    Twists twists = {};
};

/// Rows of one problem; the curve of its errors.
Curve add_rows(Table& table, const Exact& problem) {
    Curve curve{problem.name, {}, {}};
    double before = 0;
    for (const auto& [from, to] : problem.cells) {
        const bench::TiledSurface a = tiled_surface(problem.tiling, from),
                                  b = tiled_surface(problem.tiling, to, problem.mu, problem.jitter);
        const HyperbolicMap map = tiled_map(a, b, problem.twists);
        const double error = map.k - problem.k;
        const int vertices = a.surface.mesh.vertex_count();
        table.rows.push_back({problem.name,
                              std::to_string(vertices) + ", " + std::to_string(b.surface.mesh.vertex_count()),
                              number(map.k, 5), number(problem.k, 5), scientific(error),
                              before > 0 ? number(std::log2(before / std::abs(error)), 2) : "",
                              number(map.K_lower) + "–" + number(map.K_upper), number(map.K_homology),
                              number(map.weighted_deviation), number(map.distortion.max, 3),
                              std::to_string(map.history.size() - 1), std::to_string(map.distortion.flipped.size())});
        before = std::abs(error);
        curve.x.push_back(vertices);
        curve.y.push_back(before);
    }
    return curve;
}

std::vector<Exact> problems() {
    const std::vector<std::array<int, 2>> even{{8, 11}, {16, 22}, {32, 44}}, odd{{7, 11}, {15, 23}, {31, 47}};
    const bench::SquareTiling l = bench::l_shaped();
    const Twists multi{{{{0, 1}, 1}, {{2}, 2}}}, back{{{{0, 1}, -1}, {{2}, -2}}};
    std::vector<Exact> list{{"L, k .2", l, even, std::polar(0.2, 0.4), 0.2, 0.5},
                            {"L, k .4", l, even, std::polar(0.4, 0.7), 0.4, 0.5},
                            {"L, k .5", l, even, std::polar(0.5, 1.0), 0.5, 0.5},
                            {"L, k .6", l, even, std::polar(0.6, -0.5), 0.6, 0.5},
                            {"L, multi-twist", l, even, 0, std::sqrt(0.5), 0.5, multi},
                            {"L, multi-twist back", l, even, 0, std::sqrt(0.5), 0.5, back}};
    struct Tiling {
        std::string name;
        int squares;
        std::vector<int> angles;
    };
    for (const Tiling& t : {Tiling{"genus 2 [6, 6, 8]", 5, {6, 6, 8}}, Tiling{"genus 2 [4, 8, 8]", 5, {4, 8, 8}},
                            Tiling{"genus 3 [4, 6, 18]", 7, {4, 6, 18}}, Tiling{"genus 3 [4, 8, 16]", 7, {4, 8, 16}},
                            Tiling{"genus 3 [6, 8, 14]", 7, {6, 8, 14}}})
        for (const auto& [k, turn] : {std::pair{0.3, 0.7}, {0.4, 0.7}, {0.6, -0.5}})
            list.push_back({t.name + ", k " + number(k, 1), bench::half_translation(t.squares, t.angles), odd,
                            std::polar(k, turn), k, 0.4});
    return list;
}

}  // namespace

Figure genus(Output& /*output*/) {
    Figure figure{
        "Genus 2 and 3: exact maps",
        "Extremal maps between closed surfaces with handles ([higher genus](higher-genus.md)) that are known."};
    Table table{
        "Square-tiled surfaces, where dz² is holomorphic: affine maps z + μ z̄ to other meshes, moved and with random "
        "diagonals, are extremal with k = abs(μ); and the affine map [[1, 2], [0, 1]] of the L, a Dehn twist of its "
        "lower cylinder and two of the upper one, K = (1 + √2)². In brackets the angles of the corners in units of π/2",
        {"map", "vertices", "k", "exact", "error", "order", "bracket", "homology", "std", "max", "steps", "flips"},
        {}};
    std::vector<Curve> of_l, of_genus_2, of_genus_3;
    for (const Exact& problem : problems()) {
        std::vector<Curve>& curves = problem.name[0] == 'L'                ? of_l
                                     : problem.name.starts_with("genus 2") ? of_genus_2
                                                                           : of_genus_3;
        curves.push_back(add_rows(table, problem));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back({"genus_exact",
                               "Errors of k, by vertices of the source: they fall with their number, the square of "
                               "the edges' length.",
                               {curves_panel(of_l, "the L", "vertices", "error of k"),
                                curves_panel(of_genus_2, "genus 2, half-translations", "vertices", "error of k"),
                                curves_panel(of_genus_3, "genus 3", "vertices", "error of k")}});
    return figure;
}

}  // namespace beltrami::gallery
