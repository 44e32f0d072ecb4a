#include <beltrami/uniformize/flatten.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/uniformize/conformal_equivalence.h>
#include <beltrami/uniformize/flatten_layout.h>
#include <beltrami/uniformize/triangle_metric.h>

namespace beltrami {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostSplitRounds = 40;
constexpr double kSplitAngle = 0.8 * kPi;  // opposite a boundary edge: split it along with those that must be
constexpr double kAngleSumSlack = 1e-6;    // radians, of the sum of prescribed angles

Topology require_disk(const Mesh& surface) {
    if (surface.face_count() == 0) throw Error(Cause::bad_mesh, "the mesh has no faces", "flatten needs a surface");
    Topology shape = topology(surface);
    if (shape.components != 1)
        throw Error(Cause::bad_mesh, "the surface has " + std::to_string(shape.components) + " components",
                    "flatten them one at a time");
    if (shape.boundary_loops.empty())
        throw Error(Cause::bad_mesh, "the surface is closed", "cut it open before flattening");
    if (shape.boundary_loops.size() > 1)
        throw Error(
            Cause::bad_mesh,
            "the surface has " + std::to_string(shape.boundary_loops.size()) + " boundary loops and flatten takes one",
            "fill the holes or cut the surface into a disk", {Things::vertices, shape.boundary_loops[1]});
    if (shape.genus != 0)
        throw Error(Cause::bad_mesh, "the surface has genus " + std::to_string(shape.genus),
                    "cut its handles open before flattening");
    return shape;
}

void require_corners(const Mesh& surface, const Positions& corners) {
    if (corners.rows() != surface.faces.corner_count() || (corners.cols() != 2 && corners.cols() != 3))
        throw Error(Cause::bad_mesh,
                    "the metric is a matrix of " + std::to_string(corners.rows()) + " rows and " +
                        std::to_string(corners.cols()) + " columns for " +
                        std::to_string(surface.faces.corner_count()) + " face corners",
                    "give one row a face corner, of two or three coordinates");
    for (int f = 0; f < surface.face_count(); ++f)
        if (!corners.middleRows(surface.faces.first_corner(f), surface.faces.degree(f)).allFinite())
            throw Error(Cause::bad_mesh, "face " + std::to_string(f) + " has a corner whose place is not finite",
                        "repair the positions or the metric", {Things::faces, {f}});
}

/// Angle sums that the iteration has to reach, and which vertices may be scaled.
ScaleFactorProblem problem_of(const Mesh& surface, const std::vector<int>& loop, const FlattenOptions& options) {
    ScaleFactorProblem problem;
    problem.tolerance = options.tolerance;
    problem.target_angles = Eigen::VectorXd::Constant(surface.vertex_count(), kUndefined);
    problem.free.assign(static_cast<std::size_t>(surface.vertex_count()), 0);
    for (const int v : surface.faces.vertices()) {
        problem.target_angles[v] = 2 * kPi;
        problem.free[v] = 1;
    }
    for (const int v : loop) {
        problem.target_angles[v] = kUndefined;
        problem.free[v] = 0;
    }
    const std::vector<double>& angles = options.boundary_angles;
    if (angles.empty()) return problem;

    if (angles.size() != loop.size())
        throw Error(Cause::bad_boundary,
                    std::to_string(angles.size()) + " boundary angles for " + std::to_string(loop.size()) +
                        " boundary vertices",
                    "give one angle per vertex of boundary loop 0");
    const double n = static_cast<double>(loop.size());
    double excess = -(n - 2) * kPi;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!(angles[i] > 0) || !std::isfinite(angles[i]))
            throw Error(Cause::bad_boundary,
                        "the boundary angle at vertex " + std::to_string(loop[i]) + " is not positive",
                        "every interior angle of the image must be", {Things::vertices, {loop[i]}});
        excess += angles[i];
    }
    if (!(std::abs(excess) <= kAngleSumSlack))
        throw Error(Cause::bad_boundary,
                    "the boundary angles sum to " + std::to_string(excess + (n - 2) * kPi) +
                        " and not to (n - 2) pi = " + std::to_string((n - 2) * kPi),
                    "correct them: a polygon with n corners has this sum");
    for (std::size_t i = 0; i < angles.size(); ++i) {
        problem.target_angles[loop[i]] = angles[i] - excess / n;
        problem.free[loop[i]] = i > 0;  // one vertex holds the scale
    }
    return problem;
}

