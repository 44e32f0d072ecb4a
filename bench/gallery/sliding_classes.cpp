// Homotopy classes and starts; distances of shapes.
#include <beltrami/base/constants.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/report/dendrogram.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

void changing_places(Output& output, Figure& figure) {
    Table table{
        "Two holes change places beside a third one, clockwise and counter-clockwise: waypoints lead them. h = "
        ".03",
        onto_head("way"),
        {}};
    const std::vector<Hole> from{{-0.35, 0.25, 0.12}, {0.35, 0.25, 0.12}, {0, -0.5, 0.15}},
        to{{0.35, 0.25, 0.12}, {-0.35, 0.2, 0.14}, {0.1, -0.5, 0.15}};
    const Surface source(disk_with_holes(from, 0.03));
    // From the left hole to the right one, and from each of them up to the outer circle.
    const std::vector<std::pair<Complex, Complex>> segments{
        {{-0.35, 0.25}, {0.35, 0.25}}, {{-0.35, 0.25}, {-0.35, 0.94}}, {{0.35, 0.25}, {0.94, 0.34}}};
    std::vector<double> k;
    for (const double sign : {1.0, -1.0}) {
        Correspondence wanted = numbered(3);
        wanted.waypoints =
            std::vector<Waypoint>{{1, 1, Complex(0, 0.25 - 0.25 * sign)}, {1, 2, Complex(0, 0.25 + 0.25 * sign)}};
        const std::string way = sign > 0 ? "counter-clockwise" : "clockwise";
        const SolvedOnto solved =
            OntoExample{"sliding_classes_" + way, "The upper holes change places, " + way, 26, "", segments}.run(
                output, figure, table, source, circles_target(to), wanted);
        if (solved) k.push_back(solved.all->k);
    }
    if (k.size() == 2) table.caption += ". Two classes, two maps: k = " + number(k[0], 5) + " and " + number(k[1], 5);
    figure.tables.push_back(std::move(table));
}

void rotated_starts(Figure& figure) {
    Table table{"Starts turned against each other, two holes, h = .04, up to 200 iterations (the default is 60)",
                {"turns of outer circle and holes, rad", "k", "difference", "std", "flips of the harmonic start",
                 "flips", "iterations"},
                {}};
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.04));
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    double plain = 0, farthest = 0;
    std::string unsettled;
    for (const std::vector<double>& turns : {std::vector<double>{0, 0, 0},
                                             {0, 0.5, -0.5},
                                             {0, 1, 1},
                                             {0, 1, -1},
                                             {0, 2, 2},
                                             {0, -2, 2},
                                             {0.5, 0, 0},
                                             {1, 0, 0},
                                             {2, 0, 0}}) {
        ExtremalOptions options;
        options.start_turns = turns;
        options.max_iterations = 200;
        const SolvedOnto solved = solve_onto(source, {target, numbered(2)}, options);
        const std::string name = number(turns[0], 1) + ", " + number(turns[1], 1) + ", " + number(turns[2], 1);
        if (!solved) {
            table.rows.push_back({name, "refused: " + solved.refusal});
            continue;
        }
        if (table.rows.empty()) plain = solved.all->k;
        const bool settled = solved.all->termination == Termination::converged;
        if (settled) {
            farthest = std::max(farthest, std::abs(solved.all->k - plain));
        } else {
            unsettled += (unsettled.empty() ? "" : "; ") + name;
        }
        table.rows.push_back({name, number(solved.all->k, 8), number(std::abs(solved.all->k - plain), 8),
                              number(solved.all->distortion.standard_deviation, 5),
                              std::to_string(solved.all->start_flips),
                              std::to_string(solved.all->distortion.flipped.size()),
                              std::to_string(solved.all->iterations) + (settled ? "" : " (not settled)")});
    }
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "Where the iteration settles, k is the same to " + fmt::format("{:.0e}", farthest) + " whatever the start. " +
        (unsettled.empty() ? std::string("All settle.")
                           : "It does not settle, and says so, from the turns " + unsettled + "."));
}

void symmetric_domains(Output& output, Figure& figure) {
    Table table{"Symmetric domains, where products of harmonic forms do not span the differentials, h = .03",
                onto_head("map"),
                {}};
    const auto both = [&](const std::string& name, const std::string& caption, const std::vector<Hole>& from,
                          const std::vector<Hole>& to) {
        const Surface source(disk_with_holes(from, 0.03)), target(disk_with_holes(to, 0.03));
        const Correspondence wanted = numbered(from.size());
        OntoExample{name, caption}.run(output, figure, table, source, circles_target(to), wanted);
        table.rows.push_back(
            onto_row(caption + ", back", target, "", solve_onto(target, {circles_target(from), wanted})));
    };
    both("sliding_classes_line", "Three holes in line", {{-0.5, 0, 0.1}, {0, 0, 0.1}, {0.5, 0, 0.1}},
         {{-0.5, 0, 0.15}, {0, 0, 0.2}, {0.5, 0, 0.15}});
    std::vector<Hole> from, to;
    for (int i = 0; i < 5; ++i) {
        const Complex c = std::polar(0.5, 2 * kPi * i / 5);
        from.push_back({c.real(), c.imag(), 0.1});
        to.push_back({c.real(), c.imag(), 0.2});
    }
    both("sliding_classes_five", "Five symmetric holes", from, to);
    figure.tables.push_back(std::move(table));
}

