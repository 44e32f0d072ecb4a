// Figures of surfaces and of multiply connected domains: 2, 10, 12, 13, 14, 19.
#include <set>

#include <beltrami/generate/random.h>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

namespace {

/// Solves one problem with several methods; rows to the table, flat pictures and views of the surface to the figure.
struct Comparison {
    Output& output;
    Figure& figure;
    std::string name;
    const Problem& problem;
    BoundaryCondition boundary;
    double azimuth = 30, elevation = 30;
    int squares = 20;
    double max_mu = 1;

    void run(const std::vector<std::string>& methods) {
        const Surface surface(problem.mesh);
        Table table{problem.statement, usual_head("method"), {}};
        Picture flat{name, problem.statement + ".", {}, 4}, views{name + "_texture", "", {}, 4};
        views.caption =
            surface.in_plane() ? "The image of a polar chessboard." : "A chessboard of the plane on the surface.";
        std::vector<std::pair<std::string, std::string>> lines;
        auto edges = problem.highlights;
        for (const FeatureCurve& curve : problem.features) edges.push_back(curve.vertices);
        for (const std::string& method : methods) {
            const Solved solved = solve(surface, boundary, method);
            table.rows.push_back(usual_row(method, solved));
            if (!solved) continue;
            const std::string label = method + ": " + std::to_string(solved.distortion.flipped.size()) + " flips";
            lines.push_back({method, output.write(name + "_" + method, surface, solved)});
            flat.panels.push_back(map_panel(lines.back().second, label, max_mu));
            if (surface.in_plane()) {
                views.panels.push_back(grid_panel(lines.back().second, method));
                continue;
            }
            views.panels.push_back(
                surface_panel(lines.back().second, method, "checker", azimuth, elevation, squares, max_mu, edges));
        }
        flat.panels.push_back(histogram_panel(lines, "|μ|", {}, max_mu));
        figure.tables.push_back(std::move(table));
        figure.pictures.push_back(std::move(flat));
        if (!views.panels.empty()) figure.pictures.push_back(std::move(views));
    }
};

}  // namespace

Figure figure_02(Output& output) {
    Figure figure{"Figure 2: homotopy classes",
                  "On a ring, maps with the same boundary values need not be homotopic; an extremal map is unique in "
                  "each class only."};
    Table table{
        "Exact maps of .05 < |z| < 1 to .0112 < |w| < 1 with the same boundary values: r → r^1.5 and so many turns",
        {"turns", "exact k", "exact K", "mean abs(μ)", "std", "flips"},
        {}};
    Picture picture{"figure_02", "The same boundary values, different turns: the exact extremal maps.", {}, 4};
    for (const int turns : {-1, 0, 1, 2}) {
        const Problem problem = annulus_turns(0.06, turns);
        const Surface surface(problem.mesh);
        const Solved exact = solve_with(surface, "exact", [&] { return *problem.exact; });
        const std::string name = std::to_string(turns);
        const double k = *problem.exact_k;
        table.rows.push_back({name, number(k, 5), number((1 + k) / (1 - k), 4), number(exact.distortion.mean, 5),
                              number(exact.distortion.standard_deviation, 5),
                              std::to_string(exact.distortion.flipped.size())});
        // Lines of the source: |μ| alone would be one colour.
        picture.panels.push_back(grid_panel(output.write("figure_02_" + std::to_string(turns + 1), surface, exact),
                                            name + (turns == 1 || turns == -1 ? " turn" : " turns")));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

Figure figure_10(Output& output) {
    Figure figure{"Figure 10: dependence on the start",
                  "A screw to an annulus from a harmonic, an ARAP and a noisy start with 924, 268 and 831 folds: the "
                  "same map every time, without folds."};
    const Problem problem = named_problem("screw");
    Comparison{output, figure, "figure_10", problem, problem.boundary, 20, 25, 30}.run(
        {"harmonic", "ARAP", "extremal"});
    // The noisy start: the harmonic map with inner vertices displaced.
    const Surface surface(problem.mesh);
    const Solved noisy = solve_with(surface, "noisy", [&] {
        Eigen::VectorXcd map = harmonic_map(surface, problem.boundary);
        Random random(10);
        for (int v = 0; v < map.size(); ++v) {
            const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
            if (!surface.topology.on_boundary[v]) map[v] += Complex(x, y);
        }
        return map;
    });
    figure.tables[0].rows.push_back(usual_row("noisy start", noisy));
    return figure;
}

Figure figure_12(Output& output) {
    Figure figure{"Figure 12: aligned sharp features",
                  "The front of the fandisk, its features and boundary on parametric lines: harmonic and ARAP maps "
                  "fold or distort strongly, the extremal map does not."};
    const Problem problem = named_problem("cad_part");
    // Features pinned by arc length along their lines.
    BoundaryCondition boundary = problem.boundary;
    std::set<int> pinned(boundary.vertices.begin(), boundary.vertices.end());
    for (const FeatureCurve& curve : problem.features)
        for (std::size_t i = 0; i < curve.vertices.size(); ++i)
            if (pinned.insert(curve.vertices[i]).second) boundary.pin(curve.vertices[i], curve.images[i]);
    Comparison{output, figure, "figure_12", problem, boundary, -40, 50, 24, 0.7}.run({"harmonic", "ARAP", "extremal"});
    return figure;
}

Figure figure_13(Output& output) {
    Figure figure{"Figure 13: a multiply connected curved surface",
                  "A large curved model with holes, aligned to all its boundaries, without cones or cuts."};
    const Problem problem = named_problem("curved_plate");
    Comparison{output, figure, "figure_13", problem, problem.boundary, -60, 45, 30}.run({"harmonic", "extremal"});
    return figure;
}

Figure figure_14(Output& output) {
    Figure figure{"Figure 14: image deformation",
                  "A doughnut deformed to another thickness: ARAP develops folds, the extremal map has none."};
    const Problem problem = named_problem("doughnut");
    Comparison{output, figure, "figure_14", problem, problem.boundary}.run({"ARAP", "extremal"});
    return figure;
}

Figure figure_19(Output& output) {
    Figure figure{"Figure 19: a ball with twelve holes",
                  "A ball with twelve pentagonal holes to a disk with round holes: the harmonic map has more than 800 "
                  "flipped triangles, ARAP more than 600, the extremal map none."};
    const Problem problem = named_problem("pierced_ball", 0.035);
    Comparison{output, figure, "figure_19", problem, problem.boundary, 30, 20, 24}.run(
        {"harmonic", "ARAP", "extremal"});
    return figure;
}

}  // namespace beltrami::gallery
