#include <beltrami/hyperbolic/hyperbolic_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/uniformize/conformal_equivalence.h>

namespace beltrami {

namespace {

constexpr double kTolerance = 1e-11;  // of angle sums, radians
constexpr double kTornFlatness = 1e-6;

/// Lengths from the logarithms of chords 2 sinh(L/2).
std::array<double, 3> lengths_of_chords(const std::array<double, 3>& log_chords) {
    std::array<double, 3> lengths{};
    for (std::size_t k = 0; k < 3; ++k) lengths[k] = 2 * std::asinh(0.5 * std::exp(log_chords[k]));
    return lengths;
}

/// Angles by half-angle formulas; for the cotangents stand tan((α_i + α_j − α_k)/2), which are the cotangents of half
/// the central angles of the circumcircle, as in the plane.
TriangleAngles hyperbolic_angles(const std::array<double, 3>& log_chords) {
    const std::array<double, 3> lengths = lengths_of_chords(log_chords);
    const double half = 0.5 * (lengths[0] + lengths[1] + lengths[2]);
    std::array<double, 3> sines{};
    TriangleAngles result{};
    for (std::size_t k = 0; k < 3; ++k) {
        if (half - lengths[k] <= 0) {
            result.angles[k] = kPi;
            result.degenerate = true;
            return result;
        }
        sines[k] = std::sinh(half - lengths[k]);
    }
    const double of_half = std::sinh(half);
    for (std::size_t k = 0; k < 3; ++k)
        result.angles[k] =
            2 * std::atan2(std::sqrt(sines[(k + 1) % 3] * sines[(k + 2) % 3]), std::sqrt(of_half * sines[k]));
    for (std::size_t k = 0; k < 3; ++k)
        result.cotangents[k] =
            std::tan(0.5 * (result.angles[(k + 1) % 3] + result.angles[(k + 2) % 3] - result.angles[k]));
    return result;
}

/// A triangulation whose scaled lengths are chords 2 sinh(L/2) of the hyperboloid. With these Penner's condition, by
/// which edges are flipped, says that hyperbolic circumcircles are empty, and Ptolemy's relation holds as in the plane.
class ChordSurface final : public ScaledSurface {
  public:
    explicit ChordSurface(IntrinsicTriangulation triangulation) : triangulation_(std::move(triangulation)) {}

    const IntrinsicTriangulation& triangulation() const override { return triangulation_; }
    const std::vector<EdgeFlip>& flips() const { return flips_; }
    int make_delaunay(Eigen::VectorXd& u) override {
        const std::vector<EdgeFlip> flips = triangulation_.delaunay_flips(u);
        flips_.insert(flips_.end(), flips.begin(), flips.end());
        return static_cast<int>(flips.size());
    }
    TriangleAngles angles(int triangle, const Eigen::VectorXd& u) const override {
        return hyperbolic_angles(triangulation_.log_lengths(triangle, u));
    }
    double scale_share(int halfedge, const Eigen::VectorXd& u) const override {
        // tanh(L/2)² of the chord 2 sinh(L/2)
        const double square = 0.25 * std::exp(2 * triangulation_.log_length(halfedge, u));
        return square / (1 + square);
    }

