#include <beltrami/teichmuller/mixed_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/mixed_space.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/slit_space.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/starts/given_start.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/rim_degree.h>
#include <beltrami/teichmuller/sliding_feasibility.h>

namespace beltrami {

namespace {

/// Degree of the first space. Where the condition changes along a loop about half of all functions of a degree are
/// admissible: twice as many are resolved, and fewer than so many describe nothing.
constexpr int kFirstDegree = 8, kFirstMixedDegree = 12, kLargestMixedDegree = 24, kMixedDegreeOfRim = 2;
/// Powers of J of all slits together, and of one to begin with. Along an edge of length e at the end of a slit of
/// length L J^-n turns by 2n √(e/L): by no more than so many radians, where the mesh is to resolve it.
constexpr int kMostSlitPowers = 60, kFirstSlitPowers = 12;
constexpr double kTurnAtEnd = 2;

/// Boundary vertices that are held, of all loops.
std::vector<int> held_on_boundary(const Surface& source, const MixedBoundary& boundary) {
    std::vector<int> result;
    for (std::size_t l = 0; l < boundary.held.size(); ++l)
        for (std::size_t i = 0; i < boundary.held[l].size(); ++i)
            if (boundary.held[l][i]) result.push_back(source.topology.boundary_loops[l][i]);
    return result;
}

std::vector<int> pins_inside(const Surface& source, const MixedBoundary& boundary) {
    std::vector<int> result;
    for (const int v : boundary.prescribed.vertices)
        if (!source.topology.on_boundary[v]) result.push_back(v);
    return result;
}

/// Vertices at which φ may have simple poles. (Where the condition changes along a loop it has a branch point.)
std::vector<int> poles(const Surface& source, const MixedBoundary& boundary) {
    std::vector<int> result = pins_inside(source, boundary);
    for (const BoundaryCondition::Line& line : boundary.prescribed.lines) result.push_back(line.vertex);
    for (std::size_t l = 0; l < boundary.held.size(); ++l) {
        const std::vector<char>& held = boundary.held[l];
        const std::size_t n = held.size();
        for (std::size_t i = 0; i < n; ++i)
            if (held[i] && !held[(i + 1) % n] && !held[(i + n - 1) % n])
                result.push_back(source.topology.boundary_loops[l][i]);
    }
    std::sort(result.begin(), result.end());
    return result;
}

/// Whether the boundary slides everywhere, marks apart.
bool all_slides(const MixedBoundary& boundary) {
    return std::none_of(boundary.held.begin(), boundary.held.end(), has_arc);
}

/// Powers of J that the edges at the ends of prescribed arcs of the outer circle resolve.
int resolved_powers(const Surface& source, const Chart& chart, const MixedDomain& domain) {
    const auto& loop = source.topology.boundary_loops[chart.outer_loop];
    const auto at = [&](std::size_t i) { return chart.vertices[loop[i % loop.size()]]; };
    double result = std::numeric_limits<double>::infinity();
    for (const MixedDomain::Part& part : domain.loops[0].parts)
        for (const double end : {part.from, part.to}) {
            if (part.slides) continue;
            std::size_t nearest = 0;
            for (std::size_t i = 0; i < loop.size(); ++i)
                if (std::abs(at(i) - std::polar(1.0, end)) < std::abs(at(nearest) - std::polar(1.0, end))) nearest = i;
            const double edge = std::max(std::abs(at(nearest + 1) - at(nearest)),
                                         std::abs(at(nearest + loop.size() - 1) - at(nearest)));
            result = std::min(result, 0.5 * kTurnAtEnd * std::sqrt((part.to - part.from) / edge));
        }
    return static_cast<int>(std::min(result, 1e6));
}

}  // namespace

PreparedProblem prepare_mixed(const Surface& source, const MixedConditions& conditions,
                              const ExtremalOptions& options) {
    options.validate();
    if (options.start) require_values(source, *options.start);
    require_genus_zero(source);
    const auto& loops = source.topology.boundary_loops;
    if (conditions.outer_loop < 0 || conditions.outer_loop >= static_cast<int>(loops.size()))
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(conditions.outer_loop) +
                                           ": the source has " + std::to_string(loops.size()));
    const MixedBoundary boundary = mixed_boundary(source, conditions);
    // Sliding vertices count as prescribed, somewhere outside: edges between them and others on the boundary are
    // bridges, and nothing else about their places matters.
    BoundaryCondition all = boundary.prescribed;
    Complex middle = 0;
    double reach = 1;
    for (const Complex image : all.images) middle += image / static_cast<double>(all.images.size());
    for (const Complex image : all.images) reach = std::max(reach, std::abs(image - middle));
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const double step = 2 * std::numbers::pi / static_cast<double>(loops[l].size());
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            if (!boundary.held[l][i])
                all.pin(loops[l][i],
                        middle + std::polar((4.0 + static_cast<double>(l)) * reach, step * static_cast<double>(i)));
    }
    return prepared(split_prescribed(source, all));
}

