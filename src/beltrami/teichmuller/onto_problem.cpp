#include <beltrami/teichmuller/onto_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/teichmuller/coarse_sliding_start.h>
#include <beltrami/teichmuller/sliding_loops.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 6;
/// k, of second order in the direction of φ, settles to this part of the tolerance.
constexpr double kToleranceOfK = 0.01;
/// Newton steps of the boundary after the iteration, each solved to this, until one moves no vertex by more than this
/// part of its curve.
constexpr int kLastSteps = 10;
constexpr double kSettled = 1e-9;
/// … or by so little that what the step has left over is below that: the next one moves them by less than a hundredth.
constexpr double kLastMovement = 1e-7;
/// Newton steps of the boundary where there are no differentials: the map is conformal.
constexpr int kConformalSteps = 100;
/// Points of the c-step on large meshes, and what sharper differences of φ ask for.
constexpr int kClusters = 1500;

/// Rotation of the c-step's grid, tied to the source's shape.
double phase_of(const CircleDomainChart& domain, const Surface& source) {
    for (const RoundHole& hole : domain.holes)
        if (std::abs(hole.centre) > 1e-3) return std::arg(hole.centre);
    return std::arg(domain.chart.vertices[source.topology.boundary_loops[domain.outer_loop()][0]]);
}

/// Marked vertices in the order of the loops.
std::vector<int> marked_vertices(const Surface& source, const std::vector<Mark>& marks) {
    std::vector<int> result;
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop)
            if (std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.vertex == v; }))
                result.push_back(v);
    return result;
}

double worst(const Distortion& measured) {
    return measured.flipped.empty() ? dilatation(measured.max) : std::numeric_limits<double>::infinity();
}

void record_bounds(const ReichStrebel& integrals, double k, ExtremalMapOnto& result) {
    result.K_max = worst(result.distortion);
    result.K = std::min(integrals.valid ? integrals.estimate : dilatation(k), result.K_max);
    result.k = (result.K - 1) / (result.K + 1);
    if (integrals.valid) {
        result.K_lower = std::max(1.0, integrals.lower);
        result.K_upper = integrals.upper;
        // φ is real along circles, the mesh ends at their chords, and μ is not tangential to them: an error of
        // second order that no quadrature sees.
        result.bounds.push_back({"reich_strebel", result.K_lower, Bound::Of::extremal, false});
        result.bounds.push_back({"reich_strebel_estimate", result.K, Bound::Of::extremal, false});
        result.bounds.push_back({"reich_strebel_upper", result.K_upper, Bound::Of::extremal, false});
    }
    if (std::isfinite(result.K_max)) result.bounds.push_back({"attained", result.K_max, Bound::Of::extremal, true});
}

}  // namespace

PreparedProblem OntoProblem::prepare(const Surface& source, const OntoOptions& options) {
    options.validate();
    require_genus_zero(source);
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (options.outer_loop >= loops)
        throw Error(Cause::bad_option, "there is no boundary loop " + std::to_string(options.outer_loop) +
                                           ": the source has " + std::to_string(loops));
    if (!options.start_turns.empty() && static_cast<int>(options.start_turns.size()) != loops)
        throw Error(Cause::bad_option, "start turns are given for " + std::to_string(options.start_turns.size()) +
                                           " boundary loops, the source has " + std::to_string(loops));
    for (const Mark& mark : options.marks)
        if (mark.vertex < 0 || mark.vertex >= source.mesh.vertex_count() || !source.topology.on_boundary[mark.vertex])
            throw Error(Cause::bad_boundary,
                        "the marked vertex " + std::to_string(mark.vertex) + " is not on the boundary of the source",
                        "mark boundary vertices only", {mark.vertex});
    return prepared(split_bridges(source));
}

OntoProblem::OntoProblem(const Surface& source, const OntoOptions& options)
    : options_(options),
      prepared_(prepare(source, options)),
      source_(prepared_.surface_of(source)),
      domain_(circle_domain_chart(source_, options.outer_loop)),
      marked_(marked_vertices(source_, options.marks)) {}

SlidingStart OntoProblem::start(const TargetModel& target) const {
    if (auto coarse = coarse_sliding_start(source_, domain_, target, options_)) return std::move(*coarse);
    return sliding_start(source_, domain_, target, options_);
}

