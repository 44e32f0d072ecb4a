// More holes, arbitrary shapes and sizes, seconds.
#include <beltrami/base/constants.h>
#include <beltrami/report/timing.h>
#include <beltrami/solve/beltrami_solver.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

constexpr double kEdge = 0.02;

/// One hole in the middle and eight around it.
std::vector<Hole> nine_holes(double middle, double distance, double turn, double even, double odd) {
    std::vector<Hole> holes{{0, 0, middle}};
    for (int i = 0; i < 8; ++i) {
        const Complex c = std::polar(distance, kPi * i / 4 + turn);
        holes.push_back({c.real(), c.imag(), i % 2 == 0 ? even : odd});
    }
    return holes;
}

/// harmonic_seconds() is the median of so many maps.
constexpr int kHarmonicRuns = 3;

double processor_seconds(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

std::vector<Complex> regular_polygon(Complex centre, double radius, int corners, double turn) {
    std::vector<Complex> result;
    for (int i = 0; i < corners; ++i) result.push_back(centre + std::polar(radius, turn + 2 * kPi * i / corners));
    return result;
}

/// Root of the mean square of |μ| − k, weighted by |φ| and area: as the bracket of k sees it.
double weighted_deviation(const Surface& source, const SolvedOnto& solved) {
    const Surface mapped(solved.mesh(source));
    double sum = 0, all = 0;
    for (int f = 0; f < mapped.mesh.face_count(); ++f) {
        const double weight = mapped.operators.weights[f] * std::abs(solved.all->phi[f]);
        const double off = std::min(1.0, solved.all->distortion.face_abs_mu[f]) - solved.all->k;
        sum += weight * off * off;
        all += weight;
    }
    return std::sqrt(sum / all);
}

/// Where |μ| stays clearly below k: its part of the area, and of ∫|φ|.
struct FaintPart {
    double area = 0, phi = 0;
};
FaintPart faint_part(const Surface& source, const SolvedOnto& solved) {
    FaintPart part;
    if (!solved) return part;
    const Surface mapped(solved.mesh(source));
    double area = 0, phi = 0;
    for (int f = 0; f < mapped.mesh.face_count(); ++f) {
        const double a = mapped.operators.weights[f], p = a * std::abs(solved.all->phi[f]);
        area += a;
        phi += p;
        if (solved.all->distortion.face_abs_mu[f] < 0.93 * solved.all->k) part.area += a, part.phi += p;
    }
    return {part.area / area, part.phi / phi};
}

}  // namespace

