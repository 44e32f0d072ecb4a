#include <beltrami/charts/domain_chart.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <beltrami/base/effort.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/charts/hole_centre.h>
#include <beltrami/meshing/fill_holes.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

void require_loops(const Surface& source, int outer_loop) {
    const Topology& topology = source.topology;
    const int loops = static_cast<int>(topology.boundary_loops.size());
    if (topology.components != 1 || topology.genus != 0 || loops == 0)
        throw Error(Cause::bad_mesh,
                    "a chart needs one component of genus 0 with boundary; the surface has " +
                        std::to_string(topology.components) + " components, genus " + std::to_string(topology.genus) +
                        " and " + std::to_string(loops) + " boundary loops",
                    "cut it until it has");
    if (outer_loop < 0 || outer_loop >= loops)
        throw Error(
            Cause::bad_option,
            "there is no boundary loop " + std::to_string(outer_loop) + ": the surface has " + std::to_string(loops),
            "loops are counted from 0, the outer one first");
}

std::vector<Complex> points_of(const std::vector<int>& loop, const Eigen::VectorXcd& z) {
    std::vector<Complex> points;
    points.reserve(loop.size());
    for (const int v : loop) points.push_back(z[v]);
    return points;
}

/// (a z + b)/(c z + d).
struct Moebius {
    Complex a, b, c, d;
    std::array<Complex, 2> operator()(Complex z) const {
        const Complex below = c * z + d, inverse = std::conj(below) / std::norm(below);
        return {(a * z + b) * inverse, (a * d - b * c) * inverse * inverse};
    }
};

/// The exterior of a circle to the unit disk, with the mean of the weighted points at 0.
Moebius inversion(const CircleFit& circle, const Eigen::VectorXcd& z, const Eigen::VectorXd& weights) {
    Moebius map{0, circle.radius, 1, -circle.centre};
    double total = 0;
    for (const double w : weights) total += w;
    for (int step = 0; step < 200; ++step) {
        Complex mean = 0;
        for (Eigen::Index v = 0; v < z.size(); ++v)
            if (weights[v] > 0) mean += weights[v] * map(z[v])[0];
        mean /= total;
        if (std::abs(mean) < 1e-14) break;
        // (w − mean)/(1 − conj(mean) w) after the map.
        map = {map.a - mean * map.c, map.b - mean * map.d, map.c - std::conj(mean) * map.a,
               map.d - std::conj(mean) * map.b};
    }
    return map;
}

/// Positions and derivatives by a map that is analytic on the plane of the mesh.
template <class Map>
void evaluate_exactly(const Surface& source, const Map& map, Chart& chart) {
    const Eigen::VectorXcd &z = *source.coordinate(), places = at_samples(source.operators, z);
    chart.vertices.setZero(z.size());
    chart.positions.resize(places.size());
    chart.derivatives.resize(places.size());
    for (const int v : source.mesh.faces.vertices()) chart.vertices[v] = map(z[v])[0];
    parallel_for(0, static_cast<int>(places.size()), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const auto [value, derivative] = map(places[s]);
            chart.positions[s] = value;
            chart.derivatives[s] = derivative;
        }
    });
}

/// The chart of a source whose outer loop lies on a circle of its plane.
Chart exact_chart(const Surface& source, int outer_loop, const CircleFit& circle, const Eigen::VectorXcd& z) {
    if (outer_loop == 0) {
        Chart chart = make_chart(source, (z.array() - circle.centre) / circle.radius, true);
        chart.analytic = Moebius{1, -circle.centre, 0, circle.radius};
        return chart;
    }
    Chart chart;
    const Moebius map = inversion(circle, z, vertex_areas(source.operators));
    chart.exact = true;
    chart.analytic = map;
    chart.excluded.assign(source.operators.sample_count(), 0);
    evaluate_exactly(source, map, chart);
    return chart;
}

/// The round disk's chart of the filled surface, on all its vertices.
Chart filled_chart(const Surface& source, int outer_loop, const RoundDiskOptions& options) {
    FilledSurface filled = fill_holes(source, outer_loop);
    return round_disk_chart(surface_of(std::move(filled.mesh), std::move(filled.metric)), options);
}

