#include <beltrami/teichmuller/coarse_sliding_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/base/constants.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/onto_problem.h>
#include <beltrami/teichmuller/sliding_solver.h>

namespace beltrami {

namespace {

/// Below so many vertices the coarse problem would cost as much as it saves.
constexpr int kWorthFrom = 4'000;
/// Triangles of the coarse mesh, not counting what holes ask for; edges around a hole.
constexpr double kTriangles = 2'500;
constexpr int kHoleEdges = 28;
/// Of the coarse mesh; more of them cost as much as the coarse problem itself.
constexpr int kSmoothingPasses = 2;
/// The coarse problem is solved to this.
constexpr double kCoarseTolerance = 1e-4;

Surface coarse_domain(const CircleDomainChart& chart) {
    std::vector<Circle> circles;
    double area = std::numbers::pi;
    for (const RoundHole& hole : chart.holes) {
        circles.push_back({{hole.centre.real(), hole.centre.imag()}, hole.radius});
        area -= std::numbers::pi * hole.radius * hole.radius;
    }
    DomainOptions options;
    options.edge_length = std::sqrt(4 / std::sqrt(3.0) * area / kTriangles);
    options.least_hole_edges = kHoleEdges;
    options.smoothing_passes = kSmoothingPasses;
    return Surface(circle_domain({Eigen::Vector2d::Zero(), 1.0}, circles, options));
}

/// The loop of the coarse mesh that belongs to each loop of the source.
std::vector<int> coarse_loops(const Surface& source, const CircleDomainChart& chart, const Surface& coarse) {
    std::vector<int> result(source.topology.boundary_loops.size(), -1);
    for (std::size_t l = 0; l < result.size(); ++l) {
        const RoundHole circle = chart.circle(static_cast<int>(l));
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < coarse.topology.boundary_loops.size(); ++c) {
            const auto p = coarse.mesh.positions.row(coarse.topology.boundary_loops[c][0]);
            const double off = std::abs(std::abs(Complex(p[0], p[1]) - circle.centre) - circle.radius);
            if (off < least) least = off, result[l] = static_cast<int>(c);
        }
    }
    return result;
}

/// Parameters along a curve by the angle on the circle of the source's domain, linear between coarse vertices.
class ParameterByAngle {
  public:
    ParameterByAngle(const Surface& coarse, int loop, const RoundHole& circle, const std::vector<double>& parameters,
                     double length, bool clockwise)
        : sign_(clockwise ? -1 : 1), length_(length) {
        const auto& vertices = coarse.topology.boundary_loops[loop];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const auto p = coarse.mesh.positions.row(vertices[i]);
            const double turn = sign_ * std::arg(Complex(p[0], p[1]) - circle.centre);
            turns_.push_back(i == 0 ? turn : turns_.back() + ahead(turns_.back(), turn));
        }
        parameters_ = parameters;
    }
    double operator()(double angle) const {
        const double turn = turns_[0] + ahead(turns_[0], sign_ * angle);
        const auto next = std::upper_bound(turns_.begin(), turns_.end(), turn);
        const std::size_t i = static_cast<std::size_t>(next - turns_.begin()) - 1, n = turns_.size();
        const double end_turn = i + 1 < n ? turns_[i + 1] : turns_[0] + kTurn,
                     end = i + 1 < n ? parameters_[i + 1] : parameters_[0] + length_;
        return parameters_[i] + (turn - turns_[i]) / (end_turn - turns_[i]) * (end - parameters_[i]);
    }

  private:
    /// In [0, 2π).
    static double ahead(double from, double to) {
        const double d = std::fmod(to - from, kTurn);
        return d < 0 ? d + kTurn : d;
    }
    double sign_, length_;
    std::vector<double> turns_, parameters_;
};

}  // namespace

std::optional<SlidingStart> coarse_sliding_start(const Surface& source, const CircleDomainChart& chart,
                                                 const TargetModel& target, const Correspondence& wanted,
                                                 const ExtremalOptions& options) {
    if (!options.coarse_start || !wanted.marks.empty() || source.mesh.vertex_count() < kWorthFrom) return {};
    const Surface coarse = coarse_domain(chart);
    if (2 * coarse.mesh.vertex_count() > source.mesh.vertex_count()) return {};
    const std::vector<int> partner = coarse_loops(source, chart, coarse);
    ExtremalOptions own = options;
    own.tolerance = kCoarseTolerance;
    own.progress = {};
    Constraints coarse_onto(target.domain(), wanted);
    coarse_onto.correspondence.outer_loop = partner[wanted.outer_loop];
    for (auto& [loop, curve] : coarse_onto.correspondence.loops)
        if (loop >= 0 && loop < static_cast<int>(partner.size())) loop = partner[loop];
    if (coarse_onto.correspondence.waypoints)
        for (Waypoint& waypoint : *coarse_onto.correspondence.waypoints)
            if (waypoint.loop >= 0 && waypoint.loop < static_cast<int>(partner.size()))
                waypoint.loop = partner[waypoint.loop];
    for (std::size_t l = 0; l < options.start_turns.size(); ++l) own.start_turns[partner[l]] = options.start_turns[l];
    const ExtremalMap solved =
        SlidingSolver(std::make_unique<OntoProblem>(coarse, coarse_onto, own, &target), own).solve();

    SlidingStart result;
    result.move = solved.move;
    result.path = solved.path;
    for (Waypoint& waypoint : result.path)
        waypoint.loop = static_cast<int>(std::find(partner.begin(), partner.end(), waypoint.loop) - partner.begin());
    result.led = solved.led;
    result.flips = solved.start_flips;
    result.map.resize(source.mesh.vertex_count());
    const PlanarLocator locator(coarse.mesh);
    for (Eigen::Index v = 0; v < result.map.size(); ++v)
        result.map[v] = locator.nearest(chart.chart.vertices[v]).interpolate(solved.map);
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const LoopOnto& onto = solved.loops[partner[l]];
        const RoundHole circle = chart.circle(static_cast<int>(l));
        SlidingLoop sliding{static_cast<int>(l), target.domain().curve(onto.curve), {}, {}};
        sliding.held.assign(loops[l].size(), 0);
        const ParameterByAngle parameter(coarse, partner[l], circle, onto.parameters, sliding.curve.length(),
                                         onto.curve != 0);
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const double s = parameter(std::arg(chart.chart.vertices[loops[l][i]] - circle.centre));
            sliding.parameters.push_back(
                i == 0 ? s : sliding.parameters.back() + sliding.curve.ahead(sliding.parameters.back(), s));
            result.map[loops[l][i]] = sliding.curve.point(s);
        }
        result.curves.push_back(onto.curve);
        result.loops.push_back(std::move(sliding));
    }
    return result;
}

}  // namespace beltrami
