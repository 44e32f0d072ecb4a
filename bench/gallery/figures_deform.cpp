// Maps into space with prescribed boundaries: beside Gruber and Aulisa's Figs 2, 6, 8, 9, 12 and 14 to 16.
#include <cmath>
#include <numbers>

#include <beltrami/applications/handled_surface.h>
#include <beltrami/space/uniform_map.h>
#include <beltrami/space/unrolled_map.h>

#include "gallery/space.h"
#include "space_cases.h"

namespace beltrami::gallery {

namespace {

using bench::Handles;
using std::numbers::pi;

/// A surface, its handles and the maps of both.
struct Problem {
    Surface surface;
    Handles handles;
    CornerElements elements;
    const Target* target;  ///< null: into space

    Problem(const Mesh& mesh, Handles h, const Target* onto)
        : surface(mesh), handles(std::move(h)), elements(corner_elements(surface.mesh)), target(onto) {}

    Positions normals(const Positions& positions) const {
        if (target) return normals_of(nearest_points(*target, positions));
        Mesh image = surface.mesh;
        image.positions = positions;
        return vertex_normals(image);
    }

    std::vector<char> fixed() const {
        std::vector<char> result(static_cast<std::size_t>(surface.mesh.vertex_count()), 0);
        for (const int v : handles.vertices) result[v] = 1;
        return result;
    }

    Positions places() const {
        Positions result(surface.mesh.vertex_count(), 3);
        for (int v = 0; v < surface.mesh.vertex_count(); ++v) result.row(v) = surface.mesh.point(v);
        for (std::size_t i = 0; i < handles.vertices.size(); ++i)
            result.row(handles.vertices[i]) = handles.places.row(static_cast<Eigen::Index>(i));
        return result;
    }

    /// The least-squares map, the map of the QC iteration.
    std::pair<Positions, Positions> uniform(const UniformOptions& options) const {
        if (const auto* const rolled = dynamic_cast<const ParametricTarget*>(target)) {
            const UnrolledPlaces start =
                unrolled_places(*rolled, surface.mesh.faces, nearest_points(*target, places())).value();
            const UnrolledMap map = uniform_unrolled_map(surface.mesh, elements, start, fixed(), options);
            return {positions_of(rolled_up(*rolled, map.first)), positions_of(rolled_up(*rolled, map.vertices))};
        }
        LeastSquaresMap problem(surface.mesh, elements, places(), fixed(), Preserve::nothing);
        UniformMap map = uniform_map(problem, surface.mesh, options);
        return {std::move(map.first), std::move(map.map)};
    }