ExtremalMapOnto OntoProblem::solve(const TargetModel& target) {
    SlidingStart start = this->start(target);
    hold_what_conformal_maps_move(start.loops, options_.outer_loop, marked_.size());
    ExtremalMapOnto result;
    result.start = start.map;
    result.move = start.move;
    result.path = start.path;
    result.led = start.led;
    result.start_flips = start.flips;
    result.expected_dimension =
        dimension_of_differentials(static_cast<int>(domain_.holes.size()), static_cast<int>(marked_.size()));
    result.factorizations = domain_.factorizations + target.factorizations() + start.factorizations;

    SlidingBoundary boundary(source_, start.loops);
    SlidingMapStep step(source_, boundary, kExpectedFactorizations);
    OntoDifferentials phi =
        onto_differentials(source_, domain_, options_.space, marked_, result.expected_dimension, &step.lend_solver());
    result.space = phi.kind;
    result.dimension_gap = phi.gap;
    result.warnings = phi.warnings;
    result.dimension = phi.space ? phi.space->size() : 0;
    result.map = start.map;
    if (phi.space) {
        iterate(std::move(phi), boundary, step, result);
    } else {
        settle_conformal(step, result);
    }
    result.factorizations += step.factorization_count();
    record_loops(start.curves, boundary, result);
    record_warnings(result);
    result.split = prepared_.split;
    return result;
}

void OntoProblem::iterate(OntoDifferentials phi, SlidingBoundary& boundary, SlidingMapStep& step,
                          ExtremalMapOnto& result) const {
    CoefficientStep coefficient_step(source_, phi.chart, {}, phase_of(domain_, source_), kClusters);
    HamiltonIteration::Options how;
    how.tolerance = options_.tolerance;
    how.k_tolerance = kToleranceOfK * options_.tolerance;
    how.max_iterations = options_.max_iterations;
    how.anderson_window = options_.anderson_window;
    how.grow_first = how.grow_last = false;
    how.progress = options_.progress;
    HamiltonIteration iteration(source_, step, coefficient_step, how);
    HamiltonState state;
    iteration.run(state, result.map, std::move(phi.space));
    result.map = iteration.map();
    result.history = iteration.history();
    result.iterations = iteration.iterations();
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;
    boundary.adopt(result.map);

    // φ and k have settled; so may the boundary.
    CoefficientStep::Result last = iteration.last_step();
    const Eigen::VectorXcd nu = teichmueller_coefficient(last.k, last.phi);
    for (int i = 0; i < kLastSteps && iteration.converged(); ++i) {
        step.solve(nu, result.map, kSettled);
        ++result.iterations;
        if (step.movement() < kLastMovement) break;
    }
    result.distortion = distortion(source_.operators, result.map);
    if (options_.remove_folds && !result.distortion.flipped.empty()) {
        const FoldFreeMap opened = fold_free_map(source_, dirichlet_freedoms(source_), nu, result.map);
        result.factorizations += opened.factorizations;
        if (opened.fold_free) {
            result.map = opened.map;
            result.folds_removed = true;
            result.distortion = distortion(source_.operators, result.map);
        }
    }
    last = coefficient_step.solve(result.distortion.mu, last.direction);
    result.phi = last.phi;
    record_bounds(reich_strebel(source_, phi.chart, *state.space, last.direction, result.distortion.mu), last.k,
                  result);
}

/// No differential is admissible: the extremal map is conformal.
void OntoProblem::settle_conformal(SlidingMapStep& step, ExtremalMapOnto& result) const {
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source_.operators.sample_count());
    result.termination = Termination::iteration_limit;
    while (result.iterations < kConformalSteps) {
        step.solve(nu, result.map, kSettled);
        ++result.iterations;
        if (step.movement() < kSettled) {
            result.termination = Termination::converged;
            break;
        }
    }
    result.distortion = distortion(source_.operators, result.map);
    result.phi = nu;
    result.K_max = worst(result.distortion);
}

void OntoProblem::record_loops(const std::vector<int>& curves, const SlidingBoundary& boundary,
                               ExtremalMapOnto& result) const {
    result.loops = loops_onto(source_, boundary, curves, result.map);
    require_not_collapsed(result.loops);
    for (const Mark& mark : options_.marks) {
        for (const SlidingLoop& sliding : boundary.loops())
            if (curves[sliding.loop] == mark.curve)
                result.boundary_residual = std::max(
                    result.boundary_residual, std::abs(result.map[mark.vertex] - sliding.curve.point(mark.parameter)));
    }
}

void OntoProblem::record_warnings(ExtremalMapOnto& result) const {
    if (prepared_.split) result.warnings.push_back(prepared_.split_warning("boundary"));
    result.warnings.insert(result.warnings.end(), domain_.chart.warnings.begin(), domain_.chart.warnings.end());
    if (result.dimension != result.expected_dimension)
        result.warnings.push_back("the space of differentials has dimension " + std::to_string(result.dimension) +
                                  ", theory says " + std::to_string(result.expected_dimension));
    if (!result.distortion.flipped.empty())
        result.warnings.push_back("flipped faces in the result: " + std::to_string(result.distortion.flipped.size()) +
                                  "; it is not one-to-one there");
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
}

}  // namespace beltrami
