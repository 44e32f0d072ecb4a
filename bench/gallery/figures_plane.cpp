// Figures of simply connected planar problems: 3, 9, 11, 15, 16, 17.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/generate/round_domains.h>

#include "gallery/gallery.h"
#include "gallery/power_descent.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

Figure figure_03(Output& output) {
    Figure figure{
        "Figure 3: extremal, but not of Teichmüller type",
        "*The paper:* |z|z on the upper half-plane, seen on the disk, is known to be extremal for its boundary "
        "values and is not a Teichmüller map (K = 2, k = 1/3)."};
    Table table{"", usual_head("map"), {}};
    Table detected{"What beltrami says", {"triangles", "end", "vertex", "at", "corner bound", "K_lower", "K"}, {}};
    Picture picture{"figure_03", "The known extremal map, the map that beltrami finds, and the boundary values.", {}};
    for (const double edge_length : {0.06, 0.03, 0.015}) {
        const Problem problem = half_plane_square(edge_length);
        const Surface surface(problem.mesh);
        const Solved found = solve(surface, problem.boundary, "extremal");
        if (!found) {
            table.rows.push_back(usual_row("extremal", found));
            continue;
        }
        const std::string triangles = std::to_string(problem.mesh.face_count());
        const auto& corner = found.all->sharpest;
        const int v = corner ? corner->vertex : -1;
        detected.rows.push_back(
            {triangles, found.end, corner ? std::to_string(v) : "",
             corner ? number(problem.mesh.positions(v, 0), 2) + ", " + number(problem.mesh.positions(v, 1), 2) : "",
             corner ? number(corner->safe_bound) : "", number(*found.K_lower), number(*found.K)});
        if (edge_length != 0.03) continue;
        const Solved exact = solve_with(surface, "exact", [&] { return *problem.exact; });
        table.rows.push_back(usual_row("exact map, interpolated", exact));
        table.rows.push_back(usual_row("extremal", found));
        const std::string known = output.write("figure_03_exact", surface, exact),
                          ours = output.write("figure_03_extremal", surface, found);
        picture.panels.push_back(grid_panel(known, "known map", "disk", 24));
        picture.panels.push_back(grid_panel(ours, "beltrami", "disk", 24));
        Curve values{"", {}, {}};
        const auto& loop = surface.topology.boundary_loops[0];
        double last = 0;
        std::vector<std::pair<double, Complex>> sorted;
        for (const int at : loop)
            sorted.push_back({std::arg(Complex(problem.mesh.positions(at, 0), problem.mesh.positions(at, 1))),
                              (*problem.exact)[at]});
        std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [angle, image] : sorted) {
            double value = std::arg(image);
            if (!values.y.empty()) value = last + std::remainder(value - last, 2 * std::numbers::pi);
            values.x.push_back(angle);
            values.y.push_back(last = value);
        }
        picture.panels.push_back(curves_panel({values}, "boundary values", "angle", "angle of the image", false));
        picture.panels.push_back(histogram_panel({{"known", known}, {"beltrami", ours}}, "|μ|", problem.exact_k, 0.6));
    }
    figure.tables = {std::move(table), std::move(detected)};
    figure.pictures.push_back(std::move(picture));
    figure.remarks.push_back(
        "At ±1 the boundary values run like s² instead of s. Near such a point alone no map has K below 2 (the corner "
        "bound, which is measured on the mesh and tends to 2), while the Teichmüller maps of ever finer meshes have "
        "smaller K: their φ lose their mass into the two points. The difference is what is detected.");
    return figure;
}

