// Figures 7 and 8: known maps, prescribed boundary values, convergence.
#include <algorithm>
#include <array>
#include <cmath>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

namespace {

/// How far |μ| is from being the constant k: √ of the mean square over the source's area.
double deviation(const Distortion& d, double k) {
    return std::hypot(d.mean - k, d.standard_deviation);
}

/// Iterations until the energy Σ A |∂̄f − k conj(φ)/|φ| ∂f|² changes by less than 1 %, the paper's measure of speed: of
/// the extremal map by the energies after 1, 2, … iterations, of the alternation by its own.
std::array<int, 2> iterations_to_a_percent(const Problem& problem) {
    constexpr int most = 40;
    const Surface surface(problem.mesh);
    std::array<int, 2> counts{0, 0};
    double last = 0;
    for (int n = 1; n <= most && counts[0] == 0; ++n) {
        ExtremalOptions options;
        options.max_iterations = n;
        options.evening = ExtremalOptions::Evening::never;
        options.sharpen = -1;
        options.remove_folds = false;
        const Solved solved = solve(surface, problem.boundary, "extremal", options);
        if (!solved || (solved.all->split && solved.all->split->split_edges > 0)) break;
        double energy = 0;
        for (int s = 0; s < surface.operators.sample_count(); ++s) {
            const auto [a, b] = surface.operators.derivatives(s, solved.map);
            const Complex phi = solved.all->phi[s];
            const Complex nu = phi == 0.0 ? Complex(0) : *solved.k * std::conj(phi) / std::abs(phi);
            energy += surface.operators.weights[s] * std::norm(b - nu * a);
        }
        if (last > 0 && std::abs(last - energy) < 0.01 * last) counts[0] = n;
        last = energy;
        if (solved.iterations < n && counts[0] == 0) counts[0] = solved.iterations;  // settled before
    }
    last = 0;
    BaselineOptions options;
    options.max_iterations = 200;
    options.progress = [&](int iteration, double energy) {
        if (counts[1] == 0 && last > 0 && std::abs(last - energy) < 0.01 * last) counts[1] = iteration;
        last = energy;
        return counts[1] == 0;
    };
    try {
        alternation_baseline(surface, problem.boundary, options);
    } catch (const Error& error) {
        if (error.cause() != Cause::cancelled) throw;
    }
    return counts;
}

}  // namespace

Figure figure_07(Output& output) {
    Figure figure{
        "Figures 7 and 8: known maps, prescribed boundary values, convergence",
        "*The paper:* Where the extremal map is known (four points of the disk, rings, compositions) the computed maps "
        "match it; the deviation of |μ| from its constant falls as the mesh is refined, for boundary values "
        "of no known map likewise."};
    Table table{"", usual_head("case"), {}};
    Table order{"",
                {"case", "triangles", "k", "exact k", "deviation of abs(μ)", "not evened",
                 "of the interpolated exact map", "largest vertex error"},
                {}};
    Table speed{"Iterations until the least-squares energy changes by less than 1 %",
                {"case", "extremal map", "alternation"},
                {}};
    std::vector<Curve> curves;
    for (const std::string name :
         {"four_points", "ring", "exact_composition", "sector", "three_lobes", "bean", "ring_to_lobes"}) {
        const auto& all = named_problems();
        const auto entry = std::find_if(all.begin(), all.end(), [&](const NamedProblem& p) { return p.name == name; });
        Curve curve{name, {}, {}};
        for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
            const Problem problem = entry->make(factor * entry->edge_length);
            const Surface surface(problem.mesh);
            const Solved solved = solve(surface, problem.boundary, "extremal");
            if (!solved) {
                if (factor == 1.0) table.rows.push_back(usual_row(name, solved));
                continue;
            }
            const double k = problem.exact_k ? *problem.exact_k : *solved.k;
            ExtremalOptions as_iterated;
            as_iterated.evening = ExtremalOptions::Evening::never;
            as_iterated.sharpen = -1;
            const Solved uneven = solve(surface, problem.boundary, "extremal", as_iterated);
            curve.x.push_back(problem.mesh.face_count());
            curve.y.push_back(uneven ? deviation(uneven.distortion, k) : 0);
            std::vector<std::string> row{name,
                                         std::to_string(problem.mesh.face_count()),
                                         number(*solved.k, 5),
                                         problem.exact_k ? number(k, 5) : "",
                                         number(deviation(solved.distortion, k), 5),
                                         number(curve.y.back(), 5),
                                         "",
                                         ""};
            if (problem.exact) {
                row[6] = number(deviation(distortion(surface.operators, *problem.exact), k), 5);
                row[7] = number((solved.map - *problem.exact).cwiseAbs().maxCoeff(), 6);
            }
            order.rows.push_back(std::move(row));
            if (factor != 1.0) continue;
            table.rows.push_back(usual_row(name, solved));
            const double shown = std::min(1.0, 1.6 * k);
            Picture picture{"figure_07_" + name, problem.statement + ".", {}};
            const std::string data = output.write("figure_07_" + name, surface, solved);
            std::vector<std::pair<std::string, std::string>> lines{{"beltrami", data}};
            picture.panels.push_back(grid_panel(data, "checkerboard of the source", "square", 16));
            picture.panels.push_back(map_panel(data, "extremal map", shown));
            if (problem.exact) {
                const Solved exact = solve_with(surface, "exact", [&] { return *problem.exact; });
                lines.push_back({"exact", output.write("figure_07_" + name + "_exact", surface, exact)});
                picture.panels.push_back(map_panel(lines.back().second, "exact map", shown));
            }
            picture.panels.push_back(histogram_panel(lines, "|μ|", k, shown));
            picture.panels.push_back(histogram_panel(lines, "|μ|", k, shown, "triangles"));
            const auto [ours, alternation] = iterations_to_a_percent(problem);
            const auto count = [](int n) { return n > 0 ? std::to_string(n) : std::string("–"); };
            speed.rows.push_back({name, count(ours), count(alternation)});
            figure.pictures.push_back(std::move(picture));
        }
        if (!curve.x.empty()) curves.push_back(std::move(curve));
    }
    figure.tables = {std::move(table), std::move(order), std::move(speed)};
    figure.pictures.push_back(
        {"figure_08",
         "Deviation of |μ| from the exact k (from the computed k where none is known), of the maps as the iteration "
         "leaves them.",
         {curves_panel(curves, "", "triangles", "deviation of |μ|")}});
    figure.remarks.push_back(
        "The map drawn with straight triangles has |μ| off by a first power of the mesh size even where it is exact; "
        "ours is as good, or better. By default |μ| is evened out only where the map is far from "
        "even, so a coarse mesh can end with less deviation than a fine one (the sector); the curves are those of maps "
        "that are not "
        "evened. k and K, which come from pairings with φ, converge faster. On the coarsest mesh "
        "of "
        "ring_to_lobes three lobes are too much for its few vertices, and k is far off.");
    return figure;
}

}  // namespace beltrami::gallery
