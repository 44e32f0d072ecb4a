// Closed surfaces of genus 2 and 3 in space: deformations, bad starts, Dehn twists, a scan, a search, distances.
#include <algorithm>
#include <cmath>
#include <memory>

#include <beltrami/base/random.h>

#include "gallery/handles.h"
#include "problems/level_surface.h"

namespace beltrami::gallery {

namespace {

struct Deformation {
    std::string name;
    bench::Stretch stretch;
    double edge = 1;  ///< of its mesh, against that of the others
};

const Deformation kAsItIs{"1", [](double) { return 1.0; }};
const Deformation kWide{"1.3 + (x − 1)/4", [](double x) { return 1.3 + 0.25 * (x - 1); }};
const Deformation kWidest{"2.2 + .6 (x − 1)", [](double x) { return 2.2 + 0.6 * (x - 1); }};
const Deformation kLessWide{"1.15 + (x − 1)/8", [](double x) { return 1.15 + 0.125 * (x - 1); }};
const Deformation kNarrow{".55 + (x − 1)/10", [](double x) { return 0.55 + 0.1 * (x - 1); }, 0.6};

/// The map in the class of a map of space, from vertices that begin at its images.
HandleRegistration by_deformation(const HyperbolicShape& source, const HyperbolicShape& target,
                                  const Deformation& deformation) {
    HandleMarking marking;
    marking.start = stretched(source.given().mesh, deformation.stretch).positions;
    return register_handles(source, target, marking);
}

/// The same map from images that were moved, each in its own frame.
EquivariantMap moved(const Topology& topology, EquivariantMap map, const std::vector<DiskIsometry>& by) {
    for (std::size_t e = 0; e < map.steps.size(); ++e) {
        const auto [i, j] = topology.edges[e];
        map.steps[e] =
            (by[static_cast<std::size_t>(i)].inverse() * map.steps[e] * by[static_cast<std::size_t>(j)]).normalized();
    }
    for (std::size_t v = 0; v < by.size(); ++v) map.frames[v] = (map.frames[v] * by[v]).normalized();
    return map;
}

/// Displacements that take the images of all vertices to that of the first one, along a tree.
std::vector<DiskIsometry> to_one_point(const Topology& topology, const EquivariantMap& map, int vertices) {
    std::vector<std::vector<std::pair<int, DiskIsometry>>> next(static_cast<std::size_t>(vertices));
    for (std::size_t e = 0; e < map.steps.size(); ++e) {
        const auto [i, j] = topology.edges[e];
        next[static_cast<std::size_t>(i)].emplace_back(j, map.steps[e]);
        next[static_cast<std::size_t>(j)].emplace_back(i, map.steps[e].inverse());
    }
    std::vector<DiskIsometry> by(static_cast<std::size_t>(vertices));
    std::vector<char> known(by.size(), 0);
    std::vector<int> order{0};
    known[0] = 1;
    for (std::size_t n = 0; n < order.size(); ++n)
        for (const auto& [w, step] : next[static_cast<std::size_t>(order[n])]) {
            if (known[static_cast<std::size_t>(w)]) continue;
            known[static_cast<std::size_t>(w)] = 1;
            by[static_cast<std::size_t>(w)] = (step.inverse() * by[static_cast<std::size_t>(order[n])]).normalized();
            order.push_back(w);
        }
    return by;
}

void add_bad_starts(Figure& figure) {
    const Surface source(bench::level_double_torus(1.0 / 14, kAsItIs.stretch, false)),
        target(bench::level_double_torus(1.0 / 14, kWidest.stretch, true));
    const HyperbolicShape from(source), to(target);
    const EquivariantMap near = marking_by_vertices(source, from.metric().original, to.group(),
                                                    nearest_vertices(source.topology, target.topology, target.mesh,
                                                                     to.metric().metric.triangles,
                                                                     stretched(source.mesh, kWidest.stretch).positions))
                                    .map;
    const int n = source.mesh.vertex_count();
    Table table{"Bad starts in the class of y · (" + kWidest.name +
                    "): the harmonic map is the minimum of a convex energy, and all end in the same one. Steps of "
                    "Newton's method to it; the longest edge of the start, hyperbolic",
                {"start", "longest edge", "steps", "energy", "k", "k minus the first"},
                {}};
    std::optional<double> first;
    Random random(1);
    for (const auto& [name, most] : {std::pair<std::string, double>{"near the images", 0},
                                     {"all vertices at one point", -1},
                                     {"displaced by up to .5 both ways", 0.5},
                                     {"displaced by up to 2 both ways", 2}}) {
        std::vector<DiskIsometry> by(static_cast<std::size_t>(n));
        if (most < 0) by = to_one_point(source.topology, near, n);
        if (most > 0)
            for (DiskIsometry& one : by)
                one = DiskIsometry::translation({random.uniform(-most, most), random.uniform(-most, most)});
        EquivariantMap start = moved(source.topology, near, by);
        double longest = 0;
        for (const DiskIsometry& step : start.steps) longest = std::max(longest, step.distance());
        const HyperbolicMap map = hyperbolic_map(from, to, std::move(start));
        if (!first) first = map.k;
        table.rows.push_back({name, number(longest, 2), std::to_string(map.start_steps), number(map.energy, 10),
                              number(map.k, 10), scientific(map.k - *first)});
    }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure genus_deformed(Output& output) {
    Figure figure{"Deformed double tori",
                  "(x(x − 1)²(x − 2) + y²)² + z² = .027, and the same with y multiplied by a function of x, each "
                  "meshed on its own."};
    Table table{
        "Vertices begin near the images of the same points. Back: the extremal map of the target onto the source, from "
        "its own mesh and differentials. The converged k are .0979, .2945 and .1937",
        handle_head("y times"),
        {}};
    for (const Deformation& deformation : {kAsItIs, kWide, kWidest, kNarrow})
        for (const int cells : {10, 14, 24}) {
            const Surface source(bench::level_double_torus(1.0 / cells, kAsItIs.stretch, false)),
                target(bench::level_double_torus(deformation.edge / cells, deformation.stretch, true));
            const HyperbolicShape from(source), to(target);
            const HandleRegistration found = by_deformation(from, to, deformation);
            table.rows.push_back(handle_row(deformation.name, from, to, found));
            if (cells == 14 && deformation.name == kWidest.name)
                figure.pictures.push_back(
                    handle_picture(output, "genus_deformed",
                                   "Onto y · (" + deformation.name +
                                       "): the double torus cut open in the hyperbolic plane, with the |μ| of its "
                                       "faces, k = " +
                                       number(found.map.k) + "; circles of the polygon on the source and on its image.",
                                   from, found.map));
        }
    figure.tables.push_back(std::move(table));
    add_bad_starts(figure);
    return figure;
}

Figure genus_twists(Output& output) {
    Figure figure{"Dehn twists", "The double torus onto y · (" + kWide.name +
                                     ") in other classes: after Dehn twists about the short "
                                     "loops that `uniformize --loops` writes."};
    Table table{
        "Length: of the closed geodesic in the loop's class, in the metric of curvature −1. Where K is below "
        "what the homology asks for, the mesh does not resolve the map",
        handle_head("length of the loop, twists"),
        {}};
    const Surface source(bench::level_double_torus(1.0 / 14, kAsItIs.stretch, false)),
        target(bench::level_double_torus(1.0 / 14, kWide.stretch, true));
    const HyperbolicShape from(source), to(target);
    const auto& loops = from.forms().homology.loops;
    // The lengths of the loops, from the steps along them.
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        EquivariantMap identity;
        std::vector<int> same(static_cast<std::size_t>(source.mesh.vertex_count()));
        for (std::size_t v = 0; v < same.size(); ++v) same[v] = static_cast<int>(v);
        const EquivariantMap there = marking_by_vertices(source, from.metric().original, from.group(), same).map;
        DiskIsometry around;
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const int a = loops[l][i], b = loops[l][(i + 1) % loops[l].size()];
            const DiskIsometry& step = there.steps[static_cast<std::size_t>(edge_between(source.topology, a, b))];
            around = around * (a < b ? step : step.inverse());
        }
        order.emplace_back(around.translation_length(), l);
    }
    std::ranges::sort(order);
    bool drawn = false;
    for (const auto& [length, l] : order)
        for (const int turns : length < 2 ? std::vector<int>{1, -1, 2} : std::vector<int>{1}) {
            HandleMarking marking;
            marking.start = stretched(source.mesh, kWide.stretch).positions;
            marking.twists.push_back({loops[l], turns});
            const HandleRegistration found = register_handles(from, to, marking);
            table.rows.push_back(handle_row(number(length, 2) + ", " + std::to_string(turns), from, to, found));
            if (turns != 2 || drawn) continue;
            drawn = true;
            figure.pictures.push_back(handle_picture(
                output, "genus_twists",
                "Two Dehn twists about a loop of length " + number(length, 2) + ", k = " + number(found.map.k) + ".",
                from, found.map));
        }
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure genus_three(Output& output) {
    Figure figure{"Genus 3",
                  "Three rings melted together: in a row, a hyperelliptic surface, where products of 1-forms do not "
                  "span the quadratic differentials; and in a triangle, which is none."};
    Table table{
        "Onto deformed ones with meshes of their own. The converged k are .1149 and .1450 in a row, .0855 and "
        ".1060 in a triangle",
        handle_head("rings, y times"),
        {}};
    const std::vector<Deformation> deformations{
        kAsItIs,
        {"1.3 + (x − 1.1)/5", [](double x) { return 1.3 + 0.2 * (x - 1.1); }},
        {".7 + .15 (x − 1.1)", [](double x) { return 0.7 + 0.15 * (x - 1.1); }}};
    for (const bool in_a_row : {true, false})
        for (const Deformation& deformation : deformations)
            for (const int cells : {10, 14, 20}) {
                const Surface source(bench::three_rings(in_a_row, 1.0 / cells, kAsItIs.stretch, false)),
                    target(bench::three_rings(in_a_row, 1.0 / cells, deformation.stretch, true));
                const HyperbolicShape from(source), to(target);
                const HandleRegistration found = by_deformation(from, to, deformation);
                const std::string name = in_a_row ? "row" : "triangle";
                table.rows.push_back(handle_row(name + ", " + deformation.name, from, to, found));
                if (cells == 14 && deformation.name == deformations[2].name)
                    figure.pictures.push_back(handle_picture(
                        output, "genus_three_" + name,
                        "Rings in a " + name + " onto y · (" + deformation.name + "), k = " + number(found.map.k) + ".",
                        from, found.map));
            }
    figure.tables.push_back(std::move(table));
    return figure;
}

namespace {

/// A map of space, of points from −1 to 1.
struct Change {
    std::string name;
    std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)> at;
};

Mesh changed(Mesh mesh, const Eigen::RowVector3d& middle, double size, const Change& change) {
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.positions.row(v) = change.at((mesh.positions.row(v) - middle) / size);
    return mesh;
}

void add_refined_copies(Output& output, Figure& figure, const HyperbolicShape& from) {
    const Mesh& mesh = from.given().mesh;
    const Eigen::RowVector3d middle = mesh.positions.colwise().mean();
    const double size = (mesh.positions.rowwise() - middle).cwiseAbs().maxCoeff();
    using Row = Eigen::RowVector3d;
    const std::vector<Change> changes{
        {"none", [](const Row& p) { return p; }},
        {"y · 1.3, x + .15 z²", [](const Row& p) { return Row(p[0] + 0.15 * p[2] * p[2], 1.3 * p[1], p[2]); }},
        {"x · 1.6", [](const Row& p) { return Row(1.6 * p[0], p[1], p[2]); }},
        {"y · 3", [](const Row& p) { return Row(p[0], 3 * p[1], p[2]); }}};
    Table table{"Onto deformed copies, each refined so that none of the edges is left", handle_head("deformation"), {}};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const Surface target(changed(bench::root_three_refined(mesh), middle, size, changes[i]));
        const HyperbolicShape to(target);
        HandleMarking marking;
        marking.start = changed(mesh, middle, size, changes[i]).positions;
        const HandleRegistration found = register_handles(from, to, marking);
        table.rows.push_back(handle_row(changes[i].name, from, to, found));
        if (i == 1)
            figure.pictures.push_back(
                handle_picture(output, "genus_scan",
                               "skull_g2 onto its refinement with y · 1.3 and a bend, k = " + number(found.map.k) + ".",
                               from, found.map, 60, 20));
    }
    figure.tables.push_back(std::move(table));
}

/// Energies that starts of a search led to, and how many did.
std::string energies_of(const ClassSearch& search) {
    std::string text;
    int count = 0;
    for (std::size_t i = 0; i < search.reached.size(); ++i) {
        ++count;
        const double here = search.reached[i].energy;
        if (i + 1 < search.reached.size() && search.reached[i + 1].energy < here * (1 + 1e-3)) continue;
        text += (text.empty() ? "" : ", ") + number(here, 2) + " (" + std::to_string(count) + ")";
        count = 0;
    }
    return text + (search.failed > 0 ? ", " + std::to_string(search.failed) + " failed" : "");
}

struct Pair {
    std::string name, picture, caption;
    const HyperbolicShape &from, &to;
};

/// In classes that nothing tells.
void add_search(Output& output, Figure& figure, const std::vector<Pair>& pairs) {
    Table table{
        "Searched (`--marking search`), 8 starts; energies of the harmonic maps on a coarse mesh, in brackets "
        "how many starts led there. No optimum over all classes is proved",
        handle_head("map"),
        {}};
    table.head.insert(table.head.begin() + 2, "energies");
    for (const Pair& pair : pairs) {
        HandleMarking marking;
        marking.search.emplace();
        const HandleRegistration found = register_handles(pair.from, pair.to, marking);
        std::vector<std::string> row = handle_row(pair.name, pair.from, pair.to, found);
        row.insert(row.begin() + 2, energies_of(*found.search));
        table.rows.push_back(std::move(row));
        if (!pair.picture.empty())
            figure.pictures.push_back(
                handle_picture(output, pair.picture,
                               pair.caption + ", in the class that the search found, k = " + number(found.map.k) + ".",
                               pair.from, found.map, 60, 20));
    }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure genus_scan(Output& output) {
    const auto path = scan_path("skull_g2.obj");
    if (!path) return {};
    Figure figure{
        "A scan of genus 2",
        "skull_g2 (5 154 vertices) onto deformed copies; and onto a double torus and back, where nothing tells "
        "the class."};
    const Surface source(read_mesh(*path).mesh), torus(bench::level_double_torus(1.0 / 14, kAsItIs.stretch, false));
    const HyperbolicShape skull(source), other(torus);
    add_refined_copies(output, figure, skull);
    add_search(output, figure,
               {{"skull → double torus", "genus_search", "skull_g2 onto the double torus", skull, other},
                {"double torus → skull", "", "", other, skull}});
    return figure;
}

Figure genus_search(Output& output) {
    Figure figure{"Searching for the class",
                  "Pairs of which the class is known, and not told: double tori, k .0979, and three rings (genus 3), k "
                  ".1149 in a row, .0855 in a triangle. Symmetries of the surfaces lead to classes that are alike."};
    std::vector<std::unique_ptr<const Surface>> surfaces;
    std::vector<std::unique_ptr<const HyperbolicShape>> shapes;
    const auto add = [&](Mesh mesh) {
        surfaces.push_back(std::make_unique<const Surface>(std::move(mesh)));
        shapes.push_back(std::make_unique<const HyperbolicShape>(*surfaces.back()));
    };
    constexpr double edge = 0.1;
    add(bench::level_double_torus(edge, kAsItIs.stretch, false));
    add(bench::level_double_torus(edge, kWide.stretch, true));
    const bench::Stretch stretch = [](double x) { return 1.3 + 0.2 * (x - 1.1); };
    for (const bool in_a_row : {true, false}) {
        add(bench::three_rings(in_a_row, edge, kAsItIs.stretch, false));
        add(bench::three_rings(in_a_row, edge, stretch, true));
    }
    add_search(output, figure,
               {{"double torus", "", "", *shapes[0], *shapes[1]},
                {"rings in a row", "", "", *shapes[2], *shapes[3]},
                {"rings in a triangle", "genus_search_three", "Three rings onto wider ones", *shapes[4], *shapes[5]}});
    return figure;
}

Figure genus_distance(Output& output) {
    Figure figure{"Distances of double tori",
                  "½ log K* between five double tori, each in the class of nearest points or, where these contradict "
                  "each other, in that of maps over a third one, and clusters by mean distance "
                  "(`beltrami distance A B … --picture FILE.svg`)."};
    std::vector<Surface> surfaces;
    const std::vector<std::string> names{"as it is", "another mesh of it", "less wide", "wide", "narrow"};
    const std::vector<Deformation> deformations{kAsItIs, kAsItIs, kLessWide, kWide, kNarrow};
    for (std::size_t i = 0; i < names.size(); ++i)
        surfaces.emplace_back(
            bench::level_double_torus(deformations[i].edge / 14, deformations[i].stretch, i % 2 == 1));
    const DistanceMatrix found = handle_distances(surfaces, Alignment::none, {}, names);
    add_distances(output, figure, "genus_distance", names, found,
                  "Less wide, wide and narrow: y times " + kLessWide.name + ", " + kWide.name + " and " + kNarrow.name +
                      ". In brackets the estimates of bounds");
    return figure;
}

}  // namespace beltrami::gallery
