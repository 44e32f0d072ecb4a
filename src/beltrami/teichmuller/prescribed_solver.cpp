#include <beltrami/teichmuller/prescribed_solver.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/certificate/chart_quadrilateral.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/charts/shape.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/homotopy/twist.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/teichmuller/boundary_slack.h>
#include <beltrami/teichmuller/coarse_start.h>
#include <beltrami/teichmuller/elongation.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/outline.h>
#include <beltrami/teichmuller/quadratic_products.h>
#include <beltrami/teichmuller/record.h>
#include <beltrami/teichmuller/record_proofs.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 8;
/// Where evening out is to be expected, the iteration ends at this change of φ, its square of k, or after so many
/// steps.
constexpr double kRoughTolerance = 0.02;
constexpr int kRoughIterations = 16;
constexpr double kRoughRounding = 0.005, kRoughStep = 0.05;
/// In the plane of a chart the iteration ends once it moves by less than this part of the bracket.
constexpr double kWithinBracket = 0.01;
/// … and with poles, of which φ tells some apart by single edges only: steps cost most there, and it wanders.
constexpr double kWithinBracketAtPoles = 0.03;
/// … and where values crowd, once evening out has not helped: further steps turn φ to and fro at single faces.
constexpr double kWithinBracketOfProducts = 3e-4;
/// An f-step in the plane of a chart is solved to this part of φ's change, a tenth of what the c-step tells apart.
constexpr double kSolveBelowChangeInPlane = 5e-3;
/// Poles that are withheld come as soon as the bracket without them is wider by this factor than it may be.
constexpr double kClearlyWider = 1.1;
/// The bracket of a smooth problem, as part of K, times the number of samples, is smaller (a bump's .7).
constexpr double kTightPerSample = 4;
/// From here on coefficients of faces are too noisy for K even there.
constexpr double kLargeCoefficient = 0.8;
/// Of the map of which K is estimated with other boundary values.
constexpr double kEstimateTolerance = 1e-4;
/// The largest degree of φ where the rim is jagged: chinese_lion, divided once, resolves 68.
constexpr int kMostDegreeInPlane = 80;
/// Poles at held vertices follow the map so often.
constexpr int kMostTurns = 4;
/// Gauss-Newton steps of evening out where bends narrower than an edge are all that is uneven. (Three lobes, 10⁴ and
/// 10⁵ triangles: the spread of |μ| is .0121 and .0039 before, .0117 and .0038 after one step, .0116 and .0038 after
/// three.)
constexpr int kStepsAtBends = 1;
/// Gauss-Newton steps on a scan: where the chart's noise is above this part of k (a face has .015, a bump .002). There
/// the third step costs more than it evens out.
constexpr int kStepsOnScans = 2;
constexpr double kNoiseOfScans = 0.005;
/// Meshes with more faces are fine enough for linear elements, and φ of all of their quadratic ones would fill memory.
constexpr int kMostQuadraticFaces = 20'000;
/// Edges between two corners that are taken at their word.
constexpr int kResolvedEdges = 12;

/// Prescribed vertices of @p map put in their places.
void prescribe(Eigen::VectorXcd& map, const BoundaryCondition& boundary) {
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) map[boundary.vertices[i]] = boundary.images[i];
}

}  // namespace

PrescribedSolver::PrescribedSolver(const Surface& source, const Constraints& constraints,
                                   const ExtremalOptions& options, PreparedProblem prepared,
                                   const std::string& obstacle)
    : options_(options),
      boundary_(constraints.prescribed),
      wanted_(constraints.correspondence),
      prepared_(std::move(prepared)),
      source_(prepared_.surface_of(source)),
      problem_(source_, boundary_, kExpectedFactorizations),
      corners_(find_corners(source_, boundary_)),
      poles_(problem_, boundary_, corners_, options_) {
    if (prepared_.split) warnings_.push_back(prepared_.split_warning("prescribed"));
    ProblemChart charts = chart_of_problem(source_, boundary_, corners_, wanted_.outer_loop, problem_.solver(),
                                           shape_of(source_, options_.shapes));
    other_factorizations_ += charts.chart.factorizations;
    append(warnings_, charts.chart.warnings);
    if (options_.slack > 0) take_slack(charts.chart);
    state_ = poles_.choose(std::move(charts), has_plain_start());
    if (source_.topology.boundary_loops.size() > 1)
        paths_ = loop_paths(source_, problem_.chart().vertices, wanted_.outer_loop);
    choose_start();
    if (!obstacle.empty()) warnings_.push_back({WarningKind::pieces, obstacle});
}