/// The boundary edge that a degenerate triangle lies against: across longest sides, as the triangle beyond the longest
/// side of a degenerate triangle is degenerate too wherever the edge between them is Delaunay.
int boundary_beyond(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& u, int triangle) {
    for (int step = 0; step < triangulation.triangle_count(); ++step) {
        int longest = 3 * triangle;
        for (int h = longest + 1; h < 3 * triangle + 3; ++h)
            if (triangulation.log_length(h, u) > triangulation.log_length(longest, u)) longest = h;
        if (triangulation.twin(longest) < 0) return longest;
        triangle = triangulation.twin(longest) / 3;
    }
    return -1;
}

/// Solves; where boundary triangles degenerate, puts vertices on their boundary edges and solves again.
/// @param triangulation in: the surface, Delaunay; out: Delaunay in the metric found
ScaleFactors solve(IntrinsicTriangulation& triangulation, ScaleFactorProblem& problem, const FlattenOptions& options,
                   Flattening& report) {
    IntrinsicTriangulation surface = triangulation;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(surface.vertex_count());
    for (int round = 0;; ++round) {
        triangulation = surface;
        problem.max_iterations = options.max_iterations - report.iterations;
        ScaleFactors factors = solve_scale_factors(triangulation, problem, std::move(u));
        report.iterations += factors.iterations;
        report.factorizations += factors.factorizations;
        report.flips += factors.flips;
        report.residual = factors.residual;
        u = factors.u;
        if (factors.degenerate.empty() || round == kMostSplitRounds || report.iterations >= options.max_iterations)
            return factors;

        std::vector<char> split(static_cast<std::size_t>(triangulation.vertex_count()), 0);  // by the edge's tail
        for (const int t : factors.degenerate) {
            const int h = boundary_beyond(triangulation, u, t);
            if (h >= 0) split[triangulation.tail(h)] = 1;
        }
        for (int h = 0; h < triangulation.halfedge_count(); ++h)
            if (triangulation.twin(h) < 0 && triangulation.angles(h / 3, u).angles[h % 3] > kSplitAngle)
                split[triangulation.tail(h)] = 1;
        std::vector<int> edges;
        for (int h = 0; h < surface.halfedge_count(); ++h)
            if (surface.twin(h) < 0 && split[surface.tail(h)]) edges.push_back(h);
        if (edges.empty()) return factors;
        const bool natural = options.boundary_angles.empty();
        const Eigen::Index before = u.size(), added = static_cast<Eigen::Index>(edges.size());
        u.conservativeResize(before + added);
        problem.target_angles.conservativeResize(before + added);
        problem.free.resize(static_cast<std::size_t>(before + added), natural ? 0 : 1);
        for (Eigen::Index i = 0; i < added; ++i) {
            const int h = edges[i], tail = surface.tail(h), head = surface.head(h);
            const int v = surface.split_boundary(h);
            u[v] = natural ? 0 : 0.5 * (u[tail] + u[head]);
            problem.target_angles[v] = natural ? kUndefined : kPi;
        }
        report.boundary_splits += static_cast<int>(added);
        report.flips += surface.make_delaunay();
    }
}

[[noreturn]] void refuse(const ScaleFactors& factors, const Flattening& report) {
    if (!factors.degenerate.empty())
        throw Error(Cause::not_solved,
                    std::to_string(factors.degenerate.size()) + " triangles along the boundary stay degenerate after " +
                        std::to_string(report.boundary_splits) + " boundary edges were split",
                    "refine the mesh near its boundary, or choose other boundary angles");
    throw Error(Cause::not_solved,
                "the flattening did not converge: angle defect " + std::to_string(factors.residual) + " after " +
                    std::to_string(report.iterations) + " steps",
                "allow more iterations, or cut the surface where it has to shrink or grow most");
}

double boundary_length(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& u) {
    double length = 0;
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        if (triangulation.twin(h) < 0) length += std::exp(triangulation.log_length(h, u));
    return length;
}

/// Faces with a corner that is turned over in the image and was not in the source.
std::vector<int> flipped_faces(const Mesh& surface, const Positions& corners, const Eigen::VectorXcd& image) {
    const auto reflex = [&](int first, int i) {  // corner i of the quad whose first corner is given
        const auto p = [&](int corner) { return corner_point(corners, first + corner % 4); };
        const Eigen::Vector3d normal = (p(2) - p(0)).cross(p(3) - p(1));
        return (p(i + 1) - p(i)).cross(p(i + 3) - p(i)).dot(normal) <= 0;
    };
    std::vector<int> flipped;
    for (int f = 0; f < surface.face_count(); ++f) {
        const std::span<const int> c = surface.faces[f];
        const int n = static_cast<int>(c.size());
        bool bad = false;
        for (int i = 0; i < n && !bad; ++i) {
            const bool upright = signed_area(image[c[i]], image[c[(i + 1) % n]], image[c[(i + n - 1) % n]]) > 0;
            bad = !upright && !(n == 4 && reflex(surface.faces.first_corner(f), i));
        }
        if (bad) flipped.push_back(f);
    }
    return flipped;
}

