#include <beltrami/conformal/flatten.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/conformal/conformal_equivalence.h>
#include <beltrami/conformal/flatten_layout.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostSplitRounds = 40;
constexpr double kSplitAngle = 0.8 * kPi;  // opposite a boundary edge: split it along with those that must be
constexpr double kAngleSumSlack = 1e-6;    // radians, of the sum of prescribed angles
constexpr double kSmallestSlack = 1e-14;   // of a triangle's longest side: below, it has no area
constexpr double kSlackGiven = 1e-10;      // of the mean length

/// The outer loop of a surface that is one disk.
std::vector<int> require_disk(const Mesh& surface) {
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
            "fill the holes or cut the surface into a disk", shape.boundary_loops[1]);
    if (shape.genus != 0)
        throw Error(Cause::bad_mesh, "the surface has genus " + std::to_string(shape.genus),
                    "cut its handles open before flattening");
    for (const int v : surface.faces.vertices())
        if (!surface.point(v).allFinite())
            throw Error(Cause::bad_mesh, "vertex " + std::to_string(v) + " has a coordinate that is not finite",
                        "repair the file", {v});
    return std::move(shape.boundary_loops[0]);
}

/// The quad's diagonal from corner 0 to 2 (true) or from 1 to 3.
bool takes_first_diagonal(const Mesh& surface, std::span<const int> quad) {
    const Eigen::Vector3d p[4] = {surface.point(quad[0]), surface.point(quad[1]), surface.point(quad[2]),
                                  surface.point(quad[3])};
    const auto folds = [&](int i) {  // the diagonal from corner i
        const Eigen::Vector3d d = p[(i + 2) % 4] - p[i];
        return (p[(i + 1) % 4] - p[i]).cross(d).dot(d.cross(p[(i + 3) % 4] - p[i])) < 0;
    };
    const bool first_folds = folds(0), second_folds = folds(1);
    if (first_folds != second_folds) return second_folds;
    return (p[2] - p[0]).squaredNorm() <= (p[3] - p[1]).squaredNorm();
}

FaceList triangles_of(const Mesh& surface) {
    FaceList triangles;
    triangles.reserve(2 * surface.face_count(), 6 * surface.face_count());
    for (int f = 0; f < surface.face_count(); ++f) {
        const std::span<const int> c = surface.faces[f];
        if (c.size() == 3) {
            triangles.add(c);
        } else if (takes_first_diagonal(surface, c)) {
            triangles.add({c[0], c[1], c[2]});
            triangles.add({c[0], c[2], c[3]});
        } else {
            triangles.add({c[1], c[2], c[3]});
            triangles.add({c[1], c[3], c[0]});
        }
    }
    return triangles;
}

/// Edge lengths as logarithms relative to exp(log_unit), so that the size of the surface never matters.
struct Metric {
    std::vector<double> log_lengths;  // per triangle corner
    double log_unit = 0;
    double lengthened = 0;
};

Metric metric_of(const Mesh& surface, const FaceList& triangles) {
    const std::vector<int>& v = triangles.vertices();
    std::vector<double> lengths(v.size());
    double mean = 0, missing = -1;
    const auto length = [&](std::size_t from, std::size_t to) {
        return (surface.point(v[to]) - surface.point(v[from])).stableNorm();
    };
    for (std::size_t c = 0; c < v.size(); c += 3) {
        for (std::size_t k = 0; k < 3; ++k) mean += lengths[c + k] = length(c + k, c + (k + 1) % 3);
    }
    mean /= static_cast<double>(v.size());
    if (!(mean > 0) || !std::isfinite(mean))
        throw Error(Cause::bad_mesh, "the surface has no size", "all vertices of its faces coincide");
    for (std::size_t c = 0; c < v.size(); c += 3) {
        const double a = lengths[c], b = lengths[c + 1], d = lengths[c + 2];
        const double longest = std::max({a, b, d});
        const double slack = (a + b + d) - 2 * longest;
        if (!(slack > kSmallestSlack * longest)) missing = std::max(missing, kSlackGiven * mean - slack);
    }
    Metric metric;
    metric.lengthened = std::max(missing, 0.0);
    metric.log_unit = std::log(mean);
    metric.log_lengths.resize(v.size());
    for (std::size_t c = 0; c < v.size(); ++c)
        metric.log_lengths[c] = std::log((lengths[c] + metric.lengthened) / mean);
    return metric;
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
                        "every interior angle of the image must be", {loop[i]});
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

double signed_area(Complex a, Complex b, Complex c) {
    return std::imag(std::conj(b - a) * (c - a));
}