/// Moves the boundary points as far as they may.
void PrescribedSolver::take_slack(const Chart& chart) {
    SlackBoundary slackened = slacken(source_, chart, boundary_, options_.slack);
    slack_ = SlackReport{options_.slack, slackened.largest_move, slackened.energy_before, slackened.energy_after, 1};
    given_boundary_ = std::move(boundary_);
    boundary_ = std::move(slackened.boundary);
    problem_.set_boundary(boundary_);
    corners_ = find_corners(source_, boundary_);
}

bool PrescribedSolver::has_plain_start() const {
    return !options_.start && !wanted_.waypoints && wanted_.turns.empty();
}

void PrescribedSolver::choose_start() {
    Eigen::VectorXcd& map = found_.map;
    map = problem_.harmonic();
    if (options_.start) {
        map = prepared_.split ? with_parents_means(*options_.start, prepared_.split->parents) : *options_.start;
        prescribe(map, boundary_);
    } else if (wanted_.waypoints) {
        const Eigen::VectorXcd* plane = source_.coordinate();
        const Eigen::VectorXcd places = plane && wanted_.outer_loop == 0 ? *plane : problem_.chart().vertices;
        map = follow(source_, Continuation(source_, places, wanted_.outer_loop, boundary_, *wanted_.waypoints)).map;
    } else if (!wanted_.turns.empty()) {
        map = start_in_class(source_, problem_.chart().vertices, wanted_.outer_loop, boundary_, wanted_.turns).map;
    } else if (poles_.smooth() && !poles_.elongated() && !poles_.products() && !state_.space) {
        const bool in_plane = problem_.chart_metric() != nullptr;
        state_ = coarse_start(source_, boundary_, problem_.chart(), problem_.phase(), problem_.largest_degree(),
                              options_, in_plane ? kCoarseStartPaysInPlane : kCoarseStartPays, in_plane)
                     .state;
    }
    start_ = state_.space ? Eigen::VectorXcd() : map;
}

/// Gives up the start that was asked for: a map so folded that the class of μ means nothing leads nowhere.
void PrescribedSolver::start_again() {
    const int folds = folded_samples(beltrami_coefficient(source_.operators, found_.map));
    warnings_.push_back(
        {WarningKind::start, "from the start that was given the iteration ended with " + std::to_string(folds) +
                                 " flipped faces; the map comes from the " +
                                 (wanted_.waypoints || !wanted_.turns.empty() ? "start without it" : "harmonic start") +
                                 ", whose homotopy class may be another"});
    options_.start.reset();
    state_ = {};
    before_evening_.reset();
    earlier_iterations_ += static_cast<int>(history_.size()) - 1;
    history_.clear();
    choose_start();
    run();
}

ExtremalSolver::Update PrescribedSolver::update(const std::vector<Complex>& images, int max_iterations) {
    if (images.size() != boundary_.images.size())
        throw Error(Cause::bad_boundary, "there are " + std::to_string(images.size()) + " new images for " +
                                             std::to_string(boundary_.images.size()) + " prescribed vertices");
    BoundaryCondition moved = boundary_;
    moved.images = images;
    require_feasible(source_, moved, wanted_.outer_loop);
    boundary_ = std::move(moved);
    problem_.map_step().prescribe(prescribed_values(boundary_, source_), line_directions(boundary_, source_));
    HamiltonIteration::Options how = iteration_options(options_);
    how.max_iterations = max_iterations;
    how.grow_first = how.grow_last = false;
    history_.clear();
    state_.acceleration.reset();
    iterate(how);
    const Eigen::VectorXcd mu = beltrami_coefficient(source_.operators, found_.map);
    return {found_.map, found_.step.k, history_.back().change, folded_samples(mu), converged_};
}

ExtremalMap PrescribedSolver::solve() {
    history_.clear();
    earlier_iterations_ = 0;
    run();
    if (options_.start && finish().folded(found_)) start_again();
    compare_outlines();
    ExtremalMap result = record();
    before_evening_.reset();
    return result;
}