AdmissibleDifferentials mixed_differentials(const Surface& source, const CircleDomainChart& domain,
                                            const MixedBoundary& boundary, const Eigen::VectorXcd& start,
                                            std::optional<int> most) {
    AdmissibleDifferentials result;
    result.chart = domain.chart;
    result.grows = true;
    result.poles = poles(source, boundary);
    const std::vector<int> pins = pins_inside(source, boundary);
    const auto& lines = boundary.prescribed.lines;
    if (all_slides(boundary) && lines.empty()) {
        std::vector<int> marked = held_on_boundary(source, boundary);
        result.expected_dimension = dimension_of_differentials(
            static_cast<int>(domain.holes.size()), static_cast<int>(marked.size()), static_cast<int>(pins.size()));
        marked.insert(marked.end(), pins.begin(), pins.end());
        std::optional<RoundDomain> round = round_domain(source, domain.chart, marked);
        if (!round) throw Error(Cause::not_solved, "the chart of the source is not a circle domain");
        result.singularities = round->singularities();
        if (*result.expected_dimension > 0) result.space = std::make_unique<LaurentSpace>(std::move(*round));
        return result;
    }
    std::optional<MixedDomain> straight;
    if (source.in_plane() && domain.outer_loop() == 0) {
        Chart own = plane_chart(source);
        straight = straight_domain(source, own, boundary.held, pins);
        if (straight) result.chart = std::move(own);
    }
    MixedDomain mixed = straight ? std::move(*straight) : mixed_domain(source, domain.chart, boundary.held, pins);
    const Eigen::VectorXcd& z = result.chart.vertices;
    const HeldVertices held = held_vertices(source, result.chart, boundary.prescribed, start);
    for (std::size_t i = 0; i < held.vertices.size(); ++i)
        mixed.held.push_back({z[held.vertices[i]], Complex(0, 1) * std::conj(held.directions[i])});
    for (const ConstraintCurve& curve : constraint_curves(boundary.prescribed, source)) {
        result.warnings.push_back(
            {WarningKind::constraints,
             "vertices " + std::to_string(curve.vertices[0]) + " and " + std::to_string(curve.vertices[1]) +
                 " are neighbours inside, and both are constrained: φ has poles at such vertices, but "
                 "does not jump across the edges between them",
             {Things::vertices, {curve.vertices[0], curve.vertices[1]}}});
        break;
    }
    result.singularities = mixed.singularities();
    std::vector<int> powers;
    powers.reserve(domain.holes.size());
    for (const RoundHole& hole : domain.holes) powers.push_back(powers_of_hole(source, hole.loop));
    int largest = PolynomialSpace::largest_degree(source.operators.sample_count()), first = kFirstDegree;
    if (SlitSpace::describes(mixed) && !most) {
        const auto slits = static_cast<int>(mixed.loops[0].transitions.size()) / 2;
        const int powers_wanted =
            std::max(kFirstSlitPowers, std::min(largest + 2 * largest / slits, kMostSlitPowers / slits));
        // Powers of J vary fastest at the ends: on meshes that are not graded to these the others do better.
        if (powers_wanted <= resolved_powers(source, result.chart, mixed)) {
            result.space = std::make_unique<SlitSpace>(mixed, kFirstSlitPowers, powers_wanted, powers);
            return result;
        }
    }
    if (!mixed.closed()) {
        first = kFirstMixedDegree;
        largest = std::clamp(2 * largest, first, kLargestMixedDegree);
    }
    if (!straight) largest = std::min(largest, kMixedDegreeOfRim * degree_of_rim(source, result.chart));
    if (most) largest = std::min(largest, *most);
    auto space = std::make_unique<MixedSpace>(std::move(mixed), std::min(first, largest), largest, powers);
    if (space->size() > 0) result.space = std::move(space);
    return result;
}

MixedProblem::MixedProblem(const Surface& source, MixedConditions conditions, const ExtremalOptions& options,
                           std::size_t marks, std::optional<int> most)
    : SlidingProblem(source, prepare_mixed(source, conditions, options), conditions.outer_loop,
                     "boundary or prescribed"),
      conditions_(std::move(conditions)),
      marks_(marks),
      most_(most),
      boundary_(mixed_boundary(this->source(), conditions_)) {
    feasible_places(boundary_);
    if (options.start) given_start_ = split() ? with_parents_means(*options.start, split()->parents) : *options.start;
}

/// Where prescribed vertices stand on the loops that slide, if they can.
std::vector<SlidingLoop> MixedProblem::feasible_places(const MixedBoundary& boundary) const {
    std::vector<SlidingLoop> result = places_on_curves(source(), domain(), boundary);
    require_feasible(source(), boundary, result, outer_loop());
    return result;
}

bool MixedProblem::prescribes_arcs() const {
    return !all_slides(boundary_);
}

SlidingStart MixedProblem::start() const {
    SlidingStart result =
        given_start_ ? mixed_start(source(), boundary_, *given_start_) : mixed_start(source(), domain(), boundary_);
    result.curves.resize(boundary_.held.size());  // every loop has one of its own
    std::iota(result.curves.begin(), result.curves.end(), 0);
    SlidingBoundary(source(), result.loops, boundary_.prescribed).place(result.map);
    if (!all_slides(boundary_)) return result;
    const std::size_t held = held_on_boundary(source(), boundary_).size(),
                      inside = pins_inside(source(), boundary_).size();
    hold_what_conformal_maps_move(result.loops, outer_loop(), held + 2 * inside);
    return result;
}

AdmissibleDifferentials MixedProblem::differentials(const Eigen::VectorXcd& start, BeltramiSolver&) const {
    return mixed_differentials(source(), domain(), boundary_, start, most_);
}

std::vector<SlidingLoop> MixedProblem::move(const std::vector<Complex>& images) {
    std::vector<Complex>& now = conditions_.prescribed.images;
    if (images.size() + marks_ != now.size())
        throw Error(Cause::bad_boundary, "there are " + std::to_string(images.size()) + " new images for " +
                                             std::to_string(now.size() - marks_) + " prescribed vertices");
    MixedConditions moved = conditions_;
    std::copy(images.begin(), images.end(), moved.prescribed.images.begin());
    MixedBoundary boundary = mixed_boundary(source(), moved);
    std::vector<SlidingLoop> places = feasible_places(boundary);
    conditions_ = std::move(moved);
    boundary_ = std::move(boundary);
    return places;
}

}  // namespace beltrami