Figure sliding_06(Output& output) {
    Figure figure{"Examples 6 and 7: five and nine holes",
                  "*The paper:* extremal maps between circle domains with five and with nine holes, whose |μ| is "
                  "uniform (pictures only)."};
    Table table{"Circle domains made here, h = .02", onto_head("map"), {}};
    {
        const std::vector<Hole> from{
            {0, 0, 0.12}, {0.5, 0.1, 0.1}, {0, 0.5, 0.14}, {-0.5, -0.05, 0.1}, {0.05, -0.5, 0.12}},
            to{{0.1, 0.05, 0.1}, {0.55, 0.25, 0.15}, {-0.15, 0.55, 0.1}, {-0.55, -0.15, 0.17}, {0, -0.55, 0.1}};
        const Surface source(disk_with_holes(from, kEdge));
        OntoExample{"sliding_06", "Five holes", 26}.run(output, figure, table, source, circles_target(to), numbered(5));
        const Surface target(disk_with_holes(to, kEdge));
        table.rows.push_back(
            onto_row("Five holes, back", target, "", solve_onto(target, {circles_target(from), numbered(5)})));
    }
    {
        const std::vector<Hole> from = nine_holes(0.12, 0.6, 0, 0.1, 0.1), to = nine_holes(0.2, 0.65, 0.2, 0.06, 0.14);
        const Surface source(disk_with_holes(from, kEdge));
        OntoExample{"sliding_07", "Nine holes", 26}.run(output, figure, table, source, circles_target(to), numbered(9));
        const Surface target(disk_with_holes(to, kEdge));
        table.rows.push_back(
            onto_row("Nine holes, back", target, "", solve_onto(target, {circles_target(from), numbered(9)})));
    }
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure sliding_08(Output& output) {
    Figure figure{"Examples 8, 10 and 11: arbitrary shapes and sizes",
                  "*The paper:* extremal maps between domains of arbitrary shapes with two holes (8), between circle "
                  "domains whose holes have very different sizes (10), and between domains whose holes have different "
                  "shapes (11); |μ| is uniform in all histograms."};
    std::vector<std::string> head = onto_head("map");
    head.insert(head.begin() + 7, "std weighted by abs(φ)");
    Table table{"Domains made here", head, {}};
    const auto row = [&](const std::string& name, const Surface& source, const SolvedOnto& solved) {
        std::vector<std::string> cells = onto_row(name, source, "", solved);
        if (solved) cells.insert(cells.begin() + 7, number(weighted_deviation(source, solved)));
        table.rows.push_back(std::move(cells));
    };
    const auto both = [&](const OntoExample& example, const TargetDomain& from, const TargetDomain& to, double h,
                          double hole_h) {
        const Surface source(domain_mesh(from, h, hole_h)), target(domain_mesh(to, h, hole_h));
        Table own;
        const SolvedOnto there = example.run(output, figure, own, source, to);
        row(example.caption, source, there);
        row(example.caption + ", back", target, solve_onto(target, from));
        return std::pair{faint_part(source, there), there ? there.all->k : 0.0};
    };
    both({"sliding_08", "Example 8: splines, two holes"},
         target_domain(polar_spline(0, [](double t) { return 1 + 0.2 * std::cos(3 * t) + 0.1 * std::sin(2 * t); }),
                       {polar_spline({-0.35, 0.1}, [](double t) { return 0.2 + 0.05 * std::cos(2 * t); }),
                        polar_spline({0.4, 0}, [](double t) { return 0.2 + 0.05 * std::cos(3 * t + 1); })}),
         target_domain(polar_spline(0, [](double t) { return 1.1 + 0.15 * std::cos(2 * t) + 0.1 * std::cos(5 * t); }),
                       {polar_spline({-0.5, -0.2}, [](double t) { return 0.18 + 0.06 * std::sin(3 * t); }),
                        polar_spline({0.4, 0.2}, [](double t) { return 0.3 + 0.06 * std::cos(4 * t); })}),
         0.015, 0.006);
    both({"sliding_10", "Example 10: very different sizes"},
         circles_target({{-0.3, 0.1, 0.4}, {0.5, 0.35, 0.08}, {0.45, -0.35, 0.03}}),
         circles_target({{-0.2, 0.2, 0.25}, {0.5, 0.35, 0.03}, {0.3, -0.45, 0.12}}), kEdge, 0.4 * kEdge);
    const auto [faint, k] =
        both({"sliding_10_extreme", "Example 10, sizes exchanged"},
             circles_target({{-0.4, 0.05, 0.4}, {0.35, 0.3, 0.1}, {0.4, -0.4, 0.025}}),
             circles_target({{-0.45, 0, 0.3}, {0.45, 0.35, 0.025}, {0.35, -0.4, 0.25}}), kEdge, 0.2 * kEdge);
    both({"sliding_11", "Example 11: round holes to polygons and a star"},
         circles_target({{-0.45, 0.1, 0.2}, {0.4, 0.35, 0.15}, {0.25, -0.5, 0.2}}),
         target_domain(TargetCurve::circle(0, 1),
                       {TargetCurve::polygon(regular_polygon({-0.45, 0.1}, 0.3, 4, 0.3)),
                        TargetCurve::polygon(regular_polygon({0.4, 0.4}, 0.22, 3, 0.5)),
                        polar_spline({0.25, -0.45}, [](double t) { return 0.2 + 0.06 * std::cos(5 * t); })}),
         0.015, 0.0015);
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "There and back agree in k within their brackets. In the second Example 10 a hole of radius .1 becomes .025 "
        "and "
        "one of .025 becomes .25. φ grows like the inverse square of the distance from the small hole, and beside the "
        "large one hardly anything of it is "
        "left: the faces with abs(μ) < .93 k are " +
        number(100 * faint.area, 1) + " % of the area and hold " + number(100 * faint.phi, 2) +
        " % of ∫abs(φ). What the map does there does not enter k = " + number(k) +
        ", the iteration leaves it alone, and the std by area says so; weighted by abs(φ), as the bracket sees it, it "
        "is a third of "
        "that. Finer edges at the small hole help k, not this.");
    figure.remarks.push_back(
        "In the bays of the star a circle's edges are stretched most: with edges of .006 at the holes the images "
        "turned by more than a radian an edge "
        "there and std was .0143; with .0015 it is that of the table. The largest abs(μ) is that of single faces at "
        "corners of "
        "the polygons, to which no corner of a circle corresponds.");
    return figure;
}