int loop_size(const Surface& source, int loop) {
    return static_cast<int>(source.topology.boundary_loops[loop].size());
}

/// The loop with the most vertices but for the outer one.
int longest_hole(const Surface& source, int outer_loop) {
    int best = outer_loop == 0 ? 1 : 0;
    for (int l = 0; l < static_cast<int>(source.topology.boundary_loops.size()); ++l)
        if (l != outer_loop && loop_size(source, l) > loop_size(source, best)) best = l;
    return best;
}

/// The round annulus between the outer loop and one hole, the others filled: on all vertices of the filled surface.
Chart annulus_chart(const Surface& source, int outer_loop, int hole) {
    const int vertex = source.topology.boundary_loops[outer_loop][0];
    std::optional<Surface> filled;
    if (source.topology.boundary_loops.size() > 2) {
        FilledSurface fill = fill_holes(source, std::vector<int>{outer_loop, hole});
        filled.emplace(surface_of(std::move(fill.mesh), std::move(fill.metric)));
    }
    const Surface& annulus = filled ? *filled : source;
    Chart chart;
    chart.vertices = annulus_map(annulus, annulus.topology.boundary_loops[0][0] == vertex ? 0 : 1);
    chart.factorizations = 2;
    return chart;
}

/// A planar source with one of its holes on the outside: 1/(z − c) with c in the hole. None if faces are turned over.
std::optional<Surface> turned_inside_out(const Surface& source, int outer_loop, const Eigen::VectorXcd& z) {
    const HoleCentre hole = hole_centre(points_of(source.topology.boundary_loops[outer_loop], z));
    Mesh mesh;
    mesh.faces = source.mesh.faces;
    mesh.positions = Positions::Zero(z.size(), 2);
    for (const int v : mesh.faces.vertices()) {
        const Complex w = hole.radius / (z[v] - hole.centre);
        mesh.positions.row(v) << w.real(), w.imag();
    }
    try {
        Surface surface(std::move(mesh));
        // The other loops lie inside the outer one, unless the source covers the plane more than once.
        if (surface.topology.boundary_loops[0][0] == source.topology.boundary_loops[outer_loop][0]) return surface;
    } catch (const Error&) {
    }
    return {};
}

Chart approximate_chart(const Surface& source, int outer_loop, const DomainChartOptions& options) {
    const Eigen::VectorXcd* z = source.coordinate();
    Chart filled;
    std::optional<Surface> inside_out;
    if (z && outer_loop != 0) inside_out = turned_inside_out(source, outer_loop, *z);
    const bool keeps_plane = z && (outer_loop == 0 || inside_out);
    const int hole = longest_hole(source, outer_loop);
    if (!keeps_plane && loop_size(source, hole) >= options.least_rim)
        filled = annulus_chart(source, outer_loop, hole);
    else
        filled =
            inside_out ? filled_chart(*inside_out, 0, options.disk) : filled_chart(source, outer_loop, options.disk);
    Eigen::VectorXcd g = filled.vertices.head(source.mesh.vertex_count());
    centre_in_disk(g, vertex_areas(source.operators));
    Chart chart = make_chart(source, std::move(g), false);
    chart.factorizations = filled.factorizations;
    return chart;
}

/// |μ| of a chart from which on it says nothing about a sample, as in make_chart.
constexpr double kMostDistortedDomain = 0.5;

/// Whether a chart is far from conformal, or turned over, at a sample where another one is not. The series of a
/// rounding can be steep at the rim, where a mesh with corners has few and long edges.
bool distorts_more(const Surface& source, const Eigen::VectorXcd& vertices, const Eigen::VectorXcd& before) {
    const auto turned = [&](int s, const Eigen::VectorXcd& z) {
        const auto [dz, dzbar] = source.operators.derivatives(s, z);
        return !(std::abs(dzbar) < kMostDistortedDomain * std::abs(dz));
    };
    for (int s = 0; s < source.operators.sample_count(); ++s)
        if (turned(s, vertices) && !turned(s, before)) return true;
    return false;
}

