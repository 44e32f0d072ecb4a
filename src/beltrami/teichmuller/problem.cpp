#include <beltrami/teichmuller/problem.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/rational_space.h>
#include <beltrami/mesh/boundary_position.h>
#include <beltrami/plane/inside_polygon.h>
#include <beltrami/teichmuller/rim_degree.h>

namespace beltrami {

namespace {

/// Poles cluster towards a corner from this far, on a hole as part of its radius, to this part of an edge.
constexpr double kReach = 1.0, kHoleReach = 0.8, kFinest = 0.4;
/// A corner with fewer edges to the next one is not resolved, and gets no poles.
constexpr int kLeastGap = 6;
/// Samples for every function at a corner: the most significant corners come first.
constexpr int kSamplesPerFunction = 40;

/// A curve of inner constraints is continued outside in its own direction where that is so near to the outward one,
/// over at most this part of the way to the next boundary.
constexpr double kLeastCosine = 0.5, kFreePart = 0.5;
/// A curve held to a line bends sharply where it turns by more than this (radians).
constexpr double kSharpBend = 0.4;

/// Distance from the unit circle of a chart's vertex that lies on it.
constexpr double kRound = 1e-3;
/// The plane of a chart is no metric where it turns over more of itself.
constexpr double kMostUnseen = 1e-4;

/// Whether the chart is that of a round disk.
bool is_round(const Surface& source, const Chart& chart) {
    if (source.topology.boundary_loops.size() != 1) return false;
    const auto& loop = source.topology.boundary_loops[0];
    return std::all_of(loop.begin(), loop.end(),
                       [&](int v) { return std::abs(std::abs(chart.vertices[v]) - 1) < kRound; });
}

/// See ExtremalProblem::phase.
double phase_of(const Chart& chart, const BoundaryCondition& boundary) {
    Complex mean = 0, correlation = 0;
    for (const Complex image : boundary.images) mean += image;
    mean /= static_cast<double>(boundary.images.size());
    for (std::size_t i = 0; i < boundary.images.size(); ++i)
        correlation += chart.vertices[boundary.vertices[i]] * std::conj(boundary.images[i] - mean);
    return std::arg(correlation);
}

/// The domain of a chart, between its loops.
class ChartDomain {
  public:
    ChartDomain(const Surface& source, const Chart& chart) {
        for (const auto& loop : source.topology.boundary_loops) {
            auto& polygon = polygons_.emplace_back();
            for (const int v : loop) polygon.push_back(chart.vertices[v]);
        }
        outer_ = chart.outer_loop;
    }
    /// How far from a boundary vertex at @p from the ray in direction @p along meets the boundary again, at most @p
    /// far.
    double free_way(Complex from, Complex along, double far) const {
        for (const auto& polygon : polygons_)
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                // The edge in the frame of the ray, which is the positive real axis.
                const Complex a = (polygon[i] - from) * std::conj(along),
                              b = (polygon[(i + 1) % polygon.size()] - from) * std::conj(along);
                if (std::abs(a) == 0 || std::abs(b) == 0 || (a.imag() > 0) == (b.imag() > 0)) continue;
                const double at = a.real() - a.imag() * (b.real() - a.real()) / (b.imag() - a.imag());
                if (at > 0) far = std::min(far, at);
            }
        return far;
    }
    bool contains(Complex z) const {
        for (std::size_t l = 0; l < polygons_.size(); ++l)
            if ((winding_number(polygons_[l], z) != 0) != (static_cast<int>(l) == outer_)) return false;
        return true;
    }

  private:
    std::vector<std::vector<Complex>> polygons_;
    int outer_ = 0;
};

}  // namespace

bool can_be_metric(const Surface& source, const Chart& chart) {
    return is_round(source, chart) && unseen_part(source, chart) < kMostUnseen;
}

ExtremalProblem::ExtremalProblem(const Surface& source, const BoundaryCondition& boundary, int expected_factorizations)
    : source_(source),
      boundary_(boundary),
      solver_(source, freedoms(boundary, source), expected_factorizations),
      map_step_(source, solver_) {
    map_step_.prescribe(prescribed_values(boundary, source), line_directions(boundary, source));
    map_step_.solve(Eigen::VectorXcd::Zero(source.operators.sample_count()), 0);
    harmonic_ = map_step_.map();
}

