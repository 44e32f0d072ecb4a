#include <beltrami/charts/boundary_values.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/charts/shape.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/plane/increasing.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

namespace {

/// A polygon's corner that turns by more than this receives a vertex.
constexpr double kCornerTurn = 10 * std::numbers::pi / 180;

/// A boundary loop from a given start, with the arc length (in the metric) of each vertex from it.
struct Loop {
    int index;
    std::vector<int> vertices;
    std::vector<double> arc;  ///< one more than vertices: the last is the total

    double total() const { return arc.back(); }
    std::size_t size() const { return vertices.size(); }
};

Loop loop_from(const Surface& source, int index, std::optional<int> start) {
    const auto& loops = source.topology.boundary_loops;
    if (loops.empty())
        throw Error(Cause::bad_boundary, "the surface is closed: it has no boundary to prescribe", "cut it open first");
    if (index < 0 || index >= static_cast<int>(loops.size()))
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(index) +
                                           ": the surface has the loops 0 to " + std::to_string(loops.size() - 1));
    Loop loop{index, loops[index], {0.0}};
    std::vector<double> lengths = source.boundary_edge_lengths[index];
    if (start) {
        const auto at = std::find(loop.vertices.begin(), loop.vertices.end(), *start);
        if (at == loop.vertices.end())
            throw Error(
                Cause::bad_boundary,
                "the start vertex " + std::to_string(*start) + " is not on boundary loop " + std::to_string(index),
                "name a vertex of that loop, counted from 0", {Things::vertices, {*start}});
        std::rotate(lengths.begin(), lengths.begin() + (at - loop.vertices.begin()), lengths.end());
        std::rotate(loop.vertices.begin(), at, loop.vertices.end());
    }
    for (std::size_t i = 0; i < loop.size(); ++i) loop.arc.push_back(loop.arc.back() + lengths[i]);
    return loop;
}

/// Angles of the loop's vertices on the unit circle of the canonical domain, 0 at the start and increasing.
std::vector<double> conformal_angles(const Surface& source, const Loop& loop, const Shape* shape = nullptr) {
    std::optional<Chart> own;
    if (!shape) own = domain_chart(source, loop.index);
    const Chart& chart = shape ? shape->chart(loop.index) : *own;
    std::vector<double> angle{0.0};
    for (std::size_t i = 1; i < loop.size(); ++i)
        angle.push_back(angle.back() +
                        std::arg(chart.vertices[loop.vertices[i]] / chart.vertices[loop.vertices[i - 1]]));
    // At a corner of angle α the map's boundary values move like s^{π/α}; at convex ones neighbouring vertices come so
    // near each other that discretisation can exchange them.
    make_increasing(angle, kTurn, loop.arc);
    const double start = angle[0];
    for (double& a : angle) a -= start;
    return angle;
}

/// A mesh of a polygon's inside that its conformal map can be read from; finer at corners, where the map is not smooth.
Mesh inside_of(const std::vector<Complex>& polygon) {
    Polygon points;
    for (const Complex z : polygon) points.emplace_back(z.real(), z.imag());
    DomainOptions options;
    options.edge_length = std::sqrt(signed_area(polygon)) / 50;
    options.corner_edge_length = options.edge_length / 8;
    return polygon_domain(points, {}, options);
}

void require_positive(double value, const char* name) {
    if (!(value > 0) || !std::isfinite(value))
        throw Error(Cause::bad_option, std::string("the ") + name + " must be a positive number");
}

/// Assigns to each corner parameter (increasing, the first is 0) the nearest vertex, keeping the order; returns
/// positions in the loop.
std::vector<std::size_t> nearest_vertices(const std::vector<double>& parameter, const std::vector<double>& corners) {
    std::vector<std::size_t> chosen{0};
    for (std::size_t c = 1; c < corners.size(); ++c) {
        const std::size_t first = chosen.back() + 1,
                          last = parameter.size() - (corners.size() - 1 - c);  // room for the rest
        if (first >= last) return {};
        std::size_t best = first;
        for (std::size_t i = first; i < last; ++i)
            if (std::abs(parameter[i] - corners[c]) < std::abs(parameter[best] - corners[c])) best = i;
        chosen.push_back(best);
    }
    return chosen;
}

