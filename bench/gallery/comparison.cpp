#include "gallery/gallery.h"

namespace beltrami::gallery {

std::vector<Solved> Comparison::run(const std::vector<std::string>& methods) {
    const Surface surface(problem.mesh);
    Table table{problem.statement, usual_head("method"), {}};
    Picture flat{name, problem.statement + ".", {}}, views{name + "_texture", "", {}};
    views.caption = surface.in_plane() ? "The image of a checkerboard of the source." : "A checkerboard of the plane.";
    std::vector<std::pair<std::string, std::string>> lines;
    auto edges = problem.highlights;
    for (const bench::FeatureCurve& curve : problem.features) edges.push_back(curve.vertices);
    std::vector<Solved> result;
    for (const std::string& method : methods) {
        Constraints constraints(boundary);
        constraints.correspondence.turns = problem.turns;
        result.push_back(solve(surface, constraints, method));
        const Solved& solved = result.back();
        table.rows.push_back(usual_row(method, solved));
        if (!solved) continue;
        const std::string label = method + ": " + std::to_string(solved.distortion.flipped.size()) + " flips";
        lines.push_back({method, output.write(name + "_" + method, surface, solved)});
        flat.panels.push_back(map_panel(lines.back().second, label, max_mu));
        views.panels.push_back(surface.in_plane() ? grid_panel(lines.back().second, method, pattern, squares)
                                                  : surface_panel(lines.back().second, method, "checker", azimuth,
                                                                  elevation, squares, max_mu, edges));
    }
    flat.panels.push_back(histogram_panel(lines, "|μ|", {}, max_mu));
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(flat));
    figure.pictures.push_back(std::move(views));
    return result;
}

}  // namespace beltrami::gallery
