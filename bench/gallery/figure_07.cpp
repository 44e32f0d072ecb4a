// Figures 7 and 8: known maps, prescribed boundary values, convergence.
#include <algorithm>
#include <cmath>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

namespace {

/// How far |μ| is from being the constant k: √ of the mean square over the source's area.
double deviation(const Distortion& d, double k) {
    return std::hypot(d.mean - k, d.standard_deviation);
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
                {"case", "triangles", "k", "exact k", "deviation of abs(μ)", "of the interpolated exact map",
                 "largest vertex error"},
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
            curve.x.push_back(problem.mesh.face_count());
            curve.y.push_back(deviation(solved.distortion, k));
            std::vector<std::string> row{name,
                                         std::to_string(problem.mesh.face_count()),
                                         number(*solved.k, 5),
                                         problem.exact_k ? number(k, 5) : "",
                                         number(curve.y.back(), 5),
                                         "",
                                         ""};
            if (problem.exact) {
                row[5] = number(deviation(distortion(surface.operators, *problem.exact), k), 5);
                row[6] = number((solved.map - *problem.exact).cwiseAbs().maxCoeff(), 6);
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
            figure.pictures.push_back(std::move(picture));
        }
        if (!curve.x.empty()) curves.push_back(std::move(curve));
    }
    figure.tables = {std::move(table), std::move(order)};
    figure.pictures.push_back({"figure_08",
                               "Deviation of |μ| from the exact k (from the computed k where none is known).",
                               {curves_panel(curves, "", "triangles", "deviation of |μ|")}});
    figure.remarks.push_back(
        "The map drawn with straight triangles has |μ| off by a first power of the mesh size even where it is exact; "
        "ours is as good, or better. k and K, which come from pairings with φ, converge faster. On the coarsest mesh "
        "of "
        "ring_to_lobes three lobes are too much for its few vertices, and k is far off.");
    return figure;
}

}  // namespace beltrami::gallery
