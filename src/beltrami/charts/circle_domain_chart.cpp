#include <beltrami/charts/circle_domain_chart.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <beltrami/base/counted.h>
#include <beltrami/base/effort.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/circle_slide.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/hole_centre.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/circle_fit.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Rims of a start are made as round as that by an analytic map: sliding does the rest.
constexpr double kStartRatio = 1.02;
/// Rims of files with few digits count as circles.
constexpr double kRound = 1e-6;

std::vector<Complex> rim_points(const Surface& source, int loop, const Eigen::VectorXcd& z) {
    std::vector<Complex> points;
    for (const int v : source.topology.boundary_loops[loop]) points.push_back(z[v]);
    return points;
}

/// Relative to the radius.
double distance_from(const RoundHole& hole, const std::vector<Complex>& rim) {
    double largest = 0;
    for (const Complex z : rim) largest = std::max(largest, std::abs(std::abs(z - hole.centre) / hole.radius - 1));
    return largest;
}

/// The least-squares circles of the rims.
std::vector<RoundHole> fitted_holes(const Surface& source, const Chart& chart) {
    std::vector<RoundHole> holes;
    for (const Chart::Hole& hole : chart.holes) {
        const CircleFit circle = fit_circle(rim_points(source, hole.loop, chart.vertices));
        holes.push_back({hole.loop, circle.centre, circle.radius});
    }
    return holes;
}

double roundness(const Surface& source, const Chart& chart, const std::vector<RoundHole>& holes) {
    double largest = distance_from({chart.outer_loop, 0, 1}, rim_points(source, chart.outer_loop, chart.vertices));
    for (const RoundHole& hole : holes)
        largest = std::max(largest, distance_from(hole, rim_points(source, hole.loop, chart.vertices)));
    return largest;
}

/// Whether every rim misses its circle by less than that part of the longest edge's distance from the arc.
bool round_enough(const Surface& source, const Chart& chart, const std::vector<RoundHole>& holes, double part) {
    return std::all_of(holes.begin(), holes.end(), [&](const RoundHole& hole) {
        const std::vector<Complex> rim = rim_points(source, hole.loop, chart.vertices);
        double longest = 0;
        for (std::size_t i = 0; i < rim.size(); ++i)
            longest = std::max(longest, std::abs(rim[(i + 1) % rim.size()] - rim[i]) / hole.radius);
        return distance_from(hole, rim) <= std::max(kRound, part * longest * longest / 8);
    });
}

/// The exact chart with rims as round as can be and their circles, if they are round enough.
bool keep_exact(const Surface& source, const CircleDomainOptions& options, CircleDomainChart& result) {
    std::vector<RoundHole> holes = fitted_holes(source, result.chart);
    if (!round_enough(source, result.chart, holes, 0)) {
        if (options.exact_part == 0) return false;
        DomainChartOptions rounder;
        rounder.round_from = options.rounding.wanted_ratio;
        rounder.rounding = options.rounding;
        Chart chart = domain_chart(source, result.chart.outer_loop, nullptr, rounder);
        holes = fitted_holes(source, chart);
        if (!round_enough(source, chart, holes, options.exact_part)) return false;
        result.chart = std::move(chart);
    }
    result.roundness = roundness(source, result.chart, holes);
    result.holes = std::move(holes);
    return true;
}

/// Vertices of rims that are nearly round, onto their circles.
void snap(const Surface& source, const std::vector<RoundHole>& circles, Chart& chart) {
    for (const RoundHole& circle : circles)
        for (const int v : source.topology.boundary_loops[circle.loop]) {
            const Complex arm = chart.vertices[v] - circle.centre;
            chart.vertices[v] = circle.centre + circle.radius * arm / std::abs(arm);
        }
}