void ExtremalProblem::set_boundary(const BoundaryCondition& boundary) {
    boundary_ = boundary;
    const Eigen::VectorXcd values = prescribed_values(boundary, source_);
    map_step_.prescribe(values, line_directions(boundary, source_));
    harmonic_ = solver_.solve(values);
}

void ExtremalProblem::set_chart(Chart chart) {
    step_in_chart_.reset();
    chart_metric_.reset();
    chart_ = std::move(chart);
    phase_ = phase_of(chart_, boundary_);
}

bool ExtremalProblem::is_disk_in_space() const {
    return !source_.in_plane() && source_.topology.boundary_loops.size() == 1 && boundary_.lines.empty() &&
           boundary_.vertices.size() == source_.topology.boundary_loops[0].size();
}

bool ExtremalProblem::chart_metric_possible() const {
    return is_disk_in_space() && can_be_metric(source_, chart_);
}

double ExtremalProblem::chart_noise(int cluster_count) const {
    return beltrami::chart_noise(source_, chart_, harmonic_, largest_degree(), phase_, cluster_count);
}

void ExtremalProblem::take_chart_metric() {
    chart_metric_ = std::make_unique<ChartMetric>(source_, chart_);
    chart_ = chart_metric_->chart();
    step_in_chart_.emplace(map_step_, *chart_metric_);
}

MapStep& ExtremalProblem::step_in_domain() {
    if (step_in_chart_) return *step_in_chart_;
    return map_step_;
}

bool ExtremalProblem::chart_is_round() const {
    return is_round(source_, chart_);
}

int ExtremalProblem::largest_degree() const {
    const int of_mesh = PolynomialSpace::largest_degree(source_.operators.sample_count(), most_degree_);
    if (!is_round(source_, chart_)) return of_mesh;
    return std::clamp(of_mesh, 1, degree_of_rim(source_, chart_));
}

void ExtremalProblem::set_singularities(Singularities singularities, int cluster_count) {
    set_singularities(std::move(singularities), cluster_count,
                      chart_metric_ ? CoefficientStep::Sums::over_cells : CoefficientStep::Sums::over_samples);
}

void ExtremalProblem::set_singularities(Singularities singularities, int cluster_count, CoefficientStep::Sums sums) {
    singularities_ = std::move(singularities);
    coefficient_step_.emplace(domain(), chart_, singularities_, phase_, cluster_count, sums);
}

QuadraticDifferential ExtremalProblem::differential(std::shared_ptr<const DifferentialSpace> space,
                                                    Eigen::VectorXcd coefficients) const {
    return differential_of(std::move(space), chart_metric_ ? chart_metric_->chart_on_surface() : chart_,
                           std::move(coefficients), singularities_);
}

std::unique_ptr<DifferentialSpace> ExtremalProblem::starting_space(int largest_degree) const {
    if (singularities_.empty()) {
        if (chart_metric_) return std::make_unique<PolynomialSpace>(largest_degree, largest_degree);
        return PolynomialSpace::starting_space(largest_degree);
    }
    const QuadraturePoints& quadrature = coefficient_step_->quadrature();
    RationalSpace::Quadrature of_space{quadrature.points, quadrature.weights};
    return chart_metric_ ? RationalSpace::largest_space(singularities_, std::move(of_space), largest_degree)
                         : RationalSpace::starting_space(singularities_, std::move(of_space), largest_degree);
}

