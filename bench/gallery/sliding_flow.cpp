// The Beltrami holomorphic flow: Examples 1 to 3.
#include "gallery/power_descent.h"
#include "gallery/sliding.h"
#include "problems/swirl.h"

#include <beltrami/flow/beltrami_flow.h>
#include <beltrami/mesh/planar.h>

#include <algorithm>
#include <cmath>

namespace beltrami::gallery {

namespace {

using bench::image_domain;
using bench::swirl;
using bench::swirl_coefficient;

double distance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

/// A piecewise linear map onto a domain, to be found again from its coefficient.
struct Given {
    std::string name, caption;
    std::vector<Hole> holes;
    TargetDomain target;
    std::function<Eigen::VectorXcd(const Surface&)> map;
};

/// The map z ↦ f(z), boundary vertices on the target's splines.
template <class Map>
Eigen::VectorXcd on_curves(const Surface& source, const TargetDomain& target, const Map& f) {
    Eigen::VectorXcd map = planar_coordinates(source.mesh).unaryExpr(f);
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop) {
            double least = 1;
            Complex place;
            for (int c = 0; c < target.curve_count(); ++c) {
                const Complex near = target.curve(c).point(target.curve(c).nearest(map[v]));
                if (std::abs(near - map[v]) < least) least = std::abs(near - map[v]), place = near;
            }
            map[v] = place;
        }
    return map;
}

/// Errors of the coordinates and of the coefficient after every iteration.
struct Course {
    Curve coordinates, coefficient;
    FlowMap flow;
    Eigen::VectorXcd given;
    double start = 0;  ///< distance of the harmonic start
};

Course find_again(const Given& example, const Surface& source) {
    Course course;
    course.given = example.map(source);
    const Eigen::VectorXcd mu = distortion(source.operators, course.given).mu;
    const SlidingStart start = flow_start(source, example.target, numbered(example.holes.size()));
    course.start = distance(start.map, course.given);
    const auto add = [&](int iteration, const Eigen::VectorXcd& map, double sup) {
        course.coordinates.x.push_back(iteration);
        course.coordinates.y.push_back(distance(map, course.given));
        course.coefficient.x.push_back(iteration);
        course.coefficient.y.push_back(sup);
    };
    add(0, start.map, coefficient_error(source, start.map, mu).sup);
    FlowOptions options;
    options.progress = [&](int iteration, const FlowIteration& now, const Eigen::VectorXcd& map) {
        add(iteration, map, now.error.sup);
        return true;
    };
    course.flow = beltrami_flow(source, mu, start, options);
    return course;
}

void found_again(Output& output, Figure& figure, Table& table, const Given& example) {
    std::vector<Curve> coordinates, coefficient;
    for (const double h : {0.1, 0.05, 0.025}) {
        const Surface source(disk_with_holes(example.holes, h));
        Course course = find_again(example, source);
        course.coordinates.label = course.coefficient.label = "h = " + number(h, 3);
        const auto first_below = [&](double limit) {
            for (std::size_t i = 0; i < course.coordinates.y.size(); ++i)
                if (course.coordinates.y[i] < limit) return std::to_string(static_cast<int>(course.coordinates.x[i]));
            return std::string("–");
        };
        table.rows.push_back({example.caption, number(h, 3), std::to_string(source.mesh.face_count()),
                              number(distortion(source.operators, course.given).max, 3), number(course.start, 3),
                              first_below(1e-3), first_below(1e-9), std::to_string(course.flow.iterations),
                              scientific(distance(course.flow.map, course.given)), scientific(course.flow.error.sup),
                              std::to_string(course.flow.distortion.flipped.size())});
        if (h == 0.05) {
            const Eigen::VectorXd given_mu = distortion(source.operators, course.given).face_abs_mu;
            const std::string given = output.write(example.name + "_given", source.mesh, course.given, given_mu),
                              found = output.write(example.name + "_found", source.mesh, course.flow.map,
                                                   course.flow.distortion.face_abs_mu);
            figure.pictures.push_back(
                {example.name,
                 example.caption + ": the source, the given map, the one found from its μ, and the errors.",
                 {circles_panel(given, "source", "source", 22), circles_panel(given, "given map", "image", 22),
                  circles_panel(found, "found from μ", "image", 22)}});
        }
        coordinates.push_back(std::move(course.coordinates));
        coefficient.push_back(std::move(course.coefficient));
    }
    Picture& picture = figure.pictures.back();
    picture.panels.push_back(curves_panel(coordinates, "largest error of the map", "iteration", "", false));
    picture.panels.push_back(curves_panel(coefficient, "largest error of μ", "iteration", "", false));
    for (std::size_t i = picture.panels.size() - 2; i < picture.panels.size(); ++i) picture.panels[i]["log_y"] = true;
}

/// Example 3: μ is that of a smooth map; the error is that of the mesh.
void swirled(Output& output, Figure& figure) {
    const std::vector<Hole> holes{{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}};
    const TargetDomain target = image_domain(holes, swirl);
    Table table{
        "Example 3: f = e^{1.5i} z e^{1.5i abs(z)}, μ given at the triangles' barycentres. Orders are against the row "
        "above",
        {"h", "triangles", "iterations", "largest error of f", "order", "largest error of μ", "order",
         "root mean square", "order", "flips", "seconds"},
        {}};
    Curve map_curve{"map, largest", {}, {}}, sup_curve{"μ, largest", {}, {}}, l2_curve{"μ, root mean square", {}, {}};
    Picture picture{"sliding_03", "Example 3: small circles of the source and their images; errors against h.", {}};
    for (const double h : {0.08, 0.04, 0.02, 0.01}) {
        const Surface source(disk_with_holes(holes, h));
        const Eigen::VectorXcd z = planar_coordinates(source.mesh);
        const Eigen::VectorXcd exact = z.unaryExpr([](Complex p) { return swirl(p); });
        Eigen::VectorXcd mu(source.operators.sample_count());
        for (int s = 0; s < mu.size(); ++s) {
            Complex middle = 0;
            for (const int v : source.operators.stencil(s)) middle += z[v] / 3.0;
            mu[s] = swirl_coefficient(middle);
        }
        FlowMap flow;
        const Solved solved = solve_with(source, "flow", [&] {
            flow = beltrami_flow(source, target, mu, {}, numbered(3));
            return flow.map;
        });
        const auto order = [](const Curve& curve) {
            const std::size_t n = curve.y.size();
            return n < 2 ? "" : number(std::log2(curve.y[n - 2] / curve.y[n - 1]), 2);
        };
        for (const auto& [curve, error] :
             {std::pair{&map_curve, distance(flow.map, exact)}, std::pair{&sup_curve, flow.error.sup},
              std::pair{&l2_curve, flow.error.l2}}) {
            curve->x.push_back(h);
            curve->y.push_back(error);
        }
        table.rows.push_back({number(h, 2), std::to_string(source.mesh.face_count()), std::to_string(flow.iterations),
                              scientific(map_curve.y.back()), order(map_curve), scientific(sup_curve.y.back()),
                              order(sup_curve), scientific(l2_curve.y.back()), order(l2_curve),
                              std::to_string(flow.distortion.flipped.size()), number(solved.seconds, 2)});
        if (h != 0.04) continue;
        const std::string data = output.write("sliding_03", source.mesh, flow.map, flow.distortion.face_abs_mu);
        picture.panels = {circles_panel(data, "source", "source", 22), circles_panel(data, "image", "image", 22),
                          map_panel(data, "|μ|", 0.8)};
    }
    const auto mean_order = [](const Curve& curve) {
        return number(std::log(curve.y.front() / curve.y.back()) / std::log(curve.x.front() / curve.x.back()), 2);
    };
    figure.remarks.push_back("Example 3 from the coarsest to the finest mesh: the error of the map falls like h^" +
                             mean_order(map_curve) + ", of μ like h^" + mean_order(sup_curve) + " (root mean square " +
                             mean_order(l2_curve) +
                             "). The paper's text has 1.79 for μ and .92 for the coordinates, its captions the other "
                             "way round; of piecewise linear maps the higher order must be the map's.");
    picture.panels.push_back(curves_panel({map_curve, sup_curve, l2_curve}, "", "h", "error"));
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
}

/// Every step with the ε after which the largest error of μ is least, beside ε = 1.
void chosen_steps(Figure& figure, const Given& example) {
    Table table{"ε of the flow: at every step 1, or that of 1, ¾, ½, ¼ after which sup abs(μ_f − μ) is least (h = .05)",
                {"coefficient", "ε", "steps", "chosen", "sup abs(μ_f − μ) after 1, 2, 3, 5 steps", "in the end"},
                {}};
    const Surface source(disk_with_holes(example.holes, 0.05));
    const Eigen::VectorXcd exact = distortion(source.operators, example.map(source)).mu;
    for (const bool half : {false, true}) {
        const Eigen::VectorXcd mu = half ? Eigen::VectorXcd(0.5 * exact) : exact;
        for (const bool choose : {false, true}) {
            SlidingStart at = flow_start(source, example.target, numbered(example.holes.size()));
            std::vector<double> sups;
            std::string chosen;
            for (int step = 0; step < 12; ++step) {
                std::optional<FlowMap> best;
                double best_epsilon = 1;
                for (const double epsilon : choose ? std::vector<double>{1, 0.75, 0.5, 0.25} : std::vector<double>{1}) {
                    FlowOptions options;
                    options.max_iterations = 1;
                    options.step = epsilon;
                    FlowMap next = beltrami_flow(source, mu, at, options);
                    if (!best || next.error.sup < best->error.sup) best = std::move(next), best_epsilon = epsilon;
                }
                at = flow_start(source, example.target, best->map);
                sups.push_back(best->error.sup);
                chosen += (chosen.empty() ? "" : " ") + number(best_epsilon, 2);
            }
            std::string course;
            for (const int i : {0, 1, 2, 4}) course += (course.empty() ? "" : ", ") + scientific(sups[i]);
            table.rows.push_back({half ? "½ μ: the target does not fit" : "μ of the map", choose ? "chosen" : "1",
                                  std::to_string(sups.size()), choose ? chosen : "", course, scientific(sups.back())});
        }
    }
    figure.tables.push_back(std::move(table));
}

/// Their problem (24) with the power p in place of the maximum, from the flow's map, which is that for p = 2 but for
/// the weight |∂f|².
void higher_powers(Figure& figure, const Given& example) {
    Table table{
        "The flow minimises Σ A abs(∂̄f − ν∂f)²; beside it the least Σ A abs(μ_f − ν)^p of eq. (24), p raised step by "
        "step, at most 1 500 "
        "steps of L-BFGS each (h = .1)",
        {"coefficient ν", "minimised", "sup abs(μ_f − ν)", "root mean square", "flips", "steps", "seconds"},
        {}};
    const Surface source(disk_with_holes(example.holes, 0.1));
    const Eigen::VectorXcd exact = distortion(source.operators, example.map(source)).mu;
    for (const bool half : {false, true}) {
        const Eigen::VectorXcd nu = half ? Eigen::VectorXcd(0.5 * exact) : exact;
        const std::string name = half ? "½ μ: the target does not fit" : "μ of the map";
        FlowMap at;
        const Solved flow = solve_with(source, "flow", [&] {
            at = beltrami_flow(source, example.target, nu, {}, numbered(example.holes.size()));
            return at.map;
        });
        const auto add = [&](const std::string& what, const Solved& solved, int steps) {
            const CoefficientError error = coefficient_error(source, solved.map, nu);
            table.rows.push_back({name, what, scientific(error.sup), scientific(error.l2),
                                  std::to_string(solved.distortion.flipped.size()), std::to_string(steps),
                                  number(solved.seconds, 2)});
        };
        add("the flow", flow, at.iterations);
        if (!half) continue;  // nothing is left
        for (const double p : {2.0, 4.0, 8.0, 16.0}) {
            int steps = 0;
            const Solved solved = solve_with(source, "power", [&] {
                Descent found = nearest_coefficient(source, example.target, at, nu, p, 1500);
                steps = found.iterations;
                return std::move(found.map);
            });
            if (!solved) break;
            add("p = " + number(p, 0), solved, steps);
            const SlidingStart there = flow_start(source, example.target, solved.map);
            at.map = there.map;
            for (std::size_t l = 0; l < there.loops.size(); ++l) at.loops[l].parameters = there.loops[l].parameters;
        }
    }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure sliding_01(Output& output) {
    Figure figure{
        "Examples 1 to 3: the Beltrami holomorphic flow",
        "*The paper:* A map is given by its coefficient alone and found again by the flow; the errors of the "
        "coordinates and of μ go to 0 in less than 10 iterations (Examples 1 and 2). The coefficient of a smooth map: "
        "errors against the mesh size (Example 3)."};
    const std::vector<Hole> two{{0.4, -0.02, 0.26}, {-0.32, 0.09, 0.16}},
        three{{-0.11, -0.46, 0.16}, {-0.34, 0.37, 0.14}, {0.36, 0.01, 0.18}};
    const auto bent = [](Complex z) {
        return z + 0.12 * z * z + 0.25 * std::conj(z) + 0.1 * Complex(0, 1) * std::norm(z);
    };
    const TargetDomain bent_target = image_domain(two, bent);
    const TargetDomain circles = circles_target({{-0.2, -0.4, 0.2}, {-0.3, 0.45, 0.1}, {0.4, 0.1, 0.22}});
    const std::vector<Given> examples{
        {"sliding_01", "Example 1: two holes, z + .12z² + .25z̄ + .1i abs(z)²", two, bent_target,
         [&](const Surface& source) { return on_curves(source, bent_target, bent); }},
        {"sliding_02", "Example 2: three holes between circle domains", three, circles, [&](const Surface& source) {
             FlowStartOptions turned;
             turned.start_turns = {0.2, 0.3, -0.3, 0.2};
             return flow_start(source, circles, numbered(3), turned).map;
         }}};
    Table table{
        "Sources are the paper's; it does not name its maps. Example 2's is the harmonic map with circles that are "
        "turned by .2, .3, −.3, .2",
        {"map", "h", "triangles", "max abs(μ)", "distance of the start", "iterations to 1e-3", "to 1e-9", "all",
         "largest error of the map", "of μ", "flips"},
        {}};
    for (const Given& example : examples) found_again(output, figure, table, example);
    figure.tables.push_back(std::move(table));
    swirled(output, figure);
    chosen_steps(figure, examples[0]);
    higher_powers(figure, examples[0]);
    figure.remarks.push_back(
        "The paper offers to choose ε so that sup |μ − ν| becomes least and takes 1 throughout. So does the default "
        "here: with ε = 1 every step is "
        "one of Newton's method.");
    return figure;
}

}  // namespace beltrami::gallery