std::vector<int> pinched_faces(const Surface& source, int outer_loop) {
    const Topology& topology = source.topology;
    std::vector<int> hole_of(source.mesh.vertex_count(), -1);
    for (int l = 0; l < static_cast<int>(topology.boundary_loops.size()); ++l)
        if (l != outer_loop)
            for (const int v : topology.boundary_loops[l]) hole_of[v] = l;
    std::vector<int> faces;
    for (int e = 0; e < topology.edge_count(); ++e) {
        const auto [a, b] = topology.edges[e];
        const auto [left, right] = topology.edge_faces[e];
        if (left < 0 || right < 0 || hole_of[a] < 0 || hole_of[a] != hole_of[b]) continue;
        faces.push_back(left);
        faces.push_back(right);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

/// Of the faces flipped, those that do not touch a pinched one.
std::vector<int> unforced(const Surface& source, const CircleDomainChart& chart) {
    std::vector<char> touched(source.mesh.vertex_count(), 0);
    for (const int f : chart.pinched)
        for (const int v : source.mesh.faces[f]) touched[v] = 1;
    std::vector<int> result;
    for (const int f : chart.flipped) {
        const auto face = source.mesh.faces[f];
        if (std::none_of(face.begin(), face.end(), [&](int v) { return touched[v]; })) result.push_back(f);
    }
    return result;
}

void measure(const Surface& source, CircleDomainChart& result) {
    const Distortion map = distortion(source.operators, result.chart.vertices);
    result.mean_mu = map.mean;
    result.standard_deviation = map.standard_deviation;
    result.max_mu = map.max;
    result.flipped = map.flipped;
}

/// Unfolds the inside of the rims where faces came out flipped, if it can be done.
void unfold(const Surface& source, CircleDomainChart& result) {
    const std::vector<int> folded = unforced(source, result);
    if (folded.empty()) return;
    const std::vector<Freedom> freedom = dirichlet_freedoms(source);
    const Eigen::VectorXcd before = result.chart.vertices;
    const auto take = [&](Eigen::VectorXcd z, int factorizations) {
        Chart chart = make_chart(source, std::move(z), false);
        chart.outer_loop = result.chart.outer_loop;
        chart.holes = std::move(result.chart.holes);
        chart.factorizations = result.chart.factorizations + factorizations;
        result.chart = std::move(chart);
        measure(source, result);
    };
    const auto as_a_whole = [&] {
        FoldFreeOptions options;
        options.tolerance = 1e-3;
        options.max_iterations = 200;
        FoldFreeMap map =
            fold_free_map(source, freedom, Eigen::VectorXcd::Zero(source.operators.sample_count()), before, options);
        take(std::move(map.map), map.factorizations);
    };
    const auto by_parts = [&] {
        LocalUnfolding map = unfold_locally(source, freedom, before);
        take(std::move(map.map), map.factorizations);
    };
    // A disk's folds are few and small, and the rest of it may stay as it is.
    if (result.holes.empty()) {
        by_parts();
        if (!unforced(source, result).empty()) as_a_whole();
    } else {
        as_a_whole();
        if (!unforced(source, result).empty()) by_parts();
    }
    if (!unforced(source, result).empty() && result.holes.empty()) {
        FoldFreeDisk disk = fold_free_disk(source, before);
        take(std::move(disk.map), disk.factorizations);
    }
    const std::vector<int> faces = unforced(source, result);
    if (!faces.empty() && result.holes.empty()) {  // smaller than rounding, they are no part of the domain
        result.chart.warnings.push_back(
            {WarningKind::chart,
             counted(faces.size(), "face stays", "faces stay") + " flipped in the circle domain and out of it",
             {Things::faces, faces}});
        return;
    }
    if (!faces.empty())
        throw Error(Cause::not_solved,
                    counted(faces.size(), "face stays", "faces stay") +
                        " flipped in the circle domain, the first is face " + std::to_string(faces[0]),
                    "refine the mesh near them", {Things::faces, faces});
    result.chart.warnings.push_back({WarningKind::chart,
                                     "the harmonic map flipped " + counted(folded.size(), "face", "faces") +
                                         ", unfolded since, which costs conformality",
                                     {Things::faces, folded}});
}

[[noreturn]] void too_close(const CircleDomainOptions& options) {
    std::ostringstream gap;
    gap << options.least_gap;
    throw Error(Cause::not_solved,
                "two circles of the circle domain come closer than " + gap.str() + " of the smaller one's radius",
                "the surface has loops that nearly touch: allow a smaller least_gap, or cut it so that they are one");
}

void slide(const Surface& source, const CircleDomainOptions& options, CircleDomainChart& result) {
    std::vector<RoundHole> holes;
    for (const Chart::Hole& hole : result.chart.holes) {
        const HoleCentre place = hole_centre(rim_points(source, hole.loop, result.chart.vertices));
        holes.push_back({hole.loop, place.centre, place.radius});
    }
    result.roundness = roundness(source, result.chart, holes);
    const BeltramiSolver dirichlet = dirichlet_solver(source);
    CircleSlide map = put_on_circles(source, dirichlet, result.chart.outer_loop, result.chart.vertices, holes);
    slide_on_circles(source, dirichlet, result.chart.outer_loop, map,
                     {options.max_steps, options.tolerance, options.least_gap});
    if (map.too_close) too_close(options);
    result.steps = map.steps;
    result.converged = map.converged;
    result.harmonic_solves = map.products;
    result.holes = std::move(map.holes);
    Chart chart = make_chart(source, std::move(map.vertices), false);
    chart.outer_loop = result.chart.outer_loop;
    chart.factorizations = result.chart.factorizations + 1;
    result.chart = std::move(chart);
}

}  // namespace

void CircleDomainOptions::validate() const {
    if (max_steps < 0) throw Error(Cause::bad_option, "max_steps is negative", "give 0 or more");
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance is not positive", "give about 1e-7");
    if (!(exact_part >= 0)) throw Error(Cause::bad_option, "exact_part is negative", "give 0 or more");
    if (!(least_gap > 0)) throw Error(Cause::bad_option, "least_gap is not positive", "give about 1e-3");
}

RoundHole CircleDomainChart::circle(int loop) const {
    for (const RoundHole& hole : holes)
        if (hole.loop == loop) return hole;
    return {loop, 0, 1};
}

CircleDomainChart circle_domain_chart(const Surface& source, int outer_loop, const CircleDomainOptions& options) {
    options.validate();
    count(Work::circle_chart);
    CircleDomainChart result;
    DomainChartOptions start;
    start.round_from = start.rounding.wanted_ratio = kStartRatio;
    result.chart = domain_chart(source, outer_loop, nullptr, start);
    if (!(result.chart.exact && keep_exact(source, options, result))) slide(source, options, result);
    if (least_gap(result.holes) < options.least_gap) too_close(options);
    snap(source, result.holes, result.chart);
    snap(source, {{result.chart.outer_loop, 0, 1}}, result.chart);
    result.chart.holes.clear();
    for (const RoundHole& hole : result.holes) result.chart.holes.push_back({hole.loop, hole.centre, hole.radius});
    result.pinched = pinched_faces(source, outer_loop);
    measure(source, result);
    unfold(source, result);
    if (!result.pinched.empty())
        result.chart.warnings.push_back(
            {WarningKind::pinched_faces,
             std::to_string(result.pinched.size()) +
                 " faces have an inner edge between two vertices of one hole, which no circle "
                 "domain has room for; split those edges",
             {Things::faces, result.pinched}});
    result.factorizations = result.chart.factorizations;
    return result;
}

}  // namespace beltrami