/// The harmonic function that is 0 on the vertices `low`, `height` on `high` and has no flux through the rest of the
/// boundary.
Eigen::VectorXd harmonic_between(const Surface& source, const std::vector<int>& low, const std::vector<int>& high,
                                 double height) {
    // Every vertex slides along the real axis: min Σ A|∂̄u|² over real u is the Dirichlet problem.
    std::vector<Freedom> freedom(source.mesh.vertex_count(), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices()) freedom[v] = Freedom::sliding;
    Eigen::VectorXcd start = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    for (const int v : low) freedom[v] = Freedom::fixed;
    for (const int v : high) {
        freedom[v] = Freedom::fixed;
        start[v] = height;
    }
    BeltramiSolver solver(source, freedom, 1);
    solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()),
                     Eigen::VectorXcd::Ones(source.mesh.vertex_count()));
    return solver.solve(start).real();
}

}  // namespace

BoundaryCondition boundary_to_disk(const Surface& source, double amplitude, const BoundaryPlacement& placement) {
    if (!(std::abs(amplitude) < 1))
        throw Error(Cause::bad_option,
                    "the amplitude of disk:A must lie between -1 and 1, or the boundary would run backwards");
    const Loop loop = loop_from(source, placement.loop, placement.start);
    std::vector<double> angle;
    if (placement.speed == BoundarySpeed::conformal) {
        angle = conformal_angles(source, loop, placement.shape);
    } else {
        for (std::size_t i = 0; i < loop.size(); ++i) angle.push_back(kTurn * loop.arc[i] / loop.total());
    }
    BoundaryCondition boundary;
    for (std::size_t i = 0; i < loop.size(); ++i)
        boundary.pin(loop.vertices[i], std::polar(1.0, angle[i] + amplitude * std::sin(angle[i])));
    return boundary;
}

BoundaryCondition boundary_to_rectangle(const Surface& source, double width, double height,
                                        const std::optional<std::array<int, 4>>& corners,
                                        const BoundaryPlacement& placement) {
    require_positive(width, "rectangle's width");
    require_positive(height, "rectangle's height");
    if (corners && placement.start && (*corners)[0] != *placement.start)
        throw Error(Cause::bad_option, "the start vertex and the first corner are both given and differ",
                    "give only the corners");
    const Loop loop = loop_from(source, placement.loop, corners ? std::optional((*corners)[0]) : placement.start);

    std::vector<std::size_t> at;  // positions of the corners in the loop
    if (corners) {
        for (const int corner : *corners) {
            const auto found = std::find(loop.vertices.begin(), loop.vertices.end(), corner);
            if (found == loop.vertices.end())
                throw Error(Cause::bad_boundary,
                            "the corner " + std::to_string(corner) + " is not on boundary loop " +
                                std::to_string(placement.loop),
                            "name four vertices of that loop, counted from 0", {Things::vertices, {corner}});
            at.push_back(static_cast<std::size_t>(found - loop.vertices.begin()));
        }
        for (std::size_t c = 1; c < 4; ++c)
            if (at[c] <= at[c - 1])
                throw Error(Cause::bad_boundary,
                            "the corners are not four different vertices in counter-clockwise order",
                            "counter-clockwise is with the surface on the left",
                            {Things::vertices, {corners->begin(), corners->end()}});
    } else {
        const double perimeter = 2 * (width + height);
        std::vector<double> parameter(loop.arc.begin(), loop.arc.end() - 1);
        std::vector<double> wanted{0, width, width + height, 2 * width + height};
        for (double& w : wanted) w *= loop.total() / perimeter;
        at = nearest_vertices(parameter, wanted);
        if (at.empty())
            throw Error(Cause::bad_boundary, "the boundary has fewer than four vertices", "refine the mesh");
    }
    at.push_back(loop.size());

    const Complex corner[5] = {0.0, width, Complex(width, height), Complex(0, height), 0.0};
    BoundaryCondition boundary;
    if (placement.speed == BoundarySpeed::arclength) {
        for (std::size_t side = 0; side < 4; ++side)
            for (std::size_t i = at[side]; i < at[side + 1]; ++i) {
                const double t = (loop.arc[i] - loop.arc[at[side]]) / (loop.arc[at[side + 1]] - loop.arc[at[side]]);
                boundary.pin(loop.vertices[i], corner[side] + t * (corner[side + 1] - corner[side]));
            }
        return boundary;
    }
    // The quadrilateral's own conformal rectangle: both coordinates are harmonic, each without flux through two sides.
    std::array<std::vector<int>, 4> sides;
    for (std::size_t side = 0; side < 4; ++side)
        for (std::size_t i = at[side]; i <= at[side + 1]; ++i) sides[side].push_back(loop.vertices[i % loop.size()]);
    const Eigen::VectorXd x = harmonic_between(source, sides[3], sides[1], width);
    const Eigen::VectorXd y = harmonic_between(source, sides[0], sides[2], height);
    for (const int v : loop.vertices) boundary.pin(v, Complex(x[v], y[v]));
    return boundary;
}