namespace {

/// A pair of domains between round holes, and the row of Table 1 whose size its mesh has.
struct TimedPair {
    std::string name;
    std::vector<Hole> from, to;
    int vertices, faces;  ///< of the paper's mesh
    double seconds, sup;  ///< as the paper has them
};

std::vector<TimedPair> timed_pairs() {
    const std::vector<Hole> five{{0, 0, 0.12}, {0.5, 0.1, 0.1}, {0, 0.5, 0.14}, {-0.5, -0.05, 0.1}, {0.05, -0.5, 0.12}},
        five_to{{0.1, 0.05, 0.1}, {0.55, 0.25, 0.15}, {-0.15, 0.55, 0.1}, {-0.55, -0.15, 0.17}, {0, -0.55, 0.1}};
    return {
        {"Example 4, three holes",
         {{0, 0.33, 0.1}, {0.33, -0.33, 0.067}, {-0.33, -0.33, 0.133}},
         {{0, 0.6, 0.1}, {0.7, -0.3, 0.1}, {-0.7, -0.3, 0.1}},
         22'160,
         43'115,
         87.7018,
         0.330403},
        {"nine holes", nine_holes(0.12, 0.6, 0, 0.1, 0.1), nine_holes(0.2, 0.65, 0.2, 0.06, 0.14), 17'746, 35'008,
         73.0281, 0.446511},
        {"two holes",
         {{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}},
         {{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}},
         17'746,
         35'008,
         62.6791,
         0.091014},
        {"Example 5, three holes",
         {{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}},
         {{0, 0.5, 0.2}, {-0.4, -0.3, 0.2}, {0.4, -0.3, 0.2}},
         6'282,
         12'141,
         19.9097,
         0.343128},
        {"five holes", five, five_to, 4'832, 9'376, 7.6386, 0.378116},
        {"ring", {{0, 0, 0.5}}, {{0, 0, 0.3}}, 671, 1'240, 0.9367, 0.039436},
        {"two holes, hardly moved",
         {{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}},
         {{-0.42, 0.08, 0.19}, {0.36, 0.03, 0.26}},
         588,
         1'056,
         1.3129,
         0.073473},
    };
}

/// A mesh of so many vertices, nearly. Small meshes have fewer vertices a hole.
Mesh mesh_of_size(const std::vector<Hole>& holes, int vertices) {
    double h = std::sqrt(1.1 * kPi / vertices);
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh = disk_with_holes(holes, h, vertices < 1000 ? 16 : 30);
        h *= std::sqrt(static_cast<double>(mesh.vertex_count()) / vertices);
    }
    return mesh;
}

}  // namespace

Figure sliding_09(Output&) {
    Figure figure{"Example 9: seconds",
                  "*The paper* (Table 1, an i7 of 2.1 GHz): seven pairs of domains which it does not name; it stops "
                  "when μ changes by less than 1e-3."};
    Table table{
        "Pairs of circle domains with meshes of the sizes of Table 1. A harmonic map and the extremal map of the same "
        "mesh are measured in one run, each from the loaded mesh to the result: its examination and topology, "
        "operators, "
        "ordering, analysis, factorisations and solutions. Without the first two a harmonic map is shorter: the ratio "
        "to that is in brackets. Seconds are processor seconds, those of all threads together, the least of three: "
        "they hardly depend on "
        "what else the machine does, and the clock shows less",
        {"vertices (paper)", "triangles (paper)", "seconds (paper)", "sup abs(μ) (paper)", "our pair", "vertices",
         "triangles", "harmonic s", "extremal s", "ratio", "paper's s over ours", "k", "std", "sup abs(μ)", "flips",
         "iterations"},
        {}};
    for (const TimedPair& pair : timed_pairs()) {
        const TargetDomain target = circles_target(pair.to);
        const Mesh mesh = mesh_of_size(pair.from, pair.vertices);
        BoundaryCondition boundary;
        const Surface surface(mesh);
        for (const auto& loop : surface.topology.boundary_loops)
            for (const int v : loop) boundary.pin(v, Complex(mesh.positions(v, 0), mesh.positions(v, 1)));
        double harmonic = 1e300, whole = 1e300, extremal = 1e300;
        SolvedOnto solved;
        for (int i = 0; i < 3; ++i) {
            std::clock_t start = std::clock();
            beltrami::harmonic_seconds(surface, boundary);
            harmonic = std::min(harmonic, processor_seconds(start) / kHarmonicRuns);
            start = std::clock();
            beltrami::harmonic_map(Surface(mesh), boundary);
            whole = std::min(whole, processor_seconds(start));
            start = std::clock();
            solved = solve_onto([&] {
                const Surface source(mesh);
                return extremal_map(source, {target, numbered(pair.from.size())});
            });
            if (!solved) break;
            extremal = std::min(extremal, processor_seconds(start));
        }
        std::vector<std::string> cells{std::to_string(pair.vertices),
                                       std::to_string(pair.faces),
                                       number(pair.seconds, 1),
                                       number(pair.sup, 3),
                                       pair.name,
                                       std::to_string(mesh.vertex_count()),
                                       std::to_string(mesh.face_count()),
                                       number(whole, 4)};
        if (!solved) {
            cells.push_back("refused: " + solved.refusal);
            table.rows.push_back(std::move(cells));
            continue;
        }
        const ExtremalMap& found = *solved.all;
        for (const std::string& cell :
             {number(extremal, 3), number(extremal / whole, 1) + " (" + number(extremal / harmonic, 1) + ")",
              number(pair.seconds / extremal, 0), number(found.k, 5), number(found.distortion.standard_deviation),
              number(found.distortion.max, 3), std::to_string(found.distortion.flipped.size()),
              std::to_string(found.iterations)})
            cells.push_back(cell);
        table.rows.push_back(std::move(cells));
    }
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "The machine is another one than the paper's, so only the ratios to a harmonic map carry over. On small meshes "
        "what does not grow with them (the grid of the c-step, the space of differentials) outweighs a harmonic map, "
        "which takes a millisecond there. sup abs(μ) of the paper is that of its own pairs.");
    return figure;
}

}  // namespace beltrami::gallery