/// The iteration from where it stands, and what comes after it.
void PrescribedSolver::run() {
    using Evening = ExtremalOptions::Evening;
    evened_ = false;
    bool settled = false;
    if ((problem_.singular() || poles_.withheld() || poles_.products()) && !problem_.jumps() &&
        options_.evening != Evening::never) {
        iterate_roughly();
        if (converged_ && needs_poles()) return run_with_poles();
        Finish early = finish();
        const int steps = converged_ ? evening_steps(early) : 0;
        evened_ = steps > 0 && even_out(early, steps);
        other_factorizations_ += early.factorizations();
        // In the plane of a chart it has settled within the bracket.
        settled = converged_ && problem_.chart_metric() != nullptr;
    }
    if (!evened_ && !settled) {
        const HamiltonIteration::Options rest = rest_of_iteration();
        if (rest.max_iterations > 0) iterate(rest);
        if (needs_poles()) return run_with_poles();
    }
    if (needs_degree()) raise_degree();
    Finish last = finish();
    if (!evened_)
        evened_ = (options_.evening == Evening::always ||
                   (options_.evening == Evening::where_needed && last.uneven(found_, problem_.singular()))) &&
                  even_out(last, steps_where_uneven());
    folds_removed_ = options_.remove_folds && last.open_folds(found_, boundary_);
    other_factorizations_ += last.factorizations();
    if (evened_ || folds_removed_) last.follow(found_, kFinishingStep);
}

/// From the map found, with the singularities that were withheld.
void PrescribedSolver::run_with_poles() {
    poles_.take_withheld(found_.map);
    state_ = {};
    run();
}

/// With the steps that are left of it.
HamiltonIteration::Options PrescribedSolver::rest_of_iteration() const {
    HamiltonIteration::Options rest = iteration_options(options_);
    rest.max_iterations = std::max(0, rest.max_iterations - std::max(0, static_cast<int>(history_.size()) - 1));
    return rest;
}

/// Whether a jagged rim asks for more of φ than smooth data do: in the plane of a chart, where no poles stand for it.
bool PrescribedSolver::needs_degree() const {
    return problem_.chart_metric() && !problem_.singular() && !poles_.withheld() && converged_ &&
           bracket(found_.step) > PoleChoice::kPolesNeeded;
}

/// From the φ found, with all degrees that mesh and rim resolve, unless they make the bound worse.
void PrescribedSolver::raise_degree() {
    const int smooth = problem_.largest_degree();
    problem_.allow_degree(kMostDegreeInPlane);
    const int degree = problem_.largest_degree();
    const HamiltonIteration::Options rest = rest_of_iteration();
    if (degree == smooth || rest.max_iterations == 0) return;
    const HamiltonState in_smooth = state_;
    FoundMap of_smooth = found_;
    state_.space = problem_.starting_space(degree);
    state_.direction.conservativeResizeLike(Eigen::VectorXcd::Zero(state_.space->size()));
    state_.acceleration.reset();
    iterate_once(rest);
    if (found_.step.merit >= of_smooth.step.merit) return;
    problem_.allow_degree(smooth);
    problem_.coefficient_step().set_space(*in_smooth.space);
    problem_.map_step().set_map(of_smooth.map);
    state_ = in_smooth;
    found_ = std::move(of_smooth);
    converged_ = true;
}

/// Evening out moves φ more than the last digits of the iteration do. In the plane of a chart folds alone ask for it.
void PrescribedSolver::iterate_roughly() {
    HamiltonIteration::Options rough = iteration_options(options_);
    if (!problem_.chart_metric()) {
        rough.tolerance = std::max(rough.tolerance, kRoughTolerance);
        rough.k_tolerance = std::max(rough.k_tolerance, kRoughTolerance * kRoughTolerance);
    }
    rough.max_iterations = std::min(rough.max_iterations, kRoughIterations);
    rough.step_below_change = kRoughStep;
    rough.grow_last = false;
    problem_.coefficient_step().set_least_rounding(kRoughRounding);
    iterate(rough);
    problem_.coefficient_step().set_least_rounding(0);
}