  private:
    IntrinsicTriangulation triangulation_;
    std::vector<EdgeFlip> flips_;
};

void require_hyperbolic(const Topology& t) {
    if (t.components != 1)
        throw Error(Cause::bad_mesh, "the surface has " + std::to_string(t.components) + " components",
                    "take one component at a time");
    const auto loops = static_cast<int>(t.boundary_loops.size());
    if (2 * t.genus + loops < 3)
        throw Error(Cause::bad_mesh,
                    "the surface has genus " + std::to_string(t.genus) +
                        (loops == 0   ? std::string()
                         : loops == 1 ? std::string(" with one boundary loop")
                                      : " with " + std::to_string(loops) + " boundary loops") +
                        ", and no metric of curvature -1",
                    "take one with more handles or holes");
}

double flat_area(const IntrinsicTriangulation& triangulation) {
    double area = 0;
    for (int h = 0; h < triangulation.halfedge_count(); h += 3) {
        const std::array<double, 3> logs{triangulation.log_length(h), triangulation.log_length(h + 1),
                                         triangulation.log_length(h + 2)};
        area += 0.5 * std::exp(logs[1] + logs[2]) * std::sin(triangle_angles(logs).angles[0]);
    }
    return area;
}

ScaleFactorProblem problem_of(const IntrinsicTriangulation& triangulation) {
    ScaleFactorProblem problem;
    problem.tolerance = kTolerance;
    problem.stop_when_degenerate = false;
    const int n = triangulation.vertex_count();
    problem.free.assign(static_cast<std::size_t>(n), 0);
    problem.target_angles = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
    for (int h = 0; h < triangulation.halfedge_count(); ++h) {
        problem.free[static_cast<std::size_t>(triangulation.tail(h))] = 1;
        problem.target_angles[triangulation.tail(h)] = 2 * kPi;
    }
    return problem;
}

/// The direction of every half-edge in the frame of its tail: the first one's is 0, the others follow by the angles
/// between them, counter-clockwise.
std::vector<double> directions(const ChordSurface& surface, const Eigen::VectorXd& u) {
    const IntrinsicTriangulation& triangulation = surface.triangulation();
    std::vector<double> at_tail(static_cast<std::size_t>(triangulation.halfedge_count()));
    for (int t = 0; t < triangulation.triangle_count(); ++t) {
        const TriangleAngles triangle = surface.angles(t, u);
        for (int k = 0; k < 3; ++k) at_tail[3 * t + k] = triangle.angles[(k + 1) % 3];
    }
    std::vector<double> result(at_tail.size(), std::numeric_limits<double>::quiet_NaN());
    for (int first = 0; first < triangulation.halfedge_count(); ++first) {
        if (!std::isnan(result[first])) continue;
        double angle = 0;
        int h = first;
        do {
            result[h] = angle;
            angle += at_tail[h];
            h = triangulation.twin(IntrinsicTriangulation::previous(h));
        } while (h != first);
    }
    return result;
}

std::vector<DiskIsometry> steps_of(const ChordSurface& surface, const Eigen::VectorXd& u) {
    const IntrinsicTriangulation& triangulation = surface.triangulation();
    const std::vector<double> direction = directions(surface, u);
    std::vector<DiskIsometry> steps(direction.size());
    for (int h = 0; h < triangulation.halfedge_count(); ++h) {
        const double length = 2 * std::asinh(0.5 * std::exp(triangulation.log_length(h, u)));
        steps[h] = DiskIsometry::rotation(direction[h]) * DiskIsometry::translation(length) *
                   DiskIsometry::rotation(kPi - direction[triangulation.twin(h)]);
    }
    return steps;
}

/// Steps of a triangulation as they were before its flips: what was a side of the quadrilateral moves back, and the
/// edge that was flipped has the way around the other one.
void steps_before(const std::vector<EdgeFlip>& flips, std::vector<DiskIsometry>& steps) {
    for (auto flip = flips.rbegin(); flip != flips.rend(); ++flip) {
        const int h = flip->halfedge, g = flip->twin;
        const int h1 = IntrinsicTriangulation::next(h), h2 = IntrinsicTriangulation::previous(h);
        const int g1 = IntrinsicTriangulation::next(g), g2 = IntrinsicTriangulation::previous(g);
        const DiskIsometry ki = steps[h1], il = steps[h2], lj = steps[g1], jk = steps[g2];
        steps[h1] = jk;
        steps[h2] = ki;
        steps[g1] = il;
        steps[g2] = lj;
        steps[h] = (il * lj).normalized();
        steps[g] = steps[h].inverse();
    }
}

/// The mirror images of the vertices of a doubled triangulation.
std::vector<int> mirror_of(const IntrinsicTriangulation& triangulation) {
    std::vector<int> mirror(static_cast<std::size_t>(triangulation.vertex_count()));
    for (std::size_t v = 0; v < mirror.size(); ++v) mirror[v] = static_cast<int>(v);  // where there is no triangle
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        mirror[triangulation.tail(h)] =
            triangulation.head(IntrinsicTriangulation::mirrored(h, triangulation.halfedge_count() / 2));
    return mirror;
}

/// Turns the frames of a doubled surface: of boundary vertices along the boundary, of others so that mirror images have
/// mirror images.
void align_with_mirror(HyperbolicSurface& surface) {
    const IntrinsicTriangulation& triangulation = surface.original;
    const int own = triangulation.halfedge_count() / 2;
    const auto on_boundary = [&](int h) { return triangulation.twin(h) == IntrinsicTriangulation::mirrored(h, own); };
    std::vector<double> turns(surface.mirror.size(), 0);
    std::vector<char> known(turns.size(), 0);
    const auto direction = [&](int h) { return std::arg(surface.step(h).direction()); };
    for (int h = 0; h < own; ++h)
        if (on_boundary(h)) {
            turns[triangulation.tail(h)] = direction(h);
            known[triangulation.tail(h)] = 1;
        }
    for (int h = 0; h < own; ++h) {
        const int v = triangulation.tail(h);
        if (known[v]) continue;
        known[v] = 1;
        turns[v] = direction(h);
        turns[surface.mirror[v]] = direction(triangulation.twin(IntrinsicTriangulation::mirrored(h, own)));
    }
    const auto turn = [&](const IntrinsicTriangulation& of, std::vector<DiskIsometry>& steps) {
        for (int h = 0; h < of.halfedge_count(); ++h)
            steps[h] =
                DiskIsometry::rotation(-turns[of.tail(h)]) * steps[h] * DiskIsometry::rotation(turns[of.head(h)]);
    };
    turn(triangulation, surface.steps);
    turn(surface.delaunay, surface.delaunay_steps);
    // But for rounding along the boundary already.
    for (int h = 0; h < own; ++h)
        if (on_boundary(h)) {
            DiskIsometry& step = surface.steps[static_cast<std::size_t>(h)];
            step = DiskIsometry{step.a.real(), step.b.real()}.normalized();
            surface.steps[static_cast<std::size_t>(triangulation.twin(h))] = step.inverse();
        }
}

/// How far steps along mirror images are from mirror images of steps.
double asymmetry(const HyperbolicSurface& surface) {
    const int own = surface.original.halfedge_count() / 2;
    double largest = 0;
    for (int h = 0; h < own; ++h)
        largest = std::max(
            largest,
            (surface.step(h).mirrored() * surface.step(IntrinsicTriangulation::mirrored(h, own))).from_identity());
    return largest;
}

/// Flatness, and the triangles that the flips have left the wrong way round.
void inspect(HyperbolicSurface& surface) {
    for (int t = 0; t < surface.own_triangles(); ++t) {
        const DiskIsometry &ij = surface.step(3 * t), &jk = surface.step(3 * t + 1), &ki = surface.step(3 * t + 2);
        surface.flatness = std::max(surface.flatness, (ij * jk * ki).from_identity());
        const double side = std::imag(std::conj(ij.place()) * ki.inverse().place());
        const int face = surface.metric.faces[static_cast<std::size_t>(t)];
        if (!(side > 0) && (surface.inverted.empty() || surface.inverted.back() != face))
            surface.inverted.push_back(face);
    }
}

}  // namespace

double HyperbolicSurface::area() const {
    double area = 0;
    for (int t = 0; t < delaunay.triangle_count(); ++t) {
        const TriangleAngles triangle = hyperbolic_angles(delaunay.log_lengths(t, log_scale));
        area += kPi - triangle.angles[0] - triangle.angles[1] - triangle.angles[2];
    }
    return area;
}

HyperbolicSurface hyperbolic_surface(const Surface& surface) {
    require_hyperbolic(surface.topology);
    TriangleMetric metric = triangle_metric(surface.mesh, surface.topology,
                                            surface.metric ? *surface.metric : corner_positions(surface.mesh));
    IntrinsicTriangulation original(metric.triangles, surface.mesh.vertex_count(), metric.log_lengths);
    const auto loops = static_cast<int>(surface.topology.boundary_loops.size());
    if (loops > 0) original = original.doubled();
    const int genus = loops > 0 ? 2 * surface.topology.genus + loops - 1 : surface.topology.genus;
    IntrinsicTriangulation unfolded = original;
    std::vector<EdgeFlip> flips = unfolded.delaunay_flips();
    const double area = flat_area(unfolded);
    const ScaleFactorProblem problem = problem_of(unfolded);
    ChordSurface chords(std::move(unfolded));
    // A surface without curvature of its own would have this scale.
    const double start = 0.5 * std::log(4 * kPi * (genus - 1) / area);
    const ScaleFactors found =
        solve_scale_factors(chords, problem, Eigen::VectorXd::Constant(original.vertex_count(), start));
    if (found.status != ScaleFactorStatus::converged && found.status != ScaleFactorStatus::stagnated)
        throw Error(Cause::not_solved,
                    "the hyperbolic metric was not found: angles are off by up to " + std::to_string(found.residual),
                    "remesh the surface, with edges of like length side by side");
    std::vector<DiskIsometry> delaunay_steps = steps_of(chords, found.u), steps = delaunay_steps;
    steps_before(chords.flips(), steps);
    steps_before(flips, steps);
    HyperbolicSurface result{.metric = std::move(metric),
                             .original = std::move(original),
                             .delaunay = chords.triangulation(),
                             .unfolded = std::move(flips),
                             .ptolemy = chords.flips(),
                             .log_scale = found.u,
                             .steps = std::move(steps),
                             .delaunay_steps = std::move(delaunay_steps),
                             .genus = genus,
                             .mirror = {},
                             .iterations = found.iterations,
                             .factorizations = found.factorizations,
                             .residual = found.residual,
                             .flatness = 0,
                             .inverted = {}};
    if (loops > 0) {
        result.mirror = mirror_of(result.original);
        align_with_mirror(result);
    }
    inspect(result);
    if (!(result.flatness < kTornFlatness) || (loops > 0 && !(asymmetry(result) < kTornFlatness)))
        throw Error(Cause::not_solved, "the hyperbolic metric does not hold together along the surface's own edges",
                    "remesh the surface: its triangles are too thin for double precision");
    return result;
}

std::vector<double> boundary_lengths(const HyperbolicSurface& metric, const Topology& topology) {
    std::vector<int> loop_of(static_cast<std::size_t>(metric.original.vertex_count()), -1);
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l)
        for (const int v : topology.boundary_loops[l]) loop_of[v] = static_cast<int>(l);
    std::vector<double> lengths(topology.boundary_loops.size(), 0);
    const int own = 3 * metric.own_triangles();
    for (int h = 0; h < own; ++h)
        if (metric.original.twin(h) >= own) lengths[loop_of[metric.original.tail(h)]] += metric.step(h).distance();
    return lengths;
}

void require_triangles(const Surface& surface) {
    for (int f = 0; f < surface.mesh.face_count(); ++f)
        if (surface.mesh.faces.degree(f) != 3)
            throw Error(Cause::bad_mesh, "face " + std::to_string(f) + " is not a triangle",
                        "cut the faces into triangles", {Things::faces, {f}});
}

}  // namespace beltrami