/// Faces with a corner that is turned over in the image and was not in the source.
std::vector<int> flipped_faces(const Mesh& surface, const Eigen::VectorXcd& image) {
    std::vector<int> flipped;
    for (int f = 0; f < surface.face_count(); ++f) {
        const std::span<const int> c = surface.faces[f];
        const std::size_t n = c.size();
        bool bad = false;
        for (std::size_t i = 0; i < n && !bad; ++i) {
            const int p = c[(i + n - 1) % n], v = c[i], q = c[(i + 1) % n];
            if (signed_area(image[v], image[q], image[p]) > 0) continue;
            const bool reflex = n == 4 && (surface.point(q) - surface.point(v))
                                                  .cross(surface.point(p) - surface.point(v))
                                                  .dot(face_vector_area(surface, f)) <= 0;
            bad = !reflex;
        }
        if (bad) flipped.push_back(f);
    }
    return flipped;
}

/// The surface's own coordinates, if it lies in the plane with all faces turned the same way and no branch points; else
/// empty.
Eigen::VectorXcd own_coordinates(const Mesh& surface, const FaceList& triangles, const IntrinsicTriangulation& metric,
                                 const ScaleFactorProblem& problem, double& residual) {
    if (!is_planar(surface)) return {};
    int positive = 0, negative = 0;
    Eigen::VectorXcd plane = Eigen::VectorXcd::Zero(surface.vertex_count());
    for (const int v : triangles.vertices()) plane[v] = {surface.positions(v, 0), surface.positions(v, 1)};
    for (int t = 0; t < triangles.size(); ++t) {
        const double area = signed_area(plane[triangles[t][0]], plane[triangles[t][1]], plane[triangles[t][2]]);
        positive += area > 0;
        negative += area < 0;
    }
    if (positive > 0 && negative > 0) return {};
    Eigen::VectorXd defect = problem.target_angles;
    const Eigen::VectorXd u = Eigen::VectorXd::Zero(surface.vertex_count());
    for (int t = 0; t < metric.triangle_count(); ++t) {
        const TriangleAngles triangle = metric.angles(t, u);
        for (int k = 0; k < 3; ++k)
            defect[metric.tail(IntrinsicTriangulation::previous(3 * t + k))] -= triangle.angles[k];
    }
    residual = 0;
    for (const double value : defect)
        if (!std::isnan(value)) residual = std::max(residual, std::abs(value));
    if (residual > 1) return {};  // angle sums are multiples of 2π here
    return negative > 0 ? plane.conjugate().eval() : plane;
}

}  // namespace

void FlattenOptions::validate() const {
    if (!(tolerance > 0) || !std::isfinite(tolerance))
        throw Error(Cause::bad_option, "the tolerance of the flattening is not positive", "1e-10 is usual");
    if (max_iterations < 1) throw Error(Cause::bad_option, "the flattening is allowed no iterations", "100 is usual");
}

Flattening flatten(const Mesh& surface, const FlattenOptions& options) {
    options.validate();
    const std::vector<int> loop = require_disk(surface);
    ScaleFactorProblem problem = problem_of(surface, loop, options);
    const FaceList triangles = triangles_of(surface);
    Metric metric = metric_of(surface, triangles);
    IntrinsicTriangulation triangulation(triangles, surface.vertex_count(), std::move(metric.log_lengths));
    Flattening result;

    if (options.boundary_angles.empty()) {
        result.positions = own_coordinates(surface, triangles, triangulation, problem, result.residual);
        if (result.positions.size() > 0) {
            result.log_scale = Eigen::VectorXd::Zero(surface.vertex_count());
            result.flipped = flipped_faces(surface, result.positions);
            return result;
        }
    }

    const double source_boundary = boundary_length(triangulation, Eigen::VectorXd::Zero(surface.vertex_count()));
    result.lengthened = metric.lengthened;
    result.flips = triangulation.make_delaunay();
    ScaleFactors factors = solve(triangulation, problem, options, result);
    const bool solved =
        factors.status == ScaleFactorStatus::converged || factors.status == ScaleFactorStatus::stagnated;
    if (!solved || !factors.degenerate.empty()) refuse(factors, result);

    const Layout layout = lay_out(triangulation, factors.u);
    double log_gauge = 0;
    if (!options.boundary_angles.empty())
        log_gauge = std::log(source_boundary) - std::log(boundary_length(triangulation, factors.u));
    result.layout_error = layout.error;
    result.positions = layout.positions.head(surface.vertex_count()) * std::exp(metric.log_unit + log_gauge);
    result.log_scale = factors.u.head(surface.vertex_count());
    for (const int v : surface.faces.vertices()) problem.free[v] = 2;  // vertices with faces
    for (int v = 0; v < surface.vertex_count(); ++v)
        result.log_scale[v] = problem.free[v] == 2 ? result.log_scale[v] + log_gauge : 0;
    result.flipped = flipped_faces(surface, result.positions);
    return result;
}

}  // namespace beltrami