BoundaryCondition boundary_to_polygon(const Surface& source, const std::vector<Complex>& polygon,
                                      const BoundaryPlacement& placement) {
    require_simple_polygon(polygon);
    const Loop loop = loop_from(source, placement.loop, placement.start);
    const std::size_t n = polygon.size();

    // The polygon's boundary as points with a parameter in [0,1), and the source's parameters.
    std::vector<Complex> points = polygon;
    std::vector<double> along{0.0}, parameter;
    std::vector<double> corner_parameter{0.0};
    std::vector<Complex> corners{polygon[0]};
    if (placement.speed == BoundarySpeed::arclength) {
        for (std::size_t i = 0; i < n; ++i) along.push_back(along.back() + std::abs(polygon[(i + 1) % n] - polygon[i]));
        const double length = along.back();
        for (double& a : along) a /= length;
        for (std::size_t i = 0; i < loop.size(); ++i) parameter.push_back(loop.arc[i] / loop.total());
    } else {
        const Surface target(inside_of(polygon));
        const Loop around = loop_from(target, 0, 0);  // the polygon's points are the mesh's first vertices
        points.clear();
        for (const int v : around.vertices)
            points.emplace_back(target.mesh.positions(v, 0), target.mesh.positions(v, 1));
        along = conformal_angles(target, around);
        along.push_back(kTurn);
        parameter = conformal_angles(source, loop, placement.shape);
        for (double& a : along) a /= kTurn;
        for (double& t : parameter) t /= kTurn;
    }
    const auto turn = [&](std::size_t i) {
        const std::size_t m = points.size();
        return std::abs(std::arg((points[(i + 1) % m] - points[i]) / (points[i] - points[(i + m - 1) % m])));
    };
    for (std::size_t i = 1; i < points.size(); ++i)
        if (turn(i) > kCornerTurn) {
            corner_parameter.push_back(along[i]);
            corners.push_back(points[i]);
        }
    // Each real corner gets a vertex; in between parameters are stretched linearly, so that vertices keep their order.
    const std::vector<std::size_t> at = nearest_vertices(parameter, corner_parameter);
    if (at.empty())
        throw Error(Cause::bad_boundary,
                    "the polygon has " + std::to_string(corners.size()) + " corners, the boundary only " +
                        std::to_string(loop.size()) + " vertices",
                    "refine the mesh");
    BoundaryCondition boundary;
    std::size_t piece = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        double t = parameter[i];
        while (piece + 1 < at.size() && at[piece + 1] <= i) ++piece;
        const bool last = piece + 1 == at.size();
        const double from = parameter[at[piece]], to = last ? 1.0 : parameter[at[piece + 1]];
        const double image_from = corner_parameter[piece], image_to = last ? 1.0 : corner_parameter[piece + 1];
        t = image_from + (image_to - image_from) * (t - from) / (to - from);
        if (i == at[piece]) {
            boundary.pin(loop.vertices[i], corners[piece]);
            continue;
        }
        const auto next = std::upper_bound(along.begin() + 1, along.end() - 1, t);
        const auto edge = static_cast<std::size_t>(next - along.begin()) - 1;
        const double s = (t - along[edge]) / (along[edge + 1] - along[edge]);
        boundary.pin(loop.vertices[i], points[edge] + s * (points[(edge + 1) % points.size()] - points[edge]));
    }
    return boundary;
}

BoundaryCondition hole_to_circle(const Surface& source, int loop, Complex centre, double radius, double start_angle) {
    require_positive(radius, "circle's radius");
    if (!std::isfinite(std::abs(centre)) || !std::isfinite(start_angle))
        throw Error(Cause::bad_option, "the circle's centre and start angle must be finite");
    const Loop hole = loop_from(source, loop, {});
    BoundaryCondition boundary;
    for (std::size_t i = 0; i < hole.size(); ++i)
        boundary.pin(hole.vertices[i], centre + std::polar(radius, start_angle - kTurn * hole.arc[i] / hole.total()));
    return boundary;
}

}  // namespace beltrami
