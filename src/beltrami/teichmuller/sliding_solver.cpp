#include <beltrami/teichmuller/sliding_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/teichmuller/coarse_sliding_start.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/onto_annulus.h>
#include <beltrami/teichmuller/sliding_record.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 6;
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

/// Marked vertices in the order of the loops.
std::vector<int> marked_vertices(const Surface& source, const std::vector<Mark>& marks) {
    std::vector<int> result;
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop)
            if (std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.vertex == v; }))
                result.push_back(v);
    return result;
}

}  // namespace

PreparedProblem SlidingSolver::prepare(const Surface& source, const Constraints& constraints,
                                       const ExtremalOptions& options) {
    options.validate();
    require_genus_zero(source);
    validate(constraints, source);
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (!options.start_turns.empty() && static_cast<int>(options.start_turns.size()) != loops)
        throw Error(Cause::bad_option, "start turns are given for " + std::to_string(options.start_turns.size()) +
                                           " boundary loops, the source has " + std::to_string(loops));
    return prepared(split_bridges(source));
}

SlidingSolver::SlidingSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options,
                             const TargetModel* target)
    : options_(options),
      prepared_(prepare(source, constraints, options)),
      source_(prepared_.surface_of(source)),
      wanted_(constraints.correspondence),
      target_(target),
      domain_(circle_domain_chart(source_, wanted_.outer_loop)) {
    if (const SurfaceTarget* onto = constraints.surface()) {
        target_surface_ = onto->surface;
        target_circles_ = circle_domain_chart(*onto->surface, onto->outer_loop);
        wanted_ = correspondence_on_circles(wanted_, *onto->surface, *target_circles_);
    }
    marked_ = marked_vertices(source_, wanted_.marks);
    if (!target_) {
        own_target_ = target_surface_
                          ? target_model(circle_target(*target_circles_), 0)
                          : target_model(*constraints.domain(),
                                         edge_length_for(source, *constraints.domain(), options.target_edge_length));
        target_ = own_target_.get();
    }
}

SlidingStart SlidingSolver::start() const {
    if (auto coarse = coarse_sliding_start(source_, domain_, *target_, wanted_, options_)) return std::move(*coarse);
    return sliding_start(source_, domain_, *target_, wanted_, options_.start_turns);
}

void SlidingSolver::begin() {
    if (step_) return;
    SlidingStart start = this->start();
    hold_what_conformal_maps_move(start.loops, wanted_.outer_loop, marked_.size());
    begun_.start = start.map;
    begun_.move = start.move;
    begun_.path = start.path;
    begun_.led = start.led;
    begun_.start_flips = start.flips;
    begun_.expected_dimension =
        dimension_of_differentials(static_cast<int>(domain_.holes.size()), static_cast<int>(marked_.size()));
    begun_.factorizations = domain_.factorizations + target_->factorizations() + start.factorizations;
    if (target_circles_) begun_.factorizations += target_circles_->factorizations;
    curves_ = start.curves;

    boundary_.emplace(source_, start.loops);
    step_.emplace(source_, *boundary_, start.map, kExpectedFactorizations);
    phi_ = admissible_differentials(source_, domain_, options_.space, marked_, begun_.expected_dimension,
                                    &step_->lend_solver());
    begun_.space = phi_.kind;
    begun_.dimension_gap = phi_.gap;
    begun_.warnings = phi_.warnings;
    begun_.dimension = phi_.space ? phi_.space->size() : 0;
    if (phi_.space)
        coefficient_step_.emplace(source_, phi_.chart, Singularities{}, phase_of(domain_, source_), kClusters);
}

ExtremalMap SlidingSolver::solve() {
    if (auto direct = crowded_annulus_onto_ring(source_, *target_, wanted_)) {
        direct->factorizations += domain_.factorizations + target_->factorizations();
        record_warnings(*direct);
        direct->split = prepared_.split;
        if (target_surface_) record_places(*direct);
        return std::move(*direct);
    }
    begin();
    ExtremalMap result = begun_;
    if (coefficient_step_) {
        settle(result);
    } else {
        settle_conformal(result);
    }
    result.factorizations += step_->factorization_count();
    record_loops(result);
    record_warnings(result);
    result.split = prepared_.split;
    if (target_surface_) record_places(result);
    return result;
}