Figure figure_09(Output& output) {
    Figure figure{
        "Figure 9: zeros of the differential",
        "*The paper:* After 3 iterations from the harmonic map the zeros of the quadratic differential become "
        "visible; in the final map they are isolated spots of small |μ|."};
    // An irregular mesh, on which no zero meets a special vertex.
    DomainOptions domain;
    domain.edge_length = 0.045;
    Problem problem;
    problem.statement = "The disk to itself, e^{i(t + .16 sin 3t + .07 cos 5t)}";
    problem.mesh = circle_domain({}, {}, domain);
    const Surface surface(problem.mesh);
    for (const int v : surface.topology.boundary_loops[0]) {
        const double t = std::arg(Complex(problem.mesh.positions(v, 0), problem.mesh.positions(v, 1)));
        problem.boundary.pin(v, std::polar(1.0, t + 0.16 * std::sin(3 * t) + 0.07 * std::cos(5 * t)));
    }
    Table table{problem.statement, usual_head("map"), {}};
    Picture picture{
        "figure_09", "|μ| on the source: harmonic, after one, three and all iterations; |φ|^½ of the last.", {}};
    for (const int iterations : {0, 1, 3, 60}) {
        const std::string name = iterations == 0    ? "harmonic"
                                 : iterations == 1  ? "1 iteration"
                                 : iterations == 60 ? "final"
                                                    : std::to_string(iterations) + " iterations";
        ExtremalOptions options;
        options.max_iterations = std::max(1, iterations);
        options.evening = ExtremalOptions::Evening::never;
        options.sharpen = -1;
        const Solved solved = solve(surface, problem.boundary, iterations == 0 ? "harmonic" : "extremal", options);
        table.rows.push_back(usual_row(name, solved));
        if (!solved) continue;
        const double top = 0.5;
        picture.panels.push_back(
            map_panel(output.write("figure_09_" + std::to_string(iterations), surface, solved), name, top, "source"));
        if (iterations != 60) continue;
        Eigen::VectorXd size = solved.all->phi.cwiseAbs().cwiseSqrt();
        size *= 0.99 * top / size.maxCoeff();
        picture.panels.push_back(map_panel(output.write("figure_09_phi", problem.mesh, solved.map, size),
                                           "|φ|^½ (own scale)", top, "source"));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

Figure figure_11(Output& output) {
    Figure figure{"Figure 11: minimising powers directly",
                  "*The paper:* Direct minimisation of max k makes little progress; of the powers ∫k^p, low and high p "
                  "do not give "
                  "meaningful maps, p = 5 converges more than ten times slower and stays far from the extremal map."};
    const Problem problem = three_lobes(0.04);
    const Surface surface(problem.mesh);
    const Solved extremal = solve(surface, problem.boundary, "extremal");
    Table table{"", {"map", "mean abs(μ)", "std", "p99", "max", "K_max", "flips", "steps", "seconds"}, {}};
    const auto add = [&](const std::string& name, const Solved& solved, int steps) {
        const Distortion& d = solved.distortion;
        table.rows.push_back({name, number(d.mean), number(d.standard_deviation), number(d.p99), number(d.max),
                              number(d.max_dilatation()), std::to_string(d.flipped.size()), std::to_string(steps),
                              number(solved.seconds, 2)});
    };
    Picture picture{
        "figure_11", "The extremal map, the map of least max |μ|, and the fold-free maps that minimise Σ A q^p.", {}};
    std::vector<std::pair<std::string, std::string>> lines;
    if (extremal) {
        add("extremal", extremal, extremal.iterations);
        lines.push_back({"extremal", output.write("figure_11_extremal", surface, extremal)});
        picture.panels.push_back(map_panel(lines.back().second, "extremal", 0.6));
    }
    const Solved least = solve(surface, problem.boundary, "least maximum");
    if (least) {
        add("least maximum", least, least.iterations);
        lines.push_back({"least maximum", output.write("figure_11_least", surface, least)});
        picture.panels.push_back(map_panel(lines.back().second, "least maximum", 0.6));
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
    figure.tables.push_back(std::move(table));
    table = {
        "As the paper prints it, abs(μ)^p itself from the harmonic start with its flips, by a quasi-Newton method "
        "(L-BFGS) with exact gradients, at most 3 000 steps; the largest abs(μ) by a logarithmic barrier",
        {"energy", "mean abs(μ)", "std", "p99", "max", "K_max", "flips", "steps", "seconds"},
        {}};
    Picture printed{"figure_11_powers", "The maps that the direct descent reaches.", {}};
    for (const double p : {2.0, 5.0, 0.0}) {
        int steps = 0;
        const std::string name = p > 0 ? "∫abs(μ)^" + number(p, 0) : "largest abs(μ)";
        const Solved solved = solve_with(surface, name, [&] {
            Descent found = p > 0 ? least_power(surface, problem.boundary, start, p, 3000)
                                  : least_largest(surface, problem.boundary, start, 3000);
            steps = found.iterations;
            return std::move(found.map);
        });
        add(name, solved, steps);
        printed.panels.push_back(map_panel(output.write("figure_11_k" + number(p, 0), surface, solved),
                                           (p > 0 ? "p = " + number(p, 0) : "largest") + ": " +
                                               std::to_string(solved.distortion.flipped.size()) + " flips",
                                           0.6));
    }
    figure.pictures.push_back(std::move(picture));
    figure.pictures.push_back(std::move(printed));
    figure.pictures.push_back(
        {"figure_11_histogram", "|μ| of these maps.", {histogram_panel(lines, "|μ|", extremal.k, 0.6)}});
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "q = (1+|μ|²)/(1−|μ|²); p = 1 is MIPS. Powers are minimised by Newton's method on the fold-free energy, p "
        "doubled "
        "from 1, so all of them converge here, unlike the paper's. \"Least maximum\" (`--minimize max`) starts from "
        "the "
        "extremal map and goes to p = 128: on this mesh the largest |μ| can be smaller than that of the extremal map, "
        "which is the minimum of the continuous problem only.");
    figure.remarks.push_back(
        "Powers of |μ| itself behave as the paper says: finite on folds, they let vertices run far out of the image at "
        "the cost of a few flipped "
        "faces, whatever p, and so does the largest |μ|, whose barrier lets nothing through that is above it.");
    return figure;
}

Figure figure_15(Output& output) {
    Figure figure{
        "Figure 15: other energies",
        "*The paper:* Harmonic and ARAP maps with the same boundary are far from one-to-one; MIPS is, with uneven "
        "dilatation; the extremal map is one-to-one with even dilatation."};
    for (const std::string name : {"three_lobes", "arrow_head_65"}) {
        const Problem problem = named_problem(name);
        const Surface surface(problem.mesh);
        Table table{problem.statement, usual_head("method"), {}};
        Picture picture{"figure_15_" + name, "Harmonic, ARAP, MIPS and extremal map: " + problem.statement + ".", {}};
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
            {"figure_15_" + name + "_histogram", "|μ| of these maps.", {histogram_panel(lines, "|μ|")}});
        figure.tables.push_back(std::move(table));
    }
    return figure;
}

Figure figure_16(Output& output) {
    Figure figure{"Figure 16: regular and irregular meshes",
                  "*The paper:* For meshes fine enough, the result is largely independent of the connectivity."};
    Table table{"", usual_head("mesh"), {}};
    Picture picture{"figure_16", "The three lobes on four meshes: regular, jittered, badly graded, stretched.", {}};
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
    figure.remarks.push_back(
        "k and K agree on all meshes; the statistics of |μ| show the triangles' shapes, most where they are "
        "stretched.");
    figure.pictures.push_back(std::move(picture));
    figure.pictures.push_back(
        {"figure_16_histogram", "|μ| on the four meshes.", {histogram_panel(lines, "|μ|", {}, 0.6)}});
    figure.tables.push_back(std::move(table));
    return figure;
}

Figure figure_17(Output& output) {
    Figure figure{"Figure 17: few triangles",
                  "*The paper:* A square to a wedge: for simple boundaries few triangles already "
                  "approximate the map well; an irregular mesh at each resolution."};
    Table table{"", usual_head("triangles"), {}};
    Picture picture{"figure_17", "The square to a wedge at growing resolution.", {}};
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
            map_panel(output.write("figure_17_" + triangles, surface, solved), triangles + " triangles", 0.5));
    }
    figure.pictures.push_back(std::move(picture));
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
