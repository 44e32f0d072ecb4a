#include <beltrami/teichmuller/mixed_problem.h>

#include <algorithm>
#include <cmath>
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
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/starts/sliding_start.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/sliding_record.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 8;
/// Newton steps of the boundary after the iteration, each solved to this, until one moves no vertex by more than that
/// part of its curve.
constexpr int kLastSteps = 10;
constexpr double kSettled = 1e-9, kLastMovement = 1e-7;
/// Newton steps of the boundary where there are no differentials.
constexpr int kConformalSteps = 100;
/// Degree of the first space. Where the condition changes along a loop about half of all functions of a degree are
/// admissible: twice as many are resolved, and fewer than so many describe nothing.
constexpr int kFirstDegree = 8, kFirstMixedDegree = 12, kLargestMixedDegree = 24;
/// Around a hole with prescribed values, edges for each power of r/(z − c).
constexpr int kEdgesPerPower = 6;
constexpr int kLeastPower = 3, kMostPower = 16;

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

/// Whether the boundary slides everywhere, marks apart.
bool all_slides(const MixedBoundary& boundary) {
    for (const auto& held : boundary.held)
        for (std::size_t i = 0; i < held.size(); ++i)
            if (held[i] && held[(i + 1) % held.size()]) return false;
    return true;
}

}  // namespace

MixedDifferentials mixed_differentials(const Surface& source, const CircleDomainChart& domain,
                                       const MixedBoundary& boundary, const Eigen::VectorXcd& start) {
    MixedDifferentials result;
    result.chart = domain.chart;
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
        result.warnings.push_back("vertices " + std::to_string(curve.vertices[0]) + " and " +
                                  std::to_string(curve.vertices[1]) +
                                  " are neighbours inside, and both are constrained: φ has poles at such vertices, but "
                                  "does not jump across the edges between them");
        break;
    }
    result.singularities = mixed.singularities();
    std::vector<int> powers;
    for (const RoundHole& hole : domain.holes)
        powers.push_back(std::clamp(static_cast<int>(source.topology.boundary_loops[hole.loop].size()) / kEdgesPerPower,
                                    kLeastPower, kMostPower));
    int largest = PolynomialSpace::largest_degree(source.operators.sample_count()), first = kFirstDegree;
    if (!mixed.closed()) {
        first = kFirstMixedDegree;
        largest = std::clamp(2 * largest, first, kLargestMixedDegree);
    }
    auto space = std::make_unique<MixedSpace>(std::move(mixed), std::min(first, largest), largest, powers);
    if (space->size() > 0) result.space = std::move(space);
    return result;
}