ExtremalSolver::Update SlidingSolver::update(const std::vector<Complex>& images, int max_iterations) {
    if (!images.empty())
        throw Error(Cause::bad_boundary,
                    "there are " + std::to_string(images.size()) + " new images, but nothing is prescribed");
    begin();
    const auto flipped = [&] {
        return static_cast<int>(distortion(source_.operators, step_->derivatives()).flipped.size());
    };
    if (!coefficient_step_) {
        const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source_.operators.sample_count());
        for (int i = 0; i < max_iterations && !(i > 0 && step_->movement() < kSettled); ++i) step_->solve(nu, kSettled);
        return {step_->map(), 0, 0, flipped(), step_->movement() < kSettled};
    }
    HamiltonIteration::Options how = sliding_iteration_options(options_);
    how.max_iterations = max_iterations;
    const HamiltonIteration iteration = iterate(how);
    return {step_->map(), iteration.last_step().k, iteration.history().back().change, flipped(), iteration.converged()};
}

HamiltonIteration SlidingSolver::iterate(const HamiltonIteration::Options& how) {
    HamiltonIteration iteration(*step_, *coefficient_step_, how);
    iteration.run(state_, std::move(phi_.space));
    boundary_->adopt(step_->map());
    return iteration;
}

void SlidingSolver::settle(ExtremalMap& result) {
    const HamiltonIteration iteration = iterate(sliding_iteration_options(options_));
    result.history = iteration.history();
    result.iterations = iteration.iterations();
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;

    // φ and k have settled; so may the boundary.
    CoefficientStep::Result last = iteration.last_step();
    const Eigen::VectorXcd nu = teichmueller_coefficient(last.k, last.phi);
    for (int i = 0; i < kLastSteps && iteration.converged(); ++i) {
        step_->solve(nu, kSettled);
        ++result.iterations;
        if (step_->movement() < kLastMovement) break;
    }
    result.map = step_->map();
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
    last = coefficient_step_->solve(result.distortion.mu, last.direction);
    result.phi = last.phi;
    std::vector<int> poles = marked_;
    std::sort(poles.begin(), poles.end());
    result.differential = {state_.space, std::make_shared<Chart>(phi_.chart), last.direction, std::move(poles), {}};
    record_sliding_bounds(reich_strebel(source_, result.differential, result.distortion.mu), last.k, result);
}

/// No differential is admissible: the extremal map is conformal.
void SlidingSolver::settle_conformal(ExtremalMap& result) {
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source_.operators.sample_count());
    result.termination = Termination::iteration_limit;
    while (result.iterations < kConformalSteps) {
        step_->solve(nu, kSettled);
        ++result.iterations;
        if (step_->movement() < kSettled) {
            result.termination = Termination::converged;
            break;
        }
    }
    result.map = step_->map();
    result.distortion = distortion(source_.operators, result.map);
    result.phi = nu;
    result.K_max = largest_dilatation(result.distortion);
}

void SlidingSolver::record_loops(ExtremalMap& result) const {
    result.loops = loops_onto(source_, *boundary_, curves_, result.map);
    require_not_collapsed(result.loops);
    for (const Mark& mark : wanted_.marks) {
        const CurveParameter& place = on_curve(mark);
        for (const SlidingLoop& sliding : boundary_->loops())
            if (curves_[sliding.loop] == place.curve)
                result.boundary_residual = std::max(
                    result.boundary_residual, std::abs(result.map[mark.vertex] - sliding.curve.point(place.parameter)));
    }
}

void SlidingSolver::record_warnings(ExtremalMap& result) const {
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

/// From the target's circle domain back to its faces.
void SlidingSolver::record_places(ExtremalMap& result) const {
    const std::vector<Complex> images(result.map.begin(), result.map.end());
    result.places = locate_in_chart(*target_surface_, target_circles_->chart.vertices, images);
    result.positions = positions_on(target_surface_->mesh, result.places);
    result.target_circles = target_circles_;
}

}  // namespace beltrami
