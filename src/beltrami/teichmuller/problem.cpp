#include <beltrami/teichmuller/problem.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/rational_space.h>
#include <beltrami/mesh/inside_polygon.h>

namespace beltrami {

namespace {

/// Around a hole, edges for each power of r/(z − c).
constexpr int kEdgesPerPower = 6;
constexpr int kLeastPower = 3, kMostPower = 16;
/// Poles cluster towards a corner from this far, on a hole as part of its radius, to this part of an edge.
constexpr double kReach = 1.0, kHoleReach = 0.8, kFinest = 0.4;
/// A corner with fewer edges to the next one is not resolved, and gets no poles.
constexpr int kLeastGap = 6;
/// Samples for every function at a corner: the most significant corners come first.
constexpr int kSamplesPerFunction = 40;

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

ExtremalProblem::ExtremalProblem(const Surface& source, const BoundaryCondition& boundary, int expected_factorizations)
    : source_(source),
      boundary_(boundary),
      solver_(source, freedoms(boundary, source), expected_factorizations),
      map_step_(solver_) {
    map_step_.prescribe(prescribed_values(boundary, source), line_directions(boundary, source));
    map_step_.solve(Eigen::VectorXcd::Zero(source.operators.sample_count()), harmonic_, 0);
}

void ExtremalProblem::set_chart(Chart chart) {
    chart_ = std::move(chart);
    phase_ = phase_of(chart_, boundary_);
}

void ExtremalProblem::set_singularities(Singularities singularities, int cluster_count) {
    singularities_ = std::move(singularities);
    coefficient_step_.emplace(source_, chart_, singularities_, phase_, cluster_count);
}

std::unique_ptr<DifferentialSpace> ExtremalProblem::starting_space(int largest_degree) const {
    if (singularities_.empty()) return PolynomialSpace::starting_space(largest_degree);
    const SampleClusters& clusters = coefficient_step_->clusters();
    RationalSpace::Quadrature quadrature{clusters.points.positions,
                                         Eigen::VectorXd::Zero(clusters.points.positions.size())};
    for (std::size_t s = 0; s < clusters.cluster.size(); ++s)
        if (clusters.cluster[s] >= 0) quadrature.weights[clusters.cluster[s]] += clusters.squared[s];
    return RationalSpace::starting_space(singularities_, std::move(quadrature), largest_degree);
}

Singularities singularities_of(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                               const std::vector<BoundaryCorner>& corners) {
    Singularities result;
    for (const Chart::Hole& hole : chart.holes) {
        const int edges = static_cast<int>(source.topology.boundary_loops[hole.loop].size());
        result.holes.push_back({hole.centre, hole.radius, std::clamp(edges / kEdgesPerPower, kLeastPower, kMostPower)});
    }
    for (const int v : boundary.vertices)
        if (!source.topology.on_boundary[v]) result.pins.push_back(chart.vertices[v]);
    // Equal corners (those of a square) in the order of the boundary, whatever rounding makes of their significance.
    std::vector<BoundaryCorner> ordered = corners;
    const auto rank = [](const BoundaryCorner& c) {
        return std::tuple(-std::round(1e6 * c.significance), c.loop, c.position);
    };
    std::sort(ordered.begin(), ordered.end(),
              [&](const BoundaryCorner& a, const BoundaryCorner& b) { return rank(a) < rank(b); });
    const ChartDomain domain(source, chart);
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