/// A shape and its name.
struct Named {
    std::string name;
    TargetDomain domain;
};

/// Two families of domains with two holes: pairs of like holes beside each other, and a large hole with a small one.
/// Outlines and holes vary within a family.
std::vector<Named> shapes() {
    std::vector<Named> result;
    for (int i = 0; i < 4; ++i) {
        const double s = i - 1.5;
        const auto outline = [s](double t) { return 1 + 0.04 * s * std::cos(2 * t) + 0.05 * std::sin(3 * t + s); };
        const auto round = [s](double radius, double phase) {
            return [=](double t) { return radius * (1 + 0.05 * s * std::cos(2 * t + phase)); };
        };
        const Complex turn = std::polar(1.0, 0.1 * s);
        result.push_back({"pair " + std::to_string(i + 1),
                          target_domain(polar_spline(0, outline),
                                        {polar_spline(turn * Complex(-0.45, 0.02 * s), round(0.2 + 0.01 * s, 0)),
                                         polar_spline(turn * Complex(0.45, 0.03), round(0.2, 1))})});
    }
    for (int i = 0; i < 4; ++i) {
        const double s = i - 1.5;
        const auto outline = [s](double t) { return 1.1 + 0.04 * s * std::cos(3 * t) + 0.05 * std::cos(2 * t - s); };
        const auto round = [s](double radius, double phase) {
            return [=](double t) { return radius * (1 + 0.06 * s * std::cos(3 * t + phase)); };
        };
        result.push_back(
            {"large and small " + std::to_string(i + 1),
             target_domain(polar_spline(0, outline), {polar_spline({-0.3, 0.03 * s}, round(0.45 + 0.01 * s, 0)),
                                                      polar_spline({0.6, 0.05}, round(0.09 - 0.004 * s, 1))})});
    }
    return result;
}

}  // namespace

Figure sliding_classes(Output& output) {
    Figure figure{"Classes, starts and symmetric domains",
                  "*The paper:* the extremal map is unique, whatever the start (it does not speak of homotopy classes: "
                  "with two or more holes there are many, and each has its own)."};
    changing_places(output, figure);
    rotated_starts(figure);
    symmetric_domains(output, figure);
    return figure;
}

Figure sliding_distance(Output& output) {
    Figure figure{"Distances of shapes",
                  "*The paper* names as future work the Teichmüller metric as a distance of multiply connected shapes. "
                  "Here: ½ log K* of the extremal map, `beltrami distance`."};
    const std::vector<Named> all = shapes();
    std::vector<Surface> surfaces;
    std::vector<std::string> names;
    for (const Named& shape : all) {
        surfaces.emplace_back(domain_mesh(shape.domain, 0.05, 0.02));
        names.push_back(shape.name);
    }
    Correspondence wanted;
    wanted.match_by = MatchBy::size;
    const DistanceMatrix matrix = distance_matrix(surfaces, wanted);
    const std::vector<Merge> merges = cluster_by_distance(matrix.distance);
    Table table{
        "Eight shapes of two families (two like holes; a large and a small one), meshes of edge length .05, holes "
        "matched by size; every distance from the maps both ways",
        {""},
        {}};
    double widest = 0, within = 0, between = 1e300;
    const int n = static_cast<int>(all.size());
    for (int i = 0; i < n; ++i) table.head.push_back(names[i]);
    for (int i = 0; i < n; ++i) {
        std::vector<std::string> row{names[i]};
        for (int j = 0; j < n; ++j) {
            row.push_back(number(matrix.distance(i, j)));
            if (i == j) continue;
            widest = std::max(widest, matrix.upper(i, j) - matrix.lower(i, j));
            if ((i < n / 2) == (j < n / 2))
                within = std::max(within, matrix.distance(i, j));
            else
                between = std::min(between, matrix.distance(i, j));
        }
        table.rows.push_back(std::move(row));
    }
    figure.tables.push_back(std::move(table));
    write_atomically(output.folder() / "sliding_distance.svg", render_dendrogram(names, matrix.distance, merges));
    figure.pictures.push_back({"sliding_distance",
                               "The matrix and the tree of its clusters, as `beltrami distance "
                               "--picture` draws them.",
                               {svg_panel("sliding_distance.svg")}});
    for (const int first : {0, n / 2}) {
        Picture shown{first == 0 ? "sliding_distance_pairs" : "sliding_distance_others",
                      first == 0 ? "The first family." : "The second family.",
                      {}};
        for (int i = first; i < first + n / 2; ++i) {
            const Mesh& mesh = surfaces[i].mesh;
            shown.panels.push_back(
                faces_panel(output.write("sliding_distance_" + std::to_string(i), mesh, planar_coordinates(mesh),
                                         Eigen::VectorXd::Zero(mesh.face_count())),
                            names[i]));
        }
        figure.pictures.push_back(std::move(shown));
    }
    figure.remarks.push_back("Largest distance within a family " + number(within) + ", least between them " +
                             number(between) + "; the widest bracket is " + number(widest) + ", and " +
                             std::to_string(matrix.unsettled.size()) + " pairs have not settled.");
    return figure;
}

}  // namespace beltrami::gallery