/// Runs the iteration, with poles that follow the map at vertices held to lines one by one.
void PrescribedSolver::iterate(const HamiltonIteration::Options& how) {
    iterate_once(how);
    for (int turn = 0; turn < kMostTurns && poles_.follow(found_.map); ++turn) {
        state_ = {};
        iterate_once(how);
    }
}

/// Runs the iteration from where it stands.
void PrescribedSolver::iterate_once(const HamiltonIteration::Options& how) {
    problem_.map_step().set_near(state_.space && problem_.solver().factorization_count() > 1);
    problem_.map_step().set_map(found_.map);
    HamiltonIteration iteration(problem_.step_in_domain(), problem_.coefficient_step(), adapted(how));
    // Only a run from nothing needs a space to begin with, and its basis is costly.
    iteration.run(state_, state_.space ? nullptr : first_space());
    found_ = {problem_.map_step().map(), iteration.last_step()};
    converged_ = iteration.converged();
    // A run that goes on begins with where the last one ended.
    const auto& steps = iteration.history();
    history_.insert(history_.end(), steps.begin() + (history_.empty() ? 0 : 1), steps.end());
}

/// The options as they are for the singularities and in the metric of the iteration.
HamiltonIteration::Options PrescribedSolver::adapted(HamiltonIteration::Options how) const {
    if (poles_.smooth()) adapt_to_smooth(options_, how);
    if (problem_.chart_metric()) {
        how.within_bracket = problem_.singular() ? kWithinBracketAtPoles : kWithinBracket;
        how.solve_below_change = kSolveBelowChangeInPlane;
        how.tight = kTightPerSample / source_.operators.sample_count();
    }
    if (poles_.withheld()) how.widest = kClearlyWider * poles_.widest_bracket();
    if (poles_.products()) how.within_bracket = kWithinBracketOfProducts;
    return how;
}

std::unique_ptr<DifferentialSpace> PrescribedSolver::first_space() const {
    if (poles_.products()) return std::make_unique<TabulatedSpace>(*poles_.products());
    if (poles_.elongated()) return harmonic_square_space(source_, problem_.chart(), problem_.harmonic());
    return problem_.starting_space(problem_.largest_degree());
}

/// Whether singularities that were thought needless are needed after all.
bool PrescribedSolver::needs_poles() const {
    return poles_.needed(bracket(found_.step));
}

Finish PrescribedSolver::finish() {
    return {source_, problem_.chart_metric(), problem_.coefficient_step(), freedoms(boundary_, source_)};
}

/// Gauss-Newton steps that evening out the map is worth.
int PrescribedSolver::evening_steps(const Finish& finish) const {
    if (finish.uneven(found_, problem_.singular())) return steps_where_uneven();
    return poles_.narrow_bends() ? kStepsAtBends : 0;
}

int PrescribedSolver::steps_where_uneven() const {
    return poles_.noise() > kNoiseOfScans ? kStepsOnScans : kEveningSteps;
}

bool PrescribedSolver::even_out(Finish& finish, int steps) {
    if (!finish.folded(found_)) before_evening_ = found_;
    return finish.even_out(found_, steps);
}

/// K of other boundary values, by one f-step with the φ and k at hand and one c-step.
double PrescribedSolver::estimate_with(const BoundaryCondition& other) {
    FoundMap moved = found_;
    prescribe(moved.map, other);
    moved.map = problem_.solver().solve_near(
        problem_.coefficient_on_source(problem_.coefficient_step().coefficient(moved.step.k, moved.step.phi)),
        moved.map, moved.map, kEstimateTolerance);
    finish().follow(moved, kFinishingStep, kFinishingSteps);
    return dilatation(moved.step.k);
}

/// What the noise of the outline costs, or what slack has gained.
void PrescribedSolver::compare_outlines() {
    noise_.reset();
    if (slack_) {
        slack_->K_without = estimate_with(given_boundary_);
    } else if (problem_.is_disk_in_space()) {
        noise_ = noise_of_outline(source_, problem_.chart(), boundary_,
                                  [this](const BoundaryCondition& other) { return estimate_with(other); });
    }
}

