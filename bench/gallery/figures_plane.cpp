// Figures of simply connected planar problems: 3, 9, 11, 15, 16, 17.
#include <algorithm>
#include <cmath>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

Figure figure_03(Output& output) {
    Figure figure{"Figure 3: extremal, but not of Teichmüller type",
                  "|z|z on the upper half-plane, seen on the disk, is known to be extremal for its boundary values "
                  "and is not a Teichmüller map (K = 2, k = 1/3)."};
    Table table{"", usual_head("map"), {}};
    const Problem problem = half_plane_square(0.03);
    const Surface surface(problem.mesh);
    const Solved exact = solve_with(surface, "exact", [&] { return *problem.exact; });
    const Solved found = solve(surface, problem.boundary, "extremal");
    table.rows.push_back(usual_row("exact map, interpolated", exact));
    table.rows.push_back(usual_row("extremal", found));
    const std::string data = output.write("figure_03_exact", surface, exact);
    Picture picture{"figure_03", "The known extremal map, the map that beltrami finds, and |μ| of both.", {}, 3};
    picture.panels.push_back(map_panel(data, "known map", 0.6));
    std::vector<std::pair<std::string, std::string>> lines{{"known", data}};
    if (found) {
        lines.push_back({"beltrami", output.write("figure_03_extremal", surface, found)});
        picture.panels.push_back(map_panel(lines.back().second, "beltrami", 0.6));
    }
    picture.panels.push_back(histogram_panel(lines, "|μ|", problem.exact_k, 0.6));
    figure.pictures.push_back(std::move(picture));
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure figure_09(Output& output) {
    Figure figure{"Figure 9: zeros of the differential",
                  "After 3 iterations from the harmonic map the zeros of the quadratic differential become visible; in "
                  "the final map they are isolated spots of small |μ|."};
    const Problem problem = three_lobes(0.03);
    const Surface surface(problem.mesh);
    Table table{problem.statement, usual_head("map"), {}};
    Picture picture{"figure_09", "The harmonic map, after one and three iterations, and the final map.", {}, 4};
    for (const int iterations : {0, 1, 3, 60}) {
        const std::string name = iterations == 0    ? "harmonic"
                                 : iterations == 60 ? "final"
                                                    : std::to_string(iterations) + " iterations";
        const Solved solved = solve_with(surface, name, [&] {
            if (iterations == 0) return harmonic_map(surface, problem.boundary);
            ExtremalOptions options;
            options.max_iterations = iterations;
            return extremal_map(surface, problem.boundary, options).map;
        });
        table.rows.push_back(usual_row(name, solved));
        if (!solved) continue;
        picture.panels.push_back(
            map_panel(output.write("figure_09_" + std::to_string(iterations), surface, solved), name, 0.5, "source"));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

Figure figure_11(Output& output) {
    Figure figure{"Figure 11: minimising powers directly",
                  "Direct minimisation of max k makes little progress; of the powers ∫k^p, low and high p do not give "
                  "meaningful maps, p = 5 converges more than ten times slower and stays far from the extremal map."};
    const Problem problem = three_lobes(0.04);
    const Surface surface(problem.mesh);
    const Solved extremal = solve(surface, problem.boundary, "extremal");
    Table table{"", {"map", "mean abs(μ)", "std", "p99", "max", "flips", "Newton steps", "seconds"}, {}};
    const auto add = [&](const std::string& name, const Solved& solved, int steps) {
        const Distortion& d = solved.distortion;
        table.rows.push_back({name, number(d.mean), number(d.standard_deviation), number(d.p99), number(d.max),
                              std::to_string(d.flipped.size()), std::to_string(steps), number(solved.seconds, 2)});
    };
    Picture picture{"figure_11", "Three lobes: the extremal map and the fold-free maps that minimise Σ A q^p.", {}, 4};
    std::vector<std::pair<std::string, std::string>> lines;
    if (extremal) {
        add("extremal", extremal, extremal.iterations);
        lines.push_back({"extremal", output.write("figure_11_extremal", surface, extremal)});
        picture.panels.push_back(map_panel(lines.back().second, "extremal", 0.6));
    }
    const Eigen::VectorXcd start = harmonic_map(surface, problem.boundary);
    for (const int power : {1, 8, 64}) {
        int steps = 0;
        const std::string name = "p = " + std::to_string(power);
        const Solved solved = solve_with(surface, name, [&] {
            FoldFreeOptions options;
            options.power = power;
            FoldFreeMap map = fold_free_map(surface, freedoms(problem.boundary, surface),
                                            Eigen::VectorXcd::Zero(surface.mesh.face_count()), start, options);
            steps = map.iterations;
            return map.map;
        });
        add(name, solved, steps);
        lines.push_back({name, output.write("figure_11_p" + std::to_string(power), surface, solved)});
        picture.panels.push_back(map_panel(lines.back().second, name, 0.6));
    }
    figure.pictures.push_back(std::move(picture));
    figure.pictures.push_back({"figure_11_histogram",
                               "The larger p, the smaller the largest |μ|; the extremal map has the narrowest peak.",
                               {histogram_panel(lines, "|μ|", extremal.k, 0.6)},
                               1});
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "q = (1+|μ|²)/(1−|μ|²); p = 1 is MIPS. Powers are minimised by Newton's method on the fold-free energy, p "
        "doubled "
        "from 1, so all of them converge here.");
    return figure;
}

Figure figure_15(Output& output) {
    Figure figure{"Figure 15: other energies",
                  "Harmonic and ARAP maps with the same boundary are far from one-to-one; MIPS is, with uneven "
                  "dilatation; the extremal map is one-to-one with even dilatation."};
    for (const std::string name : {"three_lobes", "arrow_head_65"}) {
        const Problem problem = named_problem(name);
        const Surface surface(problem.mesh);
        Table table{problem.statement, usual_head("method"), {}};
        Picture picture{
            "figure_15_" + name, "Harmonic, ARAP, MIPS and extremal map: " + problem.statement + ".", {}, 4};
        std::vector<std::pair<std::string, std::string>> lines;
        for (const std::string method : {"harmonic", "ARAP", "MIPS", "extremal"}) {
            const Solved solved = solve(surface, problem.boundary, method);
            table.rows.push_back(usual_row(method, solved));
            if (!solved) continue;
            lines.push_back({method, output.write("figure_15_" + name + "_" + method, surface, solved)});
            picture.panels.push_back(map_panel(
                lines.back().second, method + ": " + std::to_string(solved.distortion.flipped.size()) + " flips", 0.9));
        }
        figure.pictures.push_back(std::move(picture));
        figure.pictures.push_back(
            {"figure_15_" + name + "_histogram", "|μ| of these maps.", {histogram_panel(lines, "|μ|")}, 1});
        figure.tables.push_back(std::move(table));
    }
    return figure;
}

Figure figure_16(Output& output) {
    Figure figure{"Figure 16: regular and irregular meshes",
                  "For meshes fine enough, the result is largely independent of the connectivity."};
    Table table{"", usual_head("mesh"), {}};
    Picture picture{"figure_16", "The three lobes on four meshes: regular, jittered, badly graded, stretched.", {}, 4};
    std::vector<std::pair<std::string, std::string>> lines;
    for (const std::string kind : {"", "_jittered", "_graded", "_anisotropic"}) {
        const Problem problem = named_problem("three_lobes" + kind);
        const Surface surface(problem.mesh);
        const Solved solved = solve(surface, problem.boundary, "extremal");
        const std::string label = kind.empty() ? "regular" : kind.substr(1);
        table.rows.push_back(
            usual_row(label + ", " + std::to_string(problem.mesh.face_count()) + " triangles", solved));
        if (!solved) continue;
        lines.push_back({label, output.write("figure_16_" + label, surface, solved)});
        picture.panels.push_back(map_panel(lines.back().second, label, 0.6));
    }
    figure.pictures.push_back(std::move(picture));
    figure.pictures.push_back(
        {"figure_16_histogram", "|μ| on the four meshes.", {histogram_panel(lines, "|μ|", {}, 0.6)}, 1});
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure figure_17(Output& output) {
    Figure figure{"Figure 17: few triangles",
                  "A square to a wedge: for simple boundaries few triangles already "
                  "approximate the map well; an irregular mesh at each resolution."};
    Table table{"", usual_head("triangles"), {}};
    Picture picture{"figure_17", "The square to a wedge at growing resolution.", {}, 4};
    for (const double edge_length : {0.2, 0.1, 0.05, 0.025}) {
        Problem problem = wedge(edge_length);
        JitterOptions jitter;
        jitter.amplitude = 0.4;
        jitter.seed = 17;
        problem.mesh = jittered(problem.mesh, jitter);
        const Surface surface(problem.mesh);
        const Solved solved = solve(surface, problem.boundary, "extremal");
        const std::string triangles = std::to_string(problem.mesh.face_count());
        table.rows.push_back(usual_row(triangles, solved));
        if (!solved) continue;
        picture.panels.push_back(
            map_panel(output.write("figure_17_" + triangles, surface, solved), triangles + " triangles"));
    }
    figure.pictures.push_back(std::move(picture));
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
