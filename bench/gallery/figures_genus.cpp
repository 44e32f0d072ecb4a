// Closed surfaces of genus 2 and more: exact extremal maps, and deformed double tori.
#include <cmath>
#include <numbers>

#include <beltrami/generate/double_torus.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/registration/register_handles.h>

#include "gallery/sliding.h"
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

/// Rows of one problem at several sizes.
void add_rows(Table& table, const std::string& name, const bench::SquareTiling& tiling,
              const std::vector<std::array<int, 2>>& cells, Complex mu, double exact, const Twists& twists = {}) {
    double before = 0;
    for (const auto& [from, to] : cells) {
        const bench::TiledSurface a = tiled_surface(tiling, from), b = tiled_surface(tiling, to, mu, 0.4);
        const HyperbolicMap map = tiled_map(a, b, twists);
        const double error = map.k - exact;
        table.rows.push_back(
            {name, std::to_string(a.surface.mesh.vertex_count()) + ", " + std::to_string(b.surface.mesh.vertex_count()),
             number(map.k, 5), number(exact, 5), scientific(error),
             before > 0 ? number(std::log2(before / std::abs(error)), 2) : "",
             number(map.K_lower) + "–" + number(map.K_upper), number(map.K_homology), number(map.weighted_deviation),
             number(map.distortion.max, 3), std::to_string(map.history.size() - 1),
             std::to_string(map.distortion.flipped.size())});
        before = std::abs(error);
    }
}

Table exact_maps() {
    Table table{
        "Square-tiled surfaces, where dz² is holomorphic: affine maps z + μ z̄ to other meshes, moved and with random "
        "diagonals, are extremal with k = abs(μ); and the affine map [[1, 2], [0, 1]] of the L, a Dehn twist of its "
        "lower "
        "cylinder and two of the upper one. In brackets the angles of the corners in units of π/2",
        {"map", "vertices", "k", "exact", "error", "order", "bracket", "homology", "std", "max", "steps", "flips"},
        {}};
    const std::vector<std::array<int, 2>> even{{8, 11}, {16, 22}, {32, 44}}, odd{{7, 11}, {15, 23}, {31, 47}};
    const bench::SquareTiling l = bench::l_shaped();
    add_rows(table, "L, k .2", l, even, std::polar(0.2, 0.4), 0.2);
    add_rows(table, "L, k .5", l, even, std::polar(0.5, 1.0), 0.5);
    const Twists multi{{{{0, 1}, 1}, {{2}, 2}}}, back{{{{0, 1}, -1}, {{2}, -2}}};
    add_rows(table, "L, multi-twist", l, even, 0, std::sqrt(0.5), multi);
    add_rows(table, "L, multi-twist back", l, even, 0, std::sqrt(0.5), back);
    struct Tiling {
        std::string name;
        int squares;
        std::vector<int> angles;
    };
    for (const Tiling& t : {Tiling{"genus 2 [6, 6, 8]", 5, {6, 6, 8}}, Tiling{"genus 2 [4, 8, 8]", 5, {4, 8, 8}},
                            Tiling{"genus 3 [4, 6, 18]", 7, {4, 6, 18}}, Tiling{"genus 3 [4, 8, 16]", 7, {4, 8, 16}},
                            Tiling{"genus 3 [6, 8, 14]", 7, {6, 8, 14}}})
        for (const double k : {0.3, 0.6})
            add_rows(table, t.name + ", k " + number(k, 1), bench::half_translation(t.squares, t.angles), odd,
                     std::polar(k, 0.7), k);
    return table;
}

Mesh deformed(Mesh mesh, double stretch, double slope) {
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions(v, 1) *= stretch + slope * mesh.positions(v, 0);
    return mesh;
}

void add_double_tori(Output& output, Figure& figure) {
    Table table{
        "A double torus onto itself with y multiplied, meshed on its own; vertices begin near the images of the same "
        "points. Back: the extremal map of the target onto the source, from its own mesh and differentials",
        {"y times", "vertices", "k", "k back", "bracket", "homology", "std", "max", "steps",
         "flips, hyperbolic / in space"},
        {}};
    struct Deformation {
        std::string name;
        double stretch, slope;
    };
    for (const Deformation& d : {Deformation{"1", 1, 0}, Deformation{"1.3 + x/8", 1.3, 0.125},
                                 Deformation{"2.2 + .3x", 2.2, 0.3}, Deformation{"0.55 + x/20", 0.55, 0.05}})
        for (const double edge : {0.14, 0.1, 0.07}) {
            const Mesh mesh = double_torus(edge);
            const Surface source(mesh), target(deformed(double_torus(0.9 * edge), d.stretch, d.slope));
            const HyperbolicShape from(source), to(target);
            HandleMarking marking;
            marking.start = deformed(mesh, d.stretch, d.slope).positions;
            const HandleRegistration found = register_handles(from, to, marking);
            const HyperbolicMap& map = found.map;
            table.rows.push_back(
                {d.name, std::to_string(source.mesh.vertex_count()) + ", " + std::to_string(target.mesh.vertex_count()),
                 number(map.k, 5), found.inverse_k ? number(*found.inverse_k, 5) : "–",
                 number(map.K_lower) + "–" + number(map.K_upper), number(map.K_homology),
                 number(map.weighted_deviation), number(map.distortion.max, 3), std::to_string(map.history.size() - 1),
                 std::to_string(map.distortion.flipped.size()) + " / " + std::to_string(map.in_space.flipped.size())});
            if (edge != 0.1 || d.stretch != 2.2) continue;
            const HyperbolicDomain domain = hyperbolic_domain(source, from.metric());
            const Mesh cut = cut_along_seams(source.mesh, domain.layout);
            Mesh image = cut;
            for (std::size_t c = 0; c < domain.layout.corners.size(); ++c)
                image.positions.row(domain.layout.corners[c]) = map.positions.row(source.mesh.faces.vertices()[c]);
            Eigen::VectorXcd plane(cut.vertex_count());
            for (int v = 0; v < cut.vertex_count(); ++v)
                plane[v] = {domain.layout.points(v, 0), domain.layout.points(v, 1)};
            const std::string here = output.write("double_torus", cut, plane, map.distortion.face_abs_mu),
                              there = output.write("double_torus_image", image, plane, map.distortion.face_abs_mu);
            figure.pictures.push_back(
                {"double_torus",
                 "The double torus cut open in the hyperbolic plane, and onto the one with y · (2.2 + .3x), k " +
                     number(map.k) + ".",
                 {faces_panel(here, "fundamental polygon"), surface_panel(here, "source", "circles", 30, 60),
                  surface_panel(there, "its image", "circles", 30, 60),
                  histogram_panel({{"", here}}, "|μ| of the source's faces", map.k, 0.5)}});
        }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure genus(Output& output) {
    Figure figure{"Genus 2 and more",
                  "Extremal maps between closed surfaces with handles ([higher genus](higher-genus.md))."};
    figure.tables.push_back(exact_maps());
    add_double_tori(output, figure);
    return figure;
}

}  // namespace beltrami::gallery
