// Boundaries that slide, by maps between doubles: known values, scans, and starts for boundaries that slide in the
// plane.
#include <algorithm>
#include <cmath>
#include <memory>

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/teichmuller/hyperbolic_sliding_start.h>

#include "gallery/handles.h"
#include "problems/level_surface.h"
#include "problems/slit_torus.h"

namespace beltrami::gallery {

namespace {

/// Disks with holes of which k is known.
struct Pair {
    std::string name;
    std::vector<Hole> from, to;
    double k;
};

std::vector<Pair> pairs() {
    return {{"two holes", {{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, {{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}}, 0.16556},
            {"Example 5",
             {{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}},
             {{0, 0.5, 0.2}, {-0.4, -0.3, 0.2}, {0.4, -0.3, 0.2}},
             0.2708},
            {"Example 4",
             {{0, 0.33, 0.1}, {0.33, -0.33, 0.067}, {-0.33, -0.33, 0.133}},
             {{0, 0.6, 0.1}, {0.7, -0.3, 0.1}, {-0.7, -0.3, 0.1}},
             0.3758}};
}

SlidingStart even_start_of(const Surface& source, const std::vector<Hole>& to, double h,
                           std::unique_ptr<TargetModel>* kept = nullptr) {
    std::unique_ptr<TargetModel> model = target_model(circles_target(to), h);
    SlidingStart even = even_start(source, circle_domain_chart(source, 0), *model, numbered(to.size()));
    if (kept) *kept = std::move(model);
    return even;
}

/// A map in the plane whose boundary was put onto the circles that the target's polygons stand for.
struct Projected {
    double k, lower, upper;  ///< and the bracket of k
    Eigen::VectorXcd map;
    Distortion distortion;
};

Projected projected(const Surface& source, const HyperbolicMap& found, const std::vector<Hole>& to) {
    Projected result{};
    const Eigen::Index n = source.mesh.vertex_count();
    result.map.resize(n);
    for (Eigen::Index v = 0; v < n; ++v) result.map[v] = {found.positions(v, 0), found.positions(v, 1)};
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l)
        for (const int v : source.topology.boundary_loops[l]) {
            // The circle that is nearest.
            double least = std::abs(std::abs(result.map[v]) - 1);
            Complex place = result.map[v] / std::abs(result.map[v]);
            for (const auto& [x, y, r] : to) {
                const Complex centre(x, y), way = result.map[v] - centre;
                if (std::abs(std::abs(way) - r) >= least) continue;
                least = std::abs(std::abs(way) - r);
                place = centre + r * way / std::abs(way);
            }
            result.map[v] = place;
        }
    result.distortion = distortion(source.operators, result.map);
    CoefficientStep step(source, *found.differential.chart, {}, 0, source.operators.sample_count());
    step.set_space(*found.differential.space);
    const CoefficientStep::Result last = step.solve(result.distortion.mu, found.differential.coefficients);
    result.k = last.k;
    QuadraticDifferential phi = found.differential;
    phi.coefficients = last.direction;
    const ReichStrebel bounds = reich_strebel(source, phi, result.distortion.mu);
    result.lower = k_of(bounds.lower);
    result.upper = k_of(bounds.upper);
    return result;
}

void add_planar(Output& output, Figure& figure) {
    Table table{
        "Disks with holes onto others, h: edges of the source, .4 h at the holes; the targets have meshes of .93 h. "
        "The maps are between "
        "the polygons; projected: their boundary put onto the circles, and k and its bracket of the map so found. "
        "Sliding: "
        "k of the map along the circles themselves ([sliding boundaries](sliding.md)), from its own start",
        {"pair", "h", "vertices", "exact", "k", "back", "projected", "error", "bracket", "sliding", "std", "steps",
         "flips"},
        {}};
    for (const Pair& pair : pairs())
        for (const double h : {0.056, 0.04, 0.028}) {
            const Surface source(disk_with_holes(pair.from, h)), target(disk_with_holes(pair.to, 0.93 * h));
            const HyperbolicShape from(source), to(target);
            const SlidingStart even = even_start_of(source, pair.to, h);
            HandleMarking marking;
            marking.start = Positions::Zero(even.map.size(), 3);
            marking.start->col(0) = even.map.real();
            marking.start->col(1) = even.map.imag();
            const HandleRegistration found = register_handles(from, to, marking);
            const Projected there = projected(from.surface(), found.map, pair.to);
            const SolvedOnto sliding = solve_onto(source, {circles_target(pair.to), numbered(pair.to.size())});
            table.rows.push_back(
                {pair.name, number(h, 3),
                 std::to_string(source.mesh.vertex_count()) + ", " + std::to_string(target.mesh.vertex_count()),
                 number(pair.k, 5), number(found.map.k, 5), found.inverse_k ? number(*found.inverse_k, 5) : "–",
                 number(there.k, 5), scientific(there.k - pair.k),
                 number(there.lower, 5) + "–" + number(there.upper, 5), sliding ? number(sliding.all->k, 5) : "refused",
                 number(found.map.weighted_deviation), std::to_string(found.map.history.size() - 1),
                 std::to_string(found.map.distortion.flipped.size()) + " / " +
                     std::to_string(there.distortion.flipped.size())});
            if (h != 0.04) continue;
            const double shown = std::min(1.0, 1.6 * there.k);
            const std::string name =
                "genus_boundary_" + std::to_string(pair.from.size()) + (pair.name == "Example 4" ? "_4" : "");
            const std::string data = output.write(name, from.surface().mesh, there.map, there.distortion.face_abs_mu);
            figure.pictures.push_back(
                {name,
                 pair.name + ", h = .04, k = " + number(there.k, 5) + " where " + number(pair.k, 5) + " is known.",
                 {circles_panel(data, "source", "source", 26), circles_panel(data, "image", "image", 26),
                  map_panel(data, "|μ|", shown), histogram_panel({{"", data}}, "", there.k, shown)}});
        }
    figure.tables.push_back(std::move(table));
}

HyperbolicMap between(const bench::SlitTorus& a, const bench::SlitTorus& b) {
    const HyperbolicShape from(a.surface), to(b.surface);
    return hyperbolic_map(from, to,
                          marking_by_vertices(a.surface, from.metric().original, to.group(), same_places(a, b)).map);
}

/// The coarsest cells of source and target to a side.
constexpr int kSlitCells = 16, kSlitTargetCells = 24;

void add_refined_slit_tori(Figure& figure) {
    Table table{
        "The flat torus of the unit square less a rectangle, stretched to s times its height: extremal with K = "
        "s, exactly. Vertices are moved, diagonals at random; every mesh is the one before with its faces cut into "
        "four",
        {"s", "vertices", "k", "exact", "error", "order", "bracket of K", "std", "max", "steps", "flips"},
        {}};
    std::vector<Curve> curves;
    for (const double s : {1.5, 4.0}) {
        const double exact = (s - 1) / (s + 1);
        double before = 0;
        Curve curve{"k " + number(exact, 1), {}, {}};
        for (int refinements = 0; refinements < 4; ++refinements) {
            const bench::SlitTorus a = bench::slit_torus(kSlitCells, 1, 1, refinements),
                                   b = bench::slit_torus(kSlitTargetCells, s, 2, refinements);
            const HyperbolicMap map = between(a, b);
            const double error = map.k - exact;
            table.rows.push_back(
                {number(s, 1),
                 std::to_string(a.surface.mesh.vertex_count()) + ", " + std::to_string(b.surface.mesh.vertex_count()),
                 number(map.k, 5), number(exact, 5), scientific(error),
                 before > 0 ? number(std::log2(before / std::abs(error)), 2) : "",
                 number(map.K_lower) + "–" + number(map.K_upper), number(map.weighted_deviation),
                 number(map.distortion.max, 3), std::to_string(map.history.size() - 1),
                 std::to_string(map.distortion.flipped.size())});
            before = std::abs(error);
            curve.x.push_back(kSlitCells * std::exp2(refinements));
            curve.y.push_back(before);
        }
        curves.push_back(std::move(curve));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back({"genus_boundary_slit",
                               "Errors of k of the torus less a rectangle, by cells to a side: of second order.",
                               {curves_panel(curves, "the torus less a rectangle", "cells to a side", "error of k")}});
}

/// Meshes that have nothing to do with each other: the error of one is partly chance.
void add_random_slit_tori(Figure& figure) {
    constexpr int kMeshes = 8;
    Table table{"The same on " + std::to_string(kMeshes) +
                    " independent pairs of meshes of every size: the mean of the errors, the least and the largest",
                {"s", "vertices", "mean error", "order", "from", "to", "flips"},
                {}};
    for (const double s : {1.5, 4.0}) {
        double before = 0;
        for (int factor = 1; factor <= 4; factor *= 2) {
            double sum = 0, least = 1, largest = -1;
            std::size_t flips = 0;
            std::string vertices;
            for (unsigned seed = 1; seed <= kMeshes; ++seed) {
                const bench::SlitTorus a = bench::slit_torus(kSlitCells * factor, 1, 2 * seed - 1),
                                       b = bench::slit_torus(kSlitTargetCells * factor, s, 2 * seed);
                const HyperbolicMap map = between(a, b);
                const double error = map.k - (s - 1) / (s + 1);
                sum += error;
                least = std::min(least, error);
                largest = std::max(largest, error);
                flips += map.distortion.flipped.size();
                vertices = std::to_string(a.surface.mesh.vertex_count()) + ", " +
                           std::to_string(b.surface.mesh.vertex_count());
            }
            const double mean = sum / kMeshes;
            table.rows.push_back({number(s, 1), vertices, scientific(mean),
                                  before > 0 ? number(std::log2(before / std::abs(mean)), 2) : "", scientific(least),
                                  scientific(largest), std::to_string(flips)});
            before = std::abs(mean);
        }
    }
    figure.tables.push_back(std::move(table));
}

/// A scan onto its refinement, deformed in space.
struct ScanPair {
    std::string file, change;
    std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)> at;  ///< of points from −1 to 1
    std::string picture;
    double azimuth, elevation;
    bool refined = true;     ///< the target; else as it is
    bool exchanged = false;  ///< from the deformed refinement to the scan
};

void add_scan_pair(Output& output, Figure& figure, Table& table, const ScanPair& pair) {
    const auto path = scan_path(pair.file);
    if (!path) return;
    const Mesh scan = read_mesh(*path).mesh;
    const Eigen::RowVector3d middle = scan.positions.colwise().mean();
    const double size = (scan.positions.rowwise() - middle).cwiseAbs().maxCoeff();
    const auto changed = [&](Mesh mesh, bool back = false) {
        for (int v = 0; v < mesh.vertex_count(); ++v)
            mesh.positions.row(v) =
                back ? (mesh.positions.row(v) - middle) / size : pair.at((mesh.positions.row(v) - middle) / size);
        return mesh;
    };
    const Mesh refined = bench::root_three_refined(scan);
    const Surface source(pair.exchanged ? changed(refined) : scan),
        target(pair.exchanged ? changed(scan, true) : changed(refined));
    const HyperbolicShape from(source), to(target);
    HandleMarking marking;
    marking.start = pair.exchanged ? changed(refined, true).positions : changed(scan).positions;
    const HandleRegistration found = register_handles(from, to, marking);
    table.rows.push_back(handle_row(pair.file + (pair.exchanged ? " from " : ", ") + pair.change, from, to, found));
    if (!pair.picture.empty())
        figure.pictures.push_back(handle_picture(output, pair.picture,
                                                 pair.file + ", " + pair.change + ", k = " + number(found.map.k) + ".",
                                                 from, found.map, pair.azimuth, pair.elevation));
}

}  // namespace

Figure genus_boundary(Output& output) {
    Figure figure{"Boundaries that slide, as halves of doubles",
                  "Surfaces with a boundary have the metric of their doubles, in which the boundary is geodesic; maps "
                  "are solved on the half ([higher genus](higher-genus.md))."};
    add_planar(output, figure);
    add_refined_slit_tori(figure);
    add_random_slit_tori(figure);
    return figure;
}

Figure genus_open_scans(Output& output) {
    if (!scan_path("punctured_torus.obj")) return {};
    Figure figure{
        "Open scans",
        "Scans with a boundary onto √3-refinements of deformed copies, which have none of their edges inside. "
        "punctured_torus: genus 1, one loop; alex_3: four loops."};
    Table table{"", handle_head("scan, deformation"), {}};
    using Row = Eigen::RowVector3d;
    const auto wider = [](const Row& p) { return Row(p[0], 1.3 * p[1], p[2]); };
    add_scan_pair(output, figure, table, {"punctured_torus.obj", "none", [](const Row& p) { return p; }, "", 30, 45});
    add_scan_pair(output, figure, table, {"punctured_torus.obj", "y · 1.3", wider, "genus_open_torus", 30, 45});
    add_scan_pair(output, figure, table, {"punctured_torus.obj", "y · 1.3", wider, "", 30, 45, true, true});
    add_scan_pair(output, figure, table,
                  {"punctured_torus.obj", "y · 2", [](const Row& p) { return Row(p[0], 2 * p[1], p[2]); }, "", 30, 45});
    add_scan_pair(
        output, figure, table,
        {"alex_3.obj", "x · 1.3, z + .2 x²",
         [](const Row& p) { return Row(1.3 * p[0], p[1], p[2] + 0.2 * p[0] * p[0]); }, "genus_open_face", -90, 84});
    figure.tables.push_back(std::move(table));
    return figure;
}

namespace {

/// Flips of the harmonic map whose circles are moved and scaled onto their partners, as they are.
std::size_t flips_of_moved_circles(const Surface& source, const Pair& pair) {
    BoundaryCondition boundary;
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        for (const int v : loop) {
            const Complex z(source.mesh.positions(v, 0), source.mesh.positions(v, 1));
            Complex image = z;
            double least = std::abs(std::abs(z) - 1);
            for (std::size_t h = 0; h < pair.from.size(); ++h) {
                const Complex from(pair.from[h][0], pair.from[h][1]), to(pair.to[h][0], pair.to[h][1]);
                const double off = std::abs(std::abs(z - from) - pair.from[h][2]);
                if (off >= least) continue;
                least = off;
                image = to + pair.to[h][2] / pair.from[h][2] * (z - from);
            }
            boundary.pin(v, image);
        }
    return solve(source, {boundary}, "harmonic").distortion.flipped.size();
}

/// Edges of .7 h on the outer circle and of min(1, 4 r) h at holes of radius r, growing by a quarter of the way to h.
Mesh graded_disk_with_holes(const std::vector<Hole>& holes, double h) {
    std::vector<Circle> circles;
    for (const auto& [x, y, r] : holes) circles.push_back({{x, y}, r});
    DomainOptions options;
    options.edge_length = h;
    options.size = [circles, h](const Eigen::Vector2d& place) {
        double size = std::min(h, 0.7 * h + 0.25 * (1 - place.norm()));
        for (const Circle& hole : circles)
            size = std::min(
                size, std::min(1.0, 4 * hole.radius) * h + 0.25 * std::abs((place - hole.centre).norm() - hole.radius));
        return size;
    };
    return circle_domain({Eigen::Vector2d::Zero(), 1}, circles, options);
}

void add_starts(Output& output, Figure& figure, Table& table, const Pair& pair, const std::string& meshing,
                const Mesh& mesh) {
    constexpr double h = 0.04;
    const Surface source(mesh);
    std::unique_ptr<TargetModel> model;
    const SlidingStart even = even_start_of(source, pair.to, h, &model);
    const std::optional<SlidingStart> found = hyperbolic_sliding_start(source, *model, even, h);
    const SolvedOnto solved = solve_onto(source, {circles_target(pair.to), numbered(pair.to.size())});
    const auto flips = [&](const Eigen::VectorXcd& map) {
        return std::to_string(distortion(source.operators, map).flipped.size());
    };
    table.rows.push_back(
        {pair.name, meshing, std::to_string(source.mesh.vertex_count()),
         std::to_string(flips_of_moved_circles(source, pair)), flips(even.map), found ? flips(found->map) : "folds too",
         found ? number(distortion(source.operators, found->map).max, 2) : "–",
         solved ? number(solved.all->k, 5) : "refused", solved ? std::to_string(solved.all->iterations) : ""});
    if (!found || pair.name != "Example 4" || !figure.pictures.empty()) return;
    const auto values = [&](const Eigen::VectorXcd& map) { return distortion(source.operators, map).face_abs_mu; };
    const std::string folded = output.write("genus_starts_even", source.mesh, even.map, values(even.map)),
                      smooth = output.write("genus_starts", source.mesh, found->map, values(found->map));
    figure.pictures.push_back(
        {"genus_starts",
         "Example 4: the even harmonic map, its flipped faces red, and the harmonic map between the doubles.",
         {map_panel(folded, "even"), circles_panel(folded, "even", "image", 26), map_panel(smooth, "between doubles"),
          circles_panel(smooth, "between doubles", "image", 26)}});
}

}  // namespace

Figure genus_starts(Output& output) {
    Figure figure{"Starts for boundaries that slide in the plane",
                  "Harmonic maps with boundary values given fold; the harmonic map between the doubles, whose boundary "
                  "slides, does not, and is the start where the others fold ([sliding boundaries](sliding.md))."};
    Table table{
        "h = .04; at the holes .4 h, or graded: .7 h at the outer circle, min(1, 4 r) h at holes of radius r, growing "
        "by 1/4. Moved: every circle moved and scaled onto its partner; how much folds, that is how fine the mesh is "
        "there. Even: the source's circle domain first moved towards the target by the best Möbius map, then every "
        "loop laid on evenly. Largest abs(μ) of the start between doubles; k of the extremal map and linear solves to "
        "it, in all",
        {"pair", "mesh", "vertices", "flips, moved", "even", "between doubles", "max abs(μ)", "k", "solves"},
        {}};
    for (const Pair& pair : pairs()) {
        constexpr double h = 0.04;
        add_starts(output, figure, table, pair, ".4 h", disk_with_holes(pair.from, h));
        add_starts(output, figure, table, pair, "graded", graded_disk_with_holes(pair.from, h));
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