/// What flatten() works on.
struct Task {
    const Mesh& surface;
    const Positions& corners;
    const FlattenOptions& options;
    ScaleFactorProblem problem;
    TriangleMetric metric;
    IntrinsicTriangulation triangulation;
};

Task prepare(const Mesh& surface, const Topology& shape, const Positions& corners, const FlattenOptions& options) {
    require_corners(surface, corners);
    ScaleFactorProblem problem = problem_of(surface, shape.boundary_loops[0], options);
    TriangleMetric metric = triangle_metric(surface, shape, corners);
    IntrinsicTriangulation triangulation(metric.triangles, surface.vertex_count(), std::move(metric.log_lengths));
    return {surface, corners, options, std::move(problem), std::move(metric), std::move(triangulation)};
}

/// The surface's own coordinates, if it lies in the plane with all faces turned the same way and no branch points; else
/// empty.
Eigen::VectorXcd own_coordinates(const Task& task, double& residual) {
    if (!is_planar(task.surface)) return {};
    Eigen::VectorXcd plane = planar_coordinates(task.surface);
    const FaceList& triangles = task.metric.triangles;
    std::vector<char> used(static_cast<std::size_t>(plane.size()), 0);
    for (int t = 0; t < triangles.size(); ++t) {
        const std::span<const int> v = triangles[t];
        if (signed_area(plane[v[0]], plane[v[1]], plane[v[2]]) < 0) return {};
        for (const int vertex : v) used[vertex] = 1;
    }
    for (Eigen::Index v = 0; v < plane.size(); ++v)
        if (!used[v]) plane[v] = 0;
    Eigen::VectorXd defect = task.problem.target_angles;
    const Eigen::VectorXd u = Eigen::VectorXd::Zero(plane.size());
    for (int t = 0; t < triangles.size(); ++t) {
        const TriangleAngles triangle = task.triangulation.angles(t, u);
        for (int k = 0; k < 3; ++k)
            defect[task.triangulation.tail(IntrinsicTriangulation::previous(3 * t + k))] -= triangle.angles[k];
    }
    residual = 0;
    for (const double value : defect)
        if (!std::isnan(value)) residual = std::max(residual, std::abs(value));
    if (residual > 1) return {};  // angle sums are multiples of 2π here
    return plane;
}

Flattening run(Task task) {
    const int vertices = task.surface.vertex_count();
    const bool natural = task.options.boundary_angles.empty();
    IntrinsicTriangulation& triangulation = task.triangulation;
    const double source_boundary = boundary_length(triangulation, Eigen::VectorXd::Zero(vertices));
    Flattening result;
    result.lengthened = task.metric.lengthened;
    result.flips = triangulation.make_delaunay();
    const ScaleFactors factors = solve(triangulation, task.problem, task.options, result);
    const bool solved =
        factors.status == ScaleFactorStatus::converged || factors.status == ScaleFactorStatus::stagnated;
    if (!solved || !factors.degenerate.empty()) refuse(factors, result);

    const Layout layout = lay_out(triangulation, factors.u);
    const double log_gauge =
        natural ? 0 : std::log(source_boundary) - std::log(boundary_length(triangulation, factors.u));
    result.layout_error = layout.error;
    result.positions = layout.positions.head(vertices) * std::exp(task.metric.log_unit + log_gauge);
    result.log_scale = Eigen::VectorXd::Zero(vertices);
    for (const int v : task.surface.faces.vertices()) result.log_scale[v] = factors.u[v] + log_gauge;
    result.flipped = flipped_faces(task.surface, task.corners, result.positions);
    return result;
}

}  // namespace

void FlattenOptions::validate() const {
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        throw Error(Cause::bad_option, "the tolerance of the flattening is not positive", "1e-10 is usual");
    if (max_iterations < 1) throw Error(Cause::bad_option, "the flattening is allowed no iterations", "100 is usual");
}

Flattening flatten(const Mesh& surface, const FlattenOptions& options) {
    options.validate();
    const Topology shape = require_disk(surface);
    const Positions corners = corner_positions(surface);
    Task task = prepare(surface, shape, corners, options);
    if (options.boundary_angles.empty()) {
        Flattening result;
        result.positions = own_coordinates(task, result.residual);
        if (result.positions.size() > 0) {
            result.log_scale = Eigen::VectorXd::Zero(surface.vertex_count());
            result.flipped = flipped_faces(surface, corners, result.positions);
            return result;
        }
    }
    return run(std::move(task));
}

Flattening flatten(const Mesh& surface, const Positions& corners, const FlattenOptions& options) {
    options.validate();
    return run(prepare(surface, require_disk(surface), corners, options));
}

}  // namespace beltrami