/// Everything that is measured on the final map, with φ of the last c-step.
ExtremalMap PrescribedSolver::record() const {
    ExtremalMap result;
    result.map = found_.map;
    result.harmonic = problem_.harmonic();
    result.start = start_;
    result.history = history_;
    result.warnings = warnings_;
    result.iterations = earlier_iterations_ + static_cast<int>(history_.size()) - 1;
    result.evened = evened_;
    result.folds_removed = folds_removed_;
    result.factorizations = other_factorizations_ + problem_.solver().factorization_count();
    result.termination = converged_ ? Termination::converged : Termination::iteration_limit;
    result.split = prepared_.split;
    result.slack = slack_;
    result.noise = noise_;
    record_homotopy(result);
    result.distortion = distortion(source_.operators, found_.map);
    result.differential = problem_.differential(state_.space, found_.step.direction);
    result.phi = problem_.differential_on_source(found_.step.phi);
    record_residual(boundary_, result);
    record_bounds(result);
    record_corners(result);
    result.bounds.push_back(
        {Bound::Kind::mesh_harmonic, mesh_harmonic_bound(source_.operators, result.harmonic), Bound::Of::mesh, true});
    record_attained(source_, result.map, result);
    record_shortcomings(result);
    // Where values crowd, what φ shows is the least of what is known.
    ExtremalOptions how = options_;
    if (poles_.products() && !how.prove) how.prove = true;
    add_proofs(source_, boundary_, how, result);
    if (poles_.products() && *how.prove) add_finer_pair(source_, boundary_, largest_known(result), result);
    if (poles_.products()) narrow_by_quadratic_elements(result);
    raise_to_proofs(result);
    withdraw_unconfirmed(result);
    return result;
}

/// @throw Error not_solved if the turns that were wanted are lost
void PrescribedSolver::record_homotopy(ExtremalMap& result) const {
    if (paths_.empty()) return;
    result.homotopy = homotopy_class(source_, paths_, found_.map, wanted_.outer_loop);
    if (wanted_.turns.empty()) return;
    for (const HoleTurns& hole : result.homotopy.holes)
        if (hole.turns != wanted_.turns[hole.loop])
            throw Error(Cause::not_solved,
                        "the hole of loop " + std::to_string(hole.loop) +
                            " has lost its turns: " + std::to_string(wanted_.turns[hole.loop]) +
                            " were wanted, the map has " + std::to_string(hole.turns),
                        "the mesh is too coarse to hold them: refine it, or ask for fewer",
                        {Things::loops, {hole.loop}});
}

void PrescribedSolver::record_bounds(ExtremalMap& result) const {
    std::optional<Distortion> in_chart;
    if (const ChartMetric* metric = problem_.chart_metric()) {
        in_chart = distortion(metric->plane().operators, found_.map);
        result.in_chart =
            InChart{metric->chart_mean(), in_chart->mean, in_chart->standard_deviation, problem_.largest_degree()};
    }
    const SolutionBounds bounds = best_bounds(in_chart ? *in_chart : result.distortion);
    result.bounds = bounds.bounds;
    if (problem_.chart_metric() || poles_.products()) record_quadrilaterals(result);
    result.K = std::min(bounds.K, result.distortion.K_max());
    result.k = k_of(result.K);
    result.K_lower = bounds.K_lower;
    result.factorizations += bounds.factorizations;
}

/// What quadrilaterals of the rim force in the chart.
void PrescribedSolver::record_quadrilaterals(ExtremalMap& result) const {
    std::vector<Complex> images;
    for (const int v : source_.topology.boundary_loops[0]) images.push_back(found_.map[v]);
    const double K = chart_quadrilateral_estimate(source_, problem_.chart(), images);
    if (K > 1) result.bounds.push_back({Bound::Kind::moduli, K, Bound::Of::extremal, false});
}