Chart composed(const Surface& source, const Chart& chart, const HoleRounding& rounding) {
    Chart result = chart;
    if (chart.exact) {
        const auto before = chart.analytic;
        result.analytic = [before, rounding](Complex z) -> std::array<Complex, 2> {
            const auto [g, slope] = before(z);
            const auto [value, derivative] = rounding(g);
            return {value, derivative * slope};
        };
        evaluate_exactly(source, result.analytic, result);
        return result;
    }
    std::vector<char> used(chart.vertices.size(), 0);  // others may lie on a pole
    for (const int v : source.mesh.faces.vertices()) used[v] = 1;
    parallel_for(0, static_cast<int>(chart.vertices.size()), [&](int first, int last) {
        for (int v = first; v < last; ++v)
            if (used[v]) result.vertices[v] = rounding(chart.vertices[v])[0];
    });
    parallel_for(0, static_cast<int>(chart.positions.size()), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const auto [value, derivative] = rounding(chart.positions[s]);
            result.positions[s] = value;
            result.derivatives[s] = derivative * chart.derivatives[s];
        }
    });
    return result;
}

/// Where many powers fail on long holes, few may do.
constexpr int kFewTerms = 4;
constexpr double kWorthwhile = 0.8;  // of the ratio's excess over 1: to be undercut

void make_holes_round(const Surface& source, const DomainChartOptions& options, Chart& chart) {
    std::vector<std::vector<Complex>> rims;
    double worst = 1;
    for (int l = 0; l < static_cast<int>(source.topology.boundary_loops.size()); ++l) {
        if (l == chart.outer_loop) continue;
        rims.push_back(points_of(source.topology.boundary_loops[l], chart.vertices));
        worst = std::max(worst, hole_centre(rims.back()).ratio);
    }
    const Chart unrounded = worst > options.round_from ? chart : Chart{};
    HoleRoundingOptions rounding_options = options.rounding;
    for (const int terms : {options.rounding.terms, kFewTerms}) {
        if (!(worst > options.round_from) || terms > rounding_options.terms) return;
        rounding_options.terms = terms;
        const HoleRounding rounding = round_holes(rims, rounding_options);
        if (rounding.steps.empty() || !(rounding.ratio - 1 < kWorthwhile * (worst - 1))) continue;
        Chart rounder = composed(source, unrounded, rounding);
        if (distorts_more(source, rounder.vertices, unrounded.vertices)) continue;
        chart = std::move(rounder);
        worst = rounding.ratio;
    }
}

void add_holes(const Surface& source, Chart& chart) {
    for (int l = 0; l < static_cast<int>(source.topology.boundary_loops.size()); ++l) {
        if (l == chart.outer_loop) continue;
        const HoleCentre hole = hole_centre(points_of(source.topology.boundary_loops[l], chart.vertices));
        chart.holes.push_back({l, hole.centre, hole.radius});
    }
}

}  // namespace

Chart domain_chart(const Surface& source, int outer_loop, const BeltramiSolver* dirichlet,
                   const DomainChartOptions& options) {
    require_loops(source, outer_loop);
    count(Work::domain_chart);
    const auto& loops = source.topology.boundary_loops;
    if (loops.size() == 1)
        return dirichlet ? round_disk_chart(source, *dirichlet, options.disk) : round_disk_chart(source, options.disk);

    const Eigen::VectorXcd* z = source.coordinate();
    std::optional<CircleFit> circle;
    if (z) circle = fit_circle(points_of(loops[outer_loop], *z));
    Chart chart = circle && circle->exact() ? exact_chart(source, outer_loop, *circle, *z)
                                            : approximate_chart(source, outer_loop, options);
    chart.outer_loop = outer_loop;
    make_holes_round(source, options, chart);
    add_holes(source, chart);
    return chart;
}

Chart plane_chart(const Surface& source) {
    const Eigen::VectorXcd& z = *source.coordinate();
    const auto& loops = source.topology.boundary_loops;
    const std::vector<Complex> outline = points_of(loops[0], z);
    Complex centre = 0;
    for (const Complex point : outline) centre += point / static_cast<double>(outline.size());
    double radius = 0;
    for (const Complex point : outline) radius = std::max(radius, std::abs(point - centre));
    Chart chart = make_chart(source, (z.array() - centre) / radius, true);
    chart.analytic = Moebius{1, -centre, 0, radius};
    add_holes(source, chart);
    return chart;
}

}  // namespace beltrami