namespace {

/// Where a curve leaves the domain at a boundary vertex: points of its continuation outside, from the vertex on.
std::vector<Complex> continuation(const Surface& source, const Chart& chart, const ChartDomain& domain, int vertex,
                                  Complex before) {
    std::vector<Complex> points;
    const Complex at = chart.vertices[vertex];
    const auto on = boundary_position(source.topology, vertex);
    if (!on) return points;
    const auto& loop = source.topology.boundary_loops[on->loop];
    const std::size_t i = static_cast<std::size_t>(on->position), n = loop.size();
    const Complex along = chart.vertices[loop[(i + 1) % n]] - chart.vertices[loop[(i + n - 1) % n]];
    const double edge = std::abs(at - before);
    if (!(std::abs(along) > 0) || !(edge > 0)) return points;
    Complex direction = (at - before) / edge;
    const Complex outward = Complex(0, -1) * along / std::abs(along);
    if (std::real(direction * std::conj(outward)) < kLeastCosine) direction = outward;
    const double reach = kFreePart * domain.free_way(at, direction, kReach / kFreePart);
    if (domain.contains(at + 0.01 * reach * direction)) return points;
    double distance = 0;
    for (double step = edge; distance + step <= reach; step *= 2) points.push_back(at + (distance += step) * direction);
    return points;
}

/// Appends the curves of inner constraints, and the poles at their ends and elsewhere.
void add_inner(const Surface& source, const Chart& chart, const BoundaryCondition& boundary, const ChartDomain& domain,
               Singularities& result) {
    const Eigen::VectorXcd& z = chart.vertices;
    std::vector<char> pole(source.mesh.vertex_count(), 0);
    for (const int v : boundary.vertices) pole[v] = !source.topology.on_boundary[v];
    std::vector<char> held(source.mesh.vertex_count(), 0);
    for (const auto& line : boundary.lines) held[line.vertex] = 1;
    std::vector<int> bends;
    for (const ConstraintCurve& whole : constraint_curves(boundary, source)) {
        // Parts between sharp bends of what is held to a line: there points cannot slide.
        const bool real = whole.kind == EdgeConstraint::on_line;
        const auto& v = whole.vertices;
        std::vector<std::size_t> ends{0};
        for (std::size_t i = 1; i + 1 < v.size(); ++i) {
            const Complex turn = (z[v[i + 1]] - z[v[i]]) * std::conj(z[v[i]] - z[v[i - 1]]);
            if (real && std::abs(std::arg(turn)) > kSharpBend) {
                ends.push_back(i);
                pole[v[i]] = 1;
                bends.push_back(v[i]);
            } else if (!real) {
                pole[v[i]] = 0;  // the jump takes its part
            }
        }
        ends.push_back(v.size() - 1);
        for (std::size_t part = 1; part < ends.size(); ++part) {
            const std::size_t from = ends[part - 1], to = ends[part];
            Singularities::Curve curve{{}, 0, 0, real, whole.closed() && ends.size() == 2};
            for (std::size_t i = from; i <= to; ++i) curve.points.push_back(z[v[i]]);
            if (!curve.closed) {
                for (const bool last : {true, false}) {
                    const int end = last ? v[to] : v[from];
                    const Complex before = z[last ? v[to - 1] : v[from + 1]];
                    if (source.topology.on_boundary[end]) {
                        std::vector<Complex> outside = continuation(source, chart, domain, end, before);
                        if (last) {
                            curve.points.insert(curve.points.end(), outside.begin(), outside.end());
                        } else {
                            curve.first = static_cast<int>(outside.size());
                            curve.points.insert(curve.points.begin(), outside.rbegin(), outside.rend());
                        }
                    } else if (held[end] && !pole[end]) {
                        const Complex tangent = (z[end] - before) / std::abs(z[end] - before);
                        result.held.push_back({z[end], Complex(0, 1) * std::conj(tangent)});
                    }
                }
            }
            curve.last = curve.first + static_cast<int>(to - from);
            result.curves.push_back(std::move(curve));
        }
    }
    for (const int v : boundary.vertices)
        if (pole[v]) result.pins.push_back(z[v]);
    for (const int v : bends) result.pins.push_back(z[v]);
}

}  // namespace

