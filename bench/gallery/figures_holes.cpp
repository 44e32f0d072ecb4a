// Figures of multiply connected planar domains: 2, 14 and 27 holes.
#include <algorithm>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

Figure figure_02(Output& output) {
    Figure figure{
        "Figure 2: homotopy classes",
        "*The paper:* On a ring, maps with the same boundary values need not be homotopic; an extremal map is "
        "unique in each class only."};
    Table table{
        ".05 < |z| < 1 to .0112 < |w| < 1, r → r^1.5, the inner circle so many turns ahead of the outer one: the same "
        "boundary values every time, and `turns` chooses the class. In log z the extremal map is linear, which gives "
        "the exact K",
        {"turns", "exact k", "k", "exact K", "K_lower", "K", "mean abs(μ)", "std", "of the interpolated exact map",
         "largest vertex error", "flips", "iterations", "seconds"},
        {}};
    Picture picture{"figure_02", "The computed maps; the black line is the image of a radius (AB in the paper).", {}};
    for (const int turns : {0, 1, -1, 2}) {
        const Problem problem = annulus_turns(0.05, turns);
        const Surface surface(problem.mesh);
        Constraints constraints(problem.boundary);
        constraints.correspondence.turns = problem.turns;
        const Solved solved = solve(surface, constraints, "extremal");
        const std::string name = std::to_string(turns);
        const double k = *problem.exact_k;
        if (!solved) {
            table.rows.push_back({name, number(k, 5), "refused: " + solved.refusal});
            continue;
        }
        table.rows.push_back({name, number(k, 5), number(*solved.k, 5), number(dilatation(k), 4),
                              number(*solved.K_lower, 4), number(*solved.K, 4), number(solved.distortion.mean, 5),
                              number(solved.distortion.standard_deviation, 5),
                              number(distortion(surface.operators, *problem.exact).standard_deviation, 5),
                              number((solved.map - *problem.exact).cwiseAbs().maxCoeff(), 5),
                              std::to_string(solved.distortion.flipped.size()), std::to_string(solved.iterations),
                              number(solved.seconds, 2)});
        // The vertices on the positive real axis.
        std::vector<int> radius;
        for (int v = 0; v < problem.mesh.vertex_count(); ++v)
            if (problem.mesh.positions(v, 0) > 0 && std::abs(problem.mesh.positions(v, 1)) < 1e-9) radius.push_back(v);
        std::sort(radius.begin(), radius.end(),
                  [&](int a, int b) { return problem.mesh.positions(a, 0) < problem.mesh.positions(b, 0); });
        picture.panels.push_back(grid_panel(output.write("figure_02_" + std::to_string(turns + 1), surface, solved),
                                            name + (turns == 1 || turns == -1 ? " turn" : " turns"), "polar", 12,
                                            {radius}));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

Figure figure_14(Output& output) {
    Figure figure{"Figure 14: image deformation",
                  "*The paper:* A doughnut deformed to another thickness: ARAP develops folds, the extremal map has "
                  "none."};
    const Problem problem = named_problem("doughnut", 0.02);
    Comparison comparison{output, figure, "figure_14", problem, problem.boundary};
    comparison.pattern = "doughnut";
    comparison.run({"ARAP", "not evened", "extremal"});
    nlohmann::json picture = figure.pictures.back().panels.front();
    picture["domain"] = "source";
    picture["title"] = "the picture";
    figure.pictures.back().panels.insert(figure.pictures.back().panels.begin(), picture);
    figure.pictures.back().caption = "A picture on the annulus, deformed with it.";
    figure.remarks.push_back(
        "\"Not evened\" is the extremal map as the iteration leaves it, for pictures the one to take (`--evening "
        "never`): "
        "on the left |φ| is small, what the map does there hardly enters k and the bounds, φ is badly determined, and "
        "|μ| stays below "
        "k. Evening out raises it to k there by wrinkles of the size of a triangle, which the picture shows.");
    return figure;
}

Figure holes_27(Output& output) {
    Figure figure{"27 holes", "*Not in the paper.* The class is that of the harmonic map."};
    const Problem problem = named_problem("holes_27");
    Comparison comparison{output, figure, "holes_27", problem, problem.boundary};
    comparison.pattern = "square";
    comparison.squares = 24;
    comparison.run({"harmonic", "extremal"});
    return figure;
}

}  // namespace beltrami::gallery