    Deformation deformed(DeformGoal goal, DeformedSurface kind = DeformedSurface::automatic) const {
        DeformOptions options;
        options.goal = goal;
        options.surface = kind;
        DeformSolver solver(surface, handles.vertices, options);
        return target ? solver.solve_onto(*target, handles.places) : solver.solve(handles.places);
    }
};

UniformOptions steps(int count) {
    UniformOptions options;
    options.max_iterations = count;
    options.tolerance = 1e-4;
    return options;
}

/// Zeros and poles of φ inside.
std::string counted(const Surface& surface, const ExtremalMap& extremal) {
    int poles = 0, zeros = 0, orders = 0;
    for (const CriticalPoint& point : zeros_and_poles(surface, extremal.differential)) {
        if (point.on_boundary) continue;
        (point.order < 0 ? poles : zeros) += 1;
        orders += point.order;
    }
    return "zeros inside: " + std::to_string(zeros) + ", poles: " + std::to_string(poles) + ", of orders " +
           std::to_string(orders) + " in all";
}

/// Least squares, the QC iteration and what is done here with a known target.
void add_known(SpaceFigure& shown, const Problem& problem, int count, Figure& figure) {
    const auto [first, even] = problem.uniform(steps(count));
    shown.add("least squares", first, problem.normals(first));
    shown.add("QC iteration", even, problem.normals(even));
    const Deformation extremal = problem.deformed(DeformGoal::dilatation);
    if (extremal.goal == DeformGoal::dilatation)
        shown.add("smallest K", extremal.positions, problem.normals(extremal.positions));
    else
        shown.refuse("smallest K", "flips faces on the surface");
    if (extremal.extremal)
        figure.remarks.push_back("Smallest K: k " + number(extremal.extremal->k) + ", " +
                                 number(extremal.extremal->K_lower, 3) + " ≤ K* ≈ " + number(extremal.extremal->K, 3) +
                                 " (an estimate on surfaces); of its differential " +
                                 counted(problem.surface, *extremal.extremal) + ".");
    const Deformation largest = problem.deformed(DeformGoal::largest);
    shown.add("smallest max", largest.positions, problem.normals(largest.positions), false);
}

/// The same into space.
void add_free(SpaceFigure& shown, const Problem& problem) {
    const auto [first, even] = problem.uniform(steps(60));
    shown.add("least squares", first, problem.normals(first));
    shown.add("QC iteration", even, problem.normals(even));
    for (const DeformedSurface kind : {DeformedSurface::thin_plate, DeformedSurface::rigid}) {
        const std::string name = std::string("on the ") + to_string(kind) + " surface";
        try {
            const Deformation map = problem.deformed(DeformGoal::largest, kind);
            shown.add(name, map.positions, problem.normals(map.positions), kind == DeformedSurface::thin_plate);
        } catch (const Error& error) {
            shown.refuse(name, error.what());
        }
    }
}

Handles lowered(const Mesh& mesh, double part) {
    return bench::rims(mesh, [part](double t) { return part * (1 - std::cos(t)); });
}

}  // namespace

Figure space_02(Output& output) {
    Figure figure{"Figures 2 and 16: a corner of the square pushed in",
                  "The least-squares map leaves the image; the maps of equal abs(μ) do not. 784 quads, whose reference "
                  "is the square; then 1 568 triangles."};
    for (const Cells cells : {Cells::quads, Cells::triangles}) {
        Mesh mesh = rectangle(1, 1, 28, 28, cells);
        mesh.positions.conservativeResize(Eigen::NoChange, 3);
        mesh.positions.col(2).setZero();
        const PlaneTarget plane;
        const Problem problem(mesh, bench::arrow_head(mesh, 0.65), &plane);
        const bool quads = cells == Cells::quads;
        SpaceFigure shown(output, figure, quads ? "space_02_quads" : "space_02", problem.surface.mesh, problem.elements,
                          {-90, 90, 1});
        shown.add("source", mesh.positions, problem.normals(mesh.positions), false);
        add_known(shown, problem, 99, figure);
        shown.end_table(quads ? "Quads" : "Triangles");
        shown.end_picture(std::string("The corner pushed in by .65, ") + (quads ? "quads" : "triangles") +
                          ": abs(μ), flipped faces red.");
        shown.end_components("The same: μ₁ in the frame of the plane.", false);
    }
    return figure;
}

Figure space_06(Output& output) {
    Figure figure{
        "Figures 6 and 8: a cylinder, its rim lowered by 80 and 95 % of its height at one side",
        "Radius 1, height 2, 1 536 triangles; the image is on the cylinder. The paper's map has a simple pole "
        "in front and a simple zero at the back, which add up to the index 0 of the cylinder."};
    const ParametricTarget target = cylinder_target(1, 2);
    for (const double part : {0.8, 0.95}) {
        const Mesh mesh = bench::cylinder_to_lower(1, Cells::triangles);
        const Problem problem(mesh, lowered(mesh, part), &target);
        const std::string percent = part == 0.8 ? "80 %" : "95 %";
        SpaceFigure shown(output, figure, part == 0.8 ? "space_06" : "space_08", problem.surface.mesh, problem.elements,
                          {150, 25, 1});
        add_known(shown, problem, 80, figure);
        shown.end_table("Lowered by " + percent);
        shown.end_picture("Lowered by " + percent + ": abs(μ).");
        shown.end_components("Lowered by " + percent + ": μ₁, the real axis around the cylinder.", false);
    }
    return figure;
}

Figure space_09(Output& output) {
    Figure figure{"Figures 9, 12 and 15: a torus with a hole, its loop turned",
                  "Two boundary conditions of one torus (4 008 triangles). Left free in space the surface shrinks: of "
                  "the maps of the paper the area is what counts against them. The paper has 99 % of the faces of one "
                  "such map in [.4, .5]."};
    const Mesh mesh = bench::torus_with_hole();
    struct Turn {
        std::string name, words;
        double degrees, pull, scale;
    };
    for (const Turn& turn :
         {Turn{"space_09", "turned by 60 degrees and pulled by .8", 60, 0.8, 1},
          Turn{"space_12", "turned by 100 degrees, pulled by .3 and scaled by 1.3", 100, 0.3, 1.3}}) {
        const Problem problem(mesh, bench::turned(mesh, turn.degrees * pi / 180, turn.pull, turn.scale, false),
                              nullptr);
        SpaceFigure shown(output, figure, turn.name, problem.surface.mesh, problem.elements, {200, 25, 1});
        add_free(shown, problem);
        shown.end_table("The loop " + turn.words);
        shown.end_picture("The loop " + turn.words + ": abs(μ).");
        shown.end_components("The same: μ₁, the real axis horizontal.", false);
    }
    return figure;
}

Figure space_14(Output& output) {
    Figure figure{"Figure 14: a sphere with six holes, turned by 60 degrees and moved",
                  "Every other hole the other way, scaled by 1.25 and .8 (6 128 triangles)."};
    const Mesh mesh = bench::sphere_with_holes();
    const Problem problem(mesh, bench::turned(mesh, pi / 3, 0.3, 1.25, true), nullptr);
    SpaceFigure shown(output, figure, "space_14", problem.surface.mesh, problem.elements, {200, 25, 1});
    add_free(shown, problem);
    shown.end_table("");
    shown.end_picture("A sphere with six holes: abs(μ).");
    shown.end_components("The same: μ₁, the real axis horizontal, and what it differs by from its neighbours.", true);
    return figure;
}

Figure space_steps(Output& output) {
    (void)output;
    Figure figure{
        "Line search and passes of smoothing in the QC iteration",
        "The cylinder lowered by 80 %, and the corner of the square pushed in by .65: the standard deviation of "
        "abs(μ) after so many steps, with the line search of the paper's step 4 and without, and with more "
        "passes over the edges between two steps."};
    const ParametricTarget round = cylinder_target(1, 2);
    const PlaneTarget flat;
    const Mesh pipe = bench::cylinder_to_lower(1, Cells::triangles);
    Mesh square = rectangle(1, 1, 28, 28);
    square.positions.conservativeResize(Eigen::NoChange, 3);
    square.positions.col(2).setZero();
    Picture picture{"space_steps", "The standard deviation of abs(μ) by steps of the QC iteration.", {}};
    const auto shown = [&](const std::string& name, const Problem& problem) {
        Table table{name, {"", "5 steps", "10", "20", "40", "80", "flips at the end", "max"}, {}};
        std::vector<Curve> curves;
        struct Way {
            std::string name;
            bool line_search;
            int passes;
        };
        for (const Way& way : {Way{"one pass", false, 1}, Way{"line search", true, 1}, Way{"2 passes", false, 2},
                               Way{"3 passes", false, 3}, Way{"5 passes", false, 5}}) {
            std::vector<std::string> row{way.name};
            Curve curve{way.name, {}, {}};
            Distortion d;
            for (const int count : {5, 10, 20, 40, 80}) {
                UniformOptions options = steps(count);
                options.tolerance = 0;
                options.line_search = way.line_search;
                options.smoothing_passes = way.passes;
                const Positions map = problem.uniform(options).second;
                d = distortion(problem.elements.operators, map, problem.normals(map));
                row.push_back(number(d.standard_deviation));
                curve.x.push_back(count);
                curve.y.push_back(d.standard_deviation);
            }
            row.push_back(std::to_string(d.flipped.size()));
            row.push_back(number(d.max, 3));
            table.rows.push_back(std::move(row));
            curves.push_back(std::move(curve));
        }
        figure.tables.push_back(std::move(table));
        picture.panels.push_back(curves_panel(curves, name, "steps", "std of |μ|"));
    };
    shown("The cylinder", Problem(pipe, lowered(pipe, 0.8), &round));
    shown("The square", Problem(square, bench::arrow_head(square, 0.65), &flat));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

}  // namespace beltrami::gallery