PreparedProblem MixedProblem::prepare(const Surface& source, const MixedConditions& conditions,
                                      const ExtremalOptions& options) {
    options.validate();
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

MixedProblem::MixedProblem(const Surface& source, const MixedConditions& conditions, const ExtremalOptions& options)
    : options_(options),
      outer_loop_(conditions.outer_loop),
      prepared_(prepare(source, conditions, options)),
      source_(prepared_.surface_of(source)),
      boundary_(mixed_boundary(source_, conditions)),
      domain_(circle_domain_chart(source_, outer_loop_)) {}

/// Vertices at which φ may have simple poles. (Where the condition changes along a loop it has a branch point.)
std::vector<int> MixedProblem::poles() const {
    std::vector<int> result = pins_inside(source_, boundary_);
    for (const BoundaryCondition::Line& line : boundary_.prescribed.lines) result.push_back(line.vertex);
    for (std::size_t l = 0; l < boundary_.held.size(); ++l) {
        const std::vector<char>& held = boundary_.held[l];
        const std::size_t n = held.size();
        for (std::size_t i = 0; i < n; ++i)
            if (held[i] && !held[(i + 1) % n] && !held[(i + n - 1) % n])
                result.push_back(source_.topology.boundary_loops[l][i]);
    }
    std::sort(result.begin(), result.end());
    return result;
}

MixedStart MixedProblem::start() const {
    MixedStart result = mixed_start(source_, domain_, boundary_);
    if (!all_slides(boundary_)) return result;
    const std::size_t held = held_on_boundary(source_, boundary_).size(),
                      inside = pins_inside(source_, boundary_).size();
    hold_what_conformal_maps_move(result.loops, outer_loop_, held + 2 * inside);
    return result;
}

MixedExtremalMap MixedProblem::solve() {
    MixedStart start = this->start();
    MixedExtremalMap result;
    result.start = result.map = start.map;
    result.start_flips = start.flips;
    result.start_unfolded = start.unfolded;
    result.factorizations = domain_.factorizations + start.factorizations;
    if (prepared_.split) result.warnings.push_back(prepared_.split_warning("boundary or prescribed"));
    result.warnings.insert(result.warnings.end(), domain_.chart.warnings.begin(), domain_.chart.warnings.end());

    SlidingBoundary boundary(source_, std::move(start.loops), boundary_.prescribed);
    boundary.place(result.map);
    SlidingMapStep step(source_, boundary, result.map, kExpectedFactorizations);
    MixedDifferentials phi = mixed_differentials(source_, domain_, boundary_, result.map);
    result.warnings.insert(result.warnings.end(), phi.warnings.begin(), phi.warnings.end());
    if (phi.space) {
        iterate(std::move(phi), boundary, step, result);
    } else {
        settle_conformal(step, result);
    }
    result.factorizations += step.factorization_count();
    record(boundary, result);
    result.split = prepared_.split;
    return result;
}

void MixedProblem::iterate(MixedDifferentials phi, SlidingBoundary& boundary, SlidingMapStep& step,
                           MixedExtremalMap& result) const {
    CoefficientStep coefficient_step(source_, phi.chart, phi.singularities, phase_of(domain_, source_),
                                     options_.cluster_count);
    HamiltonIteration::Options how = sliding_iteration_options(options_);
    how.growth = options_.growth;
    how.grow_first = how.grow_last = true;
    HamiltonIteration iteration(step, coefficient_step, how);
    HamiltonState state;
    iteration.run(state, std::move(phi.space));
    result.history = iteration.history();
    result.iterations = iteration.iterations();
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;
    boundary.adopt(step.map());

    // φ and k have settled; so may the boundary.
    CoefficientStep::Result last = iteration.last_step();
    const Eigen::VectorXcd nu = teichmueller_coefficient(last.k, last.phi);
    for (int i = 0; i < kLastSteps && iteration.converged(); ++i) {
        step.solve(nu, kSettled);
        ++result.iterations;
        if (step.movement() < kLastMovement) break;
    }
    result.map = step.map();
    remove_folds(boundary, nu, result);
    last = coefficient_step.solve(result.distortion.mu, last.direction);
    result.phi = last.phi;
    result.differential = {state.space, std::make_shared<Chart>(phi.chart), last.direction, poles(), {}};
    result.dimension = state.space->size();
    result.expected_dimension = phi.expected_dimension.value_or(result.dimension);
    if (phi.expected_dimension && result.dimension != *phi.expected_dimension)
        result.warnings.push_back("the space of differentials has dimension " + std::to_string(result.dimension) +
                                  ", theory says " + std::to_string(*phi.expected_dimension));
    if (const auto* space = dynamic_cast<const MixedSpace*>(state.space.get())) {
        result.dimension_gap = space->fit().next / std::max(space->fit().last, 1e-16);
        result.reality = space->fit().residual;
    } else if (const auto* laurent = dynamic_cast<const LaurentSpace*>(state.space.get())) {
        result.dimension_gap = laurent->fit().next / std::max(laurent->fit().residual, 1e-16);
        result.reality = laurent->fit().residual;
    }
    record_sliding_bounds(reich_strebel(source_, result.differential, result.distortion.mu), last.k, result);
}

/// Measures the map, without folds where these can be opened.
void MixedProblem::remove_folds(const SlidingBoundary& boundary, const Eigen::VectorXcd& nu,
                                MixedExtremalMap& result) const {
    result.distortion = distortion(source_.operators, result.map);
    if (!options_.remove_folds || result.distortion.flipped.empty()) return;
    std::vector<Freedom> freedom = boundary.freedoms();
    std::replace(freedom.begin(), freedom.end(), Freedom::sliding, Freedom::fixed);
    const FoldFreeMap opened = fold_free_map(source_, freedom, nu, result.map);
    result.factorizations += opened.factorizations;
    if (!opened.fold_free) return;
    result.map = opened.map;
    result.folds_removed = true;
    result.distortion = distortion(source_.operators, result.map);
}

/// No differential is admissible: the extremal map is conformal.
void MixedProblem::settle_conformal(SlidingMapStep& step, MixedExtremalMap& result) const {
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source_.operators.sample_count());
    result.termination = Termination::iteration_limit;
    while (result.iterations < kConformalSteps) {
        step.solve(nu, kSettled);
        ++result.iterations;
        if (step.movement() < kSettled) {
            result.termination = Termination::converged;
            break;
        }
    }
    result.map = step.map();
    result.distortion = distortion(source_.operators, result.map);
    result.phi = nu;
    result.K_max = largest_dilatation(result.distortion);
}

void MixedProblem::record(const SlidingBoundary& boundary, MixedExtremalMap& result) const {
    const BoundaryCondition& prescribed = boundary_.prescribed;
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i)
        result.boundary_residual =
            std::max(result.boundary_residual, std::abs(result.map[prescribed.vertices[i]] - prescribed.images[i]));
    for (const SlidingLoop& loop : boundary.loops()) {
        const auto& vertices = source_.topology.boundary_loops[loop.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!loop.held[i])
                result.curve_residual = std::max(
                    result.curve_residual, std::abs(result.map[vertices[i]] - loop.curve.point(loop.parameters[i])));
    }
    // Where arcs are prescribed these hold the loop open, and may leave the curve.
    std::vector<int> own(boundary_.held.size());  // every loop has a curve of its own
    std::iota(own.begin(), own.end(), 0);
    result.loops = loops_onto(source_, boundary, own, result.map);
    std::vector<LoopOnto> whole = result.loops;
    std::erase_if(whole, [&](const LoopOnto& loop) {
        const std::vector<char>& held = boundary_.held[loop.loop];
        return std::find(held.begin(), held.end(), 1) != held.end();
    });
    require_not_collapsed(whole);
    if (!result.distortion.flipped.empty())
        result.warnings.push_back("flipped faces in the result: " + std::to_string(result.distortion.flipped.size()) +
                                  "; it is not one-to-one there");
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
}

}  // namespace beltrami