HeldVertices held_vertices(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                           const Eigen::VectorXcd& map) {
    HeldVertices result;
    if (boundary.lines.empty()) return result;
    std::vector<char> alone(source.mesh.vertex_count(), 0);
    for (const auto& line : boundary.lines) alone[line.vertex] = 1;
    for (const ConstraintCurve& curve : constraint_curves(boundary, source))
        for (const int v : curve.vertices) alone[v] = 0;
    const Eigen::VectorXcd along = line_directions(boundary, source);
    std::vector<Complex> sum(source.mesh.vertex_count(), 0.0);
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto stencil = source.operators.stencil(s);
        if (chart.excluded[s] || std::none_of(stencil.begin(), stencil.end(), [&](int v) { return alone[v]; }))
            continue;
        const auto [f_z, f_zbar] = source.operators.derivatives(s, map);
        const auto [g_z, g_zbar] = source.operators.derivatives(s, chart.vertices);
        const double determinant = std::norm(f_z) - std::norm(f_zbar);
        if (!(determinant > 0)) continue;
        const auto corners = static_cast<int>(stencil.size());
        for (int j = 0; j < corners; ++j) {
            const int v = stencil[j];
            if (!alone[v]) continue;
            const Complex moved = (std::conj(f_z) * along[v] - f_zbar * std::conj(along[v])) / determinant;
            const Complex next = chart.vertices[stencil[(j + 1) % corners]] - chart.vertices[v],
                          last = chart.vertices[stencil[(j + corners - 1) % corners]] - chart.vertices[v];
            sum[v] += std::arg(last * std::conj(next)) * (g_z * moved + g_zbar * std::conj(moved));
        }
    }
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        if (!alone[v]) continue;
        result.vertices.push_back(v);
        result.directions.push_back(std::abs(sum[v]) > 0 ? sum[v] / std::abs(sum[v]) : Complex(1));
    }
    return result;
}

Singularities singularities_of(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                               const std::vector<BoundaryCorner>& corners, const Eigen::VectorXcd& map) {
    Singularities result;
    for (const Chart::Hole& hole : chart.holes)
        result.holes.push_back({hole.centre, hole.radius, powers_of_hole(source, hole.loop)});
    const ChartDomain domain(source, chart);
    add_inner(source, chart, boundary, domain, result);
    const HeldVertices held = held_vertices(source, chart, boundary, map);
    for (std::size_t i = 0; i < held.vertices.size(); ++i)
        result.held.push_back({chart.vertices[held.vertices[i]], Complex(0, 1) * std::conj(held.directions[i])});
    // Equal corners (those of a square) in the order of the boundary, whatever rounding makes of their significance.
    std::vector<BoundaryCorner> ordered = corners;
    const auto rank = [](const BoundaryCorner& c) {
        return std::tuple(-std::round(1e6 * c.significance), c.loop, c.position);
    };
    std::sort(ordered.begin(), ordered.end(),
              [&](const BoundaryCorner& a, const BoundaryCorner& b) { return rank(a) < rank(b); });
    const int budget = source.operators.sample_count() / (kSamplesPerFunction * RationalSpace::corner_poles);
    double least = 0;
    for (const BoundaryCorner& corner : ordered) {
        // Near equals come all or not at all: their significance depends a little on which of them was found first.
        if (static_cast<int>(result.corners.size()) >= budget && corner.significance < 0.9 * least) break;
        least = corner.significance;
        const auto& loop = source.topology.boundary_loops[corner.loop];
        const auto n = static_cast<int>(loop.size());
        const auto at = [&](int position) { return chart.vertices[loop[((position % n) + n) % n]]; };
        // Room until the next corner on either side: beyond, that one's poles do as well.
        double reach = kReach;
        for (const Chart::Hole& hole : chart.holes)
            if (hole.loop == corner.loop) reach = kHoleReach * hole.radius;
        for (const BoundaryCorner& other : corners) {
            if (other.loop != corner.loop || other.position == corner.position) continue;
            reach = std::min(reach, std::abs(at(other.position) - at(corner.position)));
        }
        const Complex vertex = at(corner.position), next = at(corner.position + 1), last = at(corner.position - 1);
        const Complex along = next - last;
        if (edges_to_next_corner(corner, corners, n) < kLeastGap || !(std::abs(along) > 0)) continue;
        // Poles have to lie outside: a ray from a corner can meet the domain again.
        const Complex outward = Complex(0, -1) * along / std::abs(along);
        const auto outside = [&](double distance) { return !domain.contains(vertex + distance * outward); };
        while (reach > std::abs(along) &&
               !(outside(reach) && outside(0.75 * reach) && outside(0.5 * reach) && outside(0.3 * reach)))
            reach *= 0.6;
        const double edge = 0.5 * (std::abs(next - vertex) + std::abs(vertex - last));
        result.corners.push_back({vertex, outward, reach, kFinest * edge});
    }
    return result;
}

}  // namespace beltrami