/// Where values crowd and the bracket is open, or K is below what is proved: the iteration goes on with quadratic
/// elements, whose K, bound and φ are taken where they show the extremal map better. The map stays.
void PrescribedSolver::narrow_by_quadratic_elements(ExtremalMap& result) const {
    const double known = largest_known(result);
    const bool below = clearly_below(result.K, known);
    const bool open = below || result.K > (1 + PoleChoice::kPolesNeeded) * known;
    const bool can = all_triangles(source_.mesh) && source_.mesh.face_count() <= kMostQuadraticFaces;
    if (!open || !can || options_.sharpen.value_or(0) < 0) return;
    QuadraticProductsOptions how;
    const int before = result.iterations;
    if (options_.progress)
        how.progress = [this, before](int step, double k) { return options_.progress(before + step, k); };
    // What evening has done to φ is of no use to them.
    const FoundMap& start = before_evening_ ? *before_evening_ : found_;
    const QuadraticProducts quadratic =
        quadratic_products(source_, boundary_, problem_.harmonic(), start.step.phi, start.step.k, how);
    result.factorizations += quadratic.factorizations;
    result.iterations += static_cast<int>(quadratic.history.size());
    result.history.insert(result.history.end(), quadratic.history.begin(), quadratic.history.end());
    const ReichStrebel& found = quadratic.integrals;
    if (!found.valid || !quadratic.settled || clearly_below(found.estimate, known)) return;
    const double K = std::min(found.estimate, result.distortion.K_max());
    const double narrow = std::max(K, known) / std::max(found.lower, known);
    if (!below && !(narrow < result.K / known)) return;
    std::erase_if(result.bounds, [](const Bound& bound) {
        return bound.kind == Bound::Kind::reich_strebel || bound.kind == Bound::Kind::reich_strebel_estimate;
    });
    result.bounds.push_back({Bound::Kind::reich_strebel, found.lower, Bound::Of::extremal, false});
    result.bounds.push_back({Bound::Kind::reich_strebel_estimate, found.estimate, Bound::Of::extremal, false});
    result.K_lower = std::max(1.0, found.lower);
    result.K = std::max(K, result.K_lower);
    result.k = k_of(result.K);
    result.differential = problem_.differential(quadratic.space, quadratic.direction);
    result.phi = quadratic.phi;
}

/// @param of_found in the metric of the iteration
SolutionBounds PrescribedSolver::best_bounds(const Distortion& of_found) const {
    const Surface& domain = problem_.domain();
    const MeasuredMap best = better_for_bounds(found_, before_evening_, [&](const FoundMap& found) {
        MeasuredMap measured{found, &found == &found_ ? of_found : distortion(domain.operators, found.map), {}};
        measured.integrals =
            reich_strebel(domain, problem_.chart(), *state_.space, found.step.direction, measured.distortion.mu);
        return measured;
    });
    const auto& [map, step] = best.found;
    return solution_bounds(
        {domain, boundary_, problem_.chart(), *state_.space, step.direction, step.phi, step.k, map, best.distortion,
         best.integrals, paths_, wanted_.outer_loop, wanted_.turns},
        problem_.chart_metric() && !options_.sharpen && step.k < kLargeCoefficient ? -1 : options_.sharpen);
}

/// Corners of the boundary values, and what they force.
void PrescribedSolver::record_corners(ExtremalMap& result) const {
    result.corners = corners_;
    for (const BoundaryCorner& corner : corners_)
        // An infinite bound is that of an angle measured as none: no smooth data have it.
        if (corner.safe_bound > 1 && std::isfinite(corner.safe_bound) && resolved(corner) &&
            (!result.sharpest || corner.safe_bound > result.sharpest->safe_bound))
            result.sharpest = corner;
    if (!result.sharpest) return;
    result.bounds.push_back({Bound::Kind::corner, result.sharpest->safe_bound, Bound::Of::extremal, false});
    // Where the bracket is closed, the corner is one of the mesh's outline and not of the problem.
    const double K_max = result.distortion.K_max();
    const bool proved = std::isfinite(K_max) && !corner_decides({.safe_bound = K_max}, result.K_lower);
    if (converged_ && !proved && corner_decides(*result.sharpest, result.K)) {
        result.termination = Termination::not_teichmuller;
        result.warnings.push_back(corner_warning(*result.sharpest));
    }
}

/// Whether enough edges run from a corner to the next ones of its loop for its angles and speeds to mean something:
/// between teeth and in notches of a few edges they do not.
bool PrescribedSolver::resolved(const BoundaryCorner& corner) const {
    const int n = static_cast<int>(source_.topology.boundary_loops[corner.loop].size());
    for (const BoundaryCorner& other : corners_) {
        const int apart = std::abs(other.position - corner.position);
        if (other.loop == corner.loop && apart > 0 && std::min(apart, n - apart) < kResolvedEdges) return false;
    }
    return true;
}

}  // namespace beltrami
