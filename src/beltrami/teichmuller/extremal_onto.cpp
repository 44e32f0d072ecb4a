#include <beltrami/teichmuller/extremal_onto.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/teichmuller/onto_problem.h>

namespace beltrami {

const char* to_string(OntoOptions::Space space) {
    switch (space) {
        case OntoOptions::Space::automatic:
            return "automatic";
        case OntoOptions::Space::laurent:
            return "laurent";
        case OntoOptions::Space::projection:
            return "projection";
        case OntoOptions::Space::one_form_squares:
            return "one_form_squares";
    }
    return "";
}

void OntoOptions::validate() const {
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance must be positive");
    if (max_iterations < 1) throw Error(Cause::bad_option, "there must be at least one iteration");
    if (anderson_window < 0) throw Error(Cause::bad_option, "the window of the acceleration must not be negative");
    if (outer_loop < 0) throw Error(Cause::bad_option, "the outer loop must not be negative");
    if (!(target_edge_length >= 0) || std::isinf(target_edge_length))
        throw Error(Cause::bad_option, "the target's edge length must be positive, or 0");
    for (const double turn : start_turns)
        if (!std::isfinite(turn)) throw Error(Cause::bad_option, "a start turn is not a number");
}

namespace {

/// Curves of the target's circle domain: 0 for the outer loop, then the holes of the chart.
int curve_of_loop(const CircleDomainChart& chart, int loop) {
    if (loop == chart.outer_loop()) return 0;
    for (std::size_t h = 0; h < chart.holes.size(); ++h)
        if (chart.holes[h].loop == loop) return static_cast<int>(h) + 1;
    throw Error(Cause::bad_option, "the target has no boundary loop " + std::to_string(loop),
                "`beltrami info` prints the loops' numbers");
}

}  // namespace

OntoOptions options_on_circles(const OntoOptions& options, const Surface& target, const CircleDomainChart& chart) {
    if (!options.marks.empty())
        throw Error(Cause::bad_option, "marks on curves are given for a target that is a surface",
                    "give pairs of vertices instead");
    OntoOptions result = options;
    for (auto& [loop, curve] : result.loops) curve = curve_of_loop(chart, curve);
    const auto& loops = target.topology.boundary_loops;
    for (const auto& [vertex, image] : options.mark_vertices) {
        int on = -1;
        for (std::size_t l = 0; l < loops.size(); ++l)
            if (std::find(loops[l].begin(), loops[l].end(), image) != loops[l].end()) on = static_cast<int>(l);
        if (on < 0)
            throw Error(Cause::bad_boundary,
                        "the mark's vertex " + std::to_string(image) + " is not on the boundary of the target",
                        "mark boundary vertices only", {image});
        const RoundHole circle = chart.circle(on);
        const int curve = curve_of_loop(chart, on);
        const double angle = std::arg(chart.chart.vertices[image] - circle.centre);
        result.marks.push_back({vertex, curve, circle.radius * (curve == 0 ? angle : -angle)});
    }
    return result;
}

ExtremalMapOnto extremal_map(const Surface& source, const TargetDomain& target, const OntoOptions& options) {
    if (!options.mark_vertices.empty())
        throw Error(Cause::bad_option, "marks by vertices of the target are given for a target that has none",
                    "give places on its curves instead");
    OntoProblem problem(source, options);
    return problem.solve(*target_model(target, edge_length_for(source, target, options.target_edge_length)));
}

ExtremalMapOntoSurface extremal_map(const Surface& source, const Surface& target, const OntoOptions& options,
                                    int outer) {
    ExtremalMapOntoSurface result;
    result.target = circle_domain_chart(target, outer);
    const OntoOptions own = options_on_circles(options, target, result.target);
    OntoProblem problem(source, own);
    result.plane = problem.solve(*target_model(circle_target(result.target), 0));
    result.plane.factorizations += result.target.factorizations;
    const std::vector<Complex> images(result.plane.map.begin(), result.plane.map.end());
    result.places = locate_in_chart(target, result.target.chart.vertices, images);
    result.positions = positions_on(target.mesh, result.places);
    return result;
}

}  // namespace beltrami
