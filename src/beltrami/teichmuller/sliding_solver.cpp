#include <beltrami/teichmuller/sliding_solver.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/record.h>
#include <beltrami/teichmuller/record_proofs.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Where spaces grow φ goes on settling while k stays: on fine meshes by half a step, and the map with it.
constexpr int kQuietSteps = 20;
/// How many solves the system is ordered for.
constexpr int kExpectedSlidingFactorizations = 8;
/// Newton steps of the boundary after the iteration, each solved to this part of the map, …
constexpr int kLastSteps = 10;
constexpr double kSettledSliding = 1e-9;
/// … until one moves no vertex by more than this part of its curve: what the step has left over is below that, and the
/// next one moves them by less than a hundredth.
constexpr double kLastMovement = 1e-7;
/// Newton steps of the boundary where there are no differentials.
constexpr int kConformalSteps = 100;

/// Whether a map has fewer folds than another, or as many and has settled while the other has not.
bool better_end(const ExtremalMap& a, const ExtremalMap& b) {
    const std::size_t folds = a.distortion.flipped.size(), others = b.distortion.flipped.size();
    if (folds != others) return folds < others;
    return a.termination == Termination::converged && b.termination != Termination::converged;
}

/// Vertices that slide stay where they are.
std::vector<Freedom> fixed_or_free(std::vector<Freedom> freedoms) {
    for (Freedom& freedom : freedoms)
        if (freedom != Freedom::free) freedom = Freedom::fixed;
    return freedoms;
}

/// Puts the places of a loop's vertices on its curve where a map has them; whether these ascend.
bool go_round(const std::vector<int>& vertices, const Eigen::VectorXcd& map, SlidingLoop& loop) {
    const double length = loop.curve.length();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double at = loop.curve.nearest(map[vertices[i]]);
        if (i == 0) {
            loop.parameters[0] = at;
            continue;
        }
        const double step = std::remainder(at - loop.parameters[i - 1], length);
        if (!(step > 0)) return false;
        loop.parameters[i] = loop.parameters[i - 1] + step;
    }
    return loop.parameters.back() < loop.parameters[0] + length;
}

/// Whether an arc of a loop is prescribed, not only single vertices.
bool has_prescribed_arc(const std::vector<int>& loop, const std::vector<char>& is_prescribed) {
    for (std::size_t i = 0; i < loop.size(); ++i)
        if (is_prescribed[loop[i]] && is_prescribed[loop[(i + 1) % loop.size()]]) return true;
    return false;
}

}  // namespace

SlidingSolver::SlidingSolver(std::unique_ptr<SlidingProblem> problem, const ExtremalOptions& options)
    : options_(options), problem_(std::move(problem)) {}

void SlidingSolver::begin() {
    if (begun()) return;
    SlidingStart start = problem_->start();
    curves_ = std::move(start.curves);
    begun_ = {};
    begun_.start = start.map;
    begun_.move = start.move;
    begun_.path = std::move(start.path);
    begun_.led = start.led;
    begun_.start_flips = start.flips;
    begun_.start_unfolded = start.unfolded;
    begun_.factorizations = problem_->factorizations() + start.factorizations;
    begun_.warnings = problem_->warnings();

    boundary_.emplace(source(), std::move(start.loops), problem_->prescribed());
    step_.emplace(source(), *boundary_, std::move(start.map), kExpectedSlidingFactorizations);
    phi_ = problem_->differentials(begun_.start, step_->lend_solver());
    begun_.space = phi_.kind;
    begun_.dimension_gap = phi_.gap;
    append(begun_.warnings, phi_.warnings);
    chart_ = std::make_shared<Chart>(std::move(phi_.chart));
    if (phi_.space)
        coefficient_step_.emplace(source(), *chart_, phi_.singularities, problem_->phase(), options_.cluster_count);
}

ExtremalMap SlidingSolver::solve() {
    ExtremalMap result;
    if (std::optional<ExtremalMap> direct = problem_->direct()) {
        result = std::move(*direct);
        result.factorizations += problem_->factorizations();
        result.warnings = problem_->warnings();
    } else {
        result = settled_or_instead();
    }
    record_shortcomings(result);
    warn_of_crushed_faces(result);
    result.split = problem_->split();
    problem_->record(result);
    withdraw_unconfirmed(result);
    return result;
}

/// By the iteration, or where that has no start or ends folded by what the problem has instead.
ExtremalMap SlidingSolver::settled_or_instead() {
    std::optional<ExtremalMap> iterated;
    std::string end;
    try {
        iterated = problem_->has_given_start() ? settled_from_given_start() : settled();
        problem_->prove(*iterated);
        const std::size_t flips = iterated->distortion.flipped.size();
        if (flips == 0) return std::move(*iterated);
        end = "ended with " + std::to_string(flips) + " flipped faces";
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
        std::optional<ExtremalMap> instead = problem_->instead();
        if (!instead) throw;
        return described(std::move(*instead), std::string("failed (") + error.what() + ")");
    }
    if (std::optional<ExtremalMap> instead = problem_->instead()) return described(std::move(*instead), end);
    return std::move(*iterated);
}

/// A map that takes the place of an iteration that has come to nothing.
ExtremalMap SlidingSolver::described(ExtremalMap instead, const std::string& end) const {
    instead.factorizations += problem_->factorizations();
    instead.warnings = problem_->warnings();
    instead.warnings.push_back(
        {WarningKind::fallback, "the iteration " + end + "; the map is affine in the potentials of the ring"});
    return instead;
}

/// Start, iteration, finish.
ExtremalMap SlidingSolver::settled() {
    begin();
    ExtremalMap result = begun_;
    if (coefficient_step_) {
        finish(settle(result), result);
    } else {
        solve_conformal(result);
    }
    result.factorizations += step_->factorization_count();
    record_conditions(result);
    return result;
}

/// The same from the start that was given, or, where that leads nowhere, without it.
ExtremalMap SlidingSolver::settled_from_given_start() {
    std::optional<ExtremalMap> first;
    std::string end = "did not settle";
    try {
        first = settled();
        const std::size_t folds = first->distortion.flipped.size();
        if (folds == 0 && first->termination == Termination::converged) return std::move(*first);
        if (folds > 0) end = "ended with " + std::to_string(folds) + " flipped faces";
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
        end = std::string("failed (") + error.what() + ")";
    }
    begin_without_start();
    ExtremalMap second = settled();
    if (first) {
        const bool second_is_kept = better_end(second, *first);
        ExtremalMap& kept = second_is_kept ? second : *first;
        const ExtremalMap& other = second_is_kept ? *first : second;
        kept.iterations += other.iterations;
        kept.factorizations += other.factorizations;
        if (!second_is_kept) return kept;
    }
    second.warnings.push_back(
        {WarningKind::start, "from the start that was given the iteration " + end +
                                 "; the map comes from the start without it, whose homotopy class may be another"});
    return second;
}

/// Forgets the start that was given, and all that came of it.
void SlidingSolver::begin_without_start() {
    problem_->forget_given_start();
    coefficient_step_.reset();
    step_.reset();
    boundary_.reset();
    chart_.reset();
    phi_ = {};
    state_ = {};
}

ExtremalSolver::Update SlidingSolver::update(const std::vector<Complex>& images, int max_iterations) {
    move(images);
    begin();
    const auto flipped = [&] { return folded_samples(beltrami_coefficient(step_->derivatives())); };
    if (!coefficient_step_) {
        int steps = 0;
        const bool settled = settle_conformal(max_iterations, steps);
        return {step_->map(), 0, 0, flipped(), settled};
    }
    HamiltonIteration::Options how = sliding_iteration_options(options_);
    how.max_iterations = max_iterations;
    const HamiltonIteration iteration = iterate(std::move(how));
    return {step_->map(), iteration.last_step().k, iteration.history().back().change, flipped(), iteration.converged()};
}

/// Takes other images for what is prescribed; sliding vertices stay between the same ones as before.
void SlidingSolver::move(const std::vector<Complex>& images) {
    const std::vector<SlidingLoop> places = problem_->move(images);
    if (!begun()) return;
    boundary_->move(problem_->prescribed(), places);
    Eigen::VectorXcd map = step_->map();
    boundary_->place(map);
    step_->set_map(std::move(map));
}

HamiltonIteration SlidingSolver::iterate(HamiltonIteration::Options how) {
    HamiltonIteration iteration(*step_, *coefficient_step_, std::move(how));
    iteration.run(state_, std::move(phi_.space));
    boundary_->adopt(step_->map());
    return iteration;
}

/// φ and k settle, and then the boundary.
FoundMap SlidingSolver::settle(ExtremalMap& result) {
    HamiltonIteration::Options how = sliding_iteration_options(options_);
    how.grow_first = how.grow_last = phi_.grows;
    if (phi_.grows) how.quiet_steps = kQuietSteps;
    const HamiltonIteration iteration = iterate(std::move(how));
    result.history = iteration.history();
    result.iterations = iteration.iterations();
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;

    const CoefficientStep::Result& last = iteration.last_step();
    const Eigen::VectorXcd nu = teichmueller_coefficient(last.k, last.phi);
    for (int i = 0; i < kLastSteps && iteration.converged(); ++i) {
        step_->solve(nu, kSettledSliding);
        ++result.iterations;
        if (step_->movement() < kLastMovement) break;
    }
    return {step_->map(), last};
}

/// |μ| is evened out, folds are opened; K and its bounds.
void SlidingSolver::finish(FoundMap found, ExtremalMap& result) {
    Finish finish(source(), nullptr, *coefficient_step_, boundary_->freedoms());
    std::optional<FoundMap> before_evening;
    if (options_.evening == ExtremalOptions::Evening::always) {
        if (!finish.folded(found)) before_evening = found;
        result.evened = finish.even_out(found);
    }
    if (options_.remove_folds) {
        result.folds_removed = finish.open_folds(found, boundary_->in_place());
        if (const FoundMap start{begun_.start, found.step}; finish.folded(found) && !finish.folded(start)) {
            const std::size_t flips = distortion(source().operators, found.map).flipped.size();
            result.warnings.push_back({WarningKind::fallback, "the iteration ended with " + std::to_string(flips) +
                                                                  " flipped faces that do not open; the map is that "
                                                                  "from which it began, without folds"});
            result.termination = Termination::unconfirmed;
            found = start;
            boundary_->adopt(found.map);
        }
    }
    finish.follow(found, 0);
    result.factorizations += finish.factorizations();
    record_space(*state_.space, phi_.expected_dimension, result);
    record_bounds(found, before_evening, result);
    result.differential = differential(found);
    result.map = std::move(found.map);
    result.phi = std::move(found.step.phi);
}

QuadraticDifferential SlidingSolver::differential(const FoundMap& found) const {
    return {state_.space, chart_, found.step.direction, phi_.poles, {}};
}

void SlidingSolver::record_bounds(const FoundMap& found, const std::optional<FoundMap>& before_evening,
                                  ExtremalMap& result) const {
    result.distortion = distortion(source().operators, found.map);
    const MeasuredMap best = better_for_bounds(found, before_evening, [&](const FoundMap& of) {
        MeasuredMap measured{of, distortion(source().operators, of.map), {}};
        measured.integrals = reich_strebel(source(), differential(of), measured.distortion.mu);
        return measured;
    });
    record_sliding_bounds(source(), found.map, best.integrals, best.found.step.k, result);
    raise_to_proofs(result);
}

/// Steps of the boundary until it has settled, where no differential is admissible; whether it has.
bool SlidingSolver::settle_conformal(int max_steps, int& steps) {
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source().operators.sample_count());
    for (steps = 0; steps < max_steps;) {
        step_->solve(nu, kSettledSliding);
        ++steps;
        if (step_->movement() < kSettledSliding) return true;
    }
    return false;
}

void SlidingSolver::solve_conformal(ExtremalMap& result) {
    const bool settled = settle_conformal(kConformalSteps, result.iterations);
    result.termination = settled ? Termination::converged : Termination::iteration_limit;
    result.map = step_->map();
    result.distortion = distortion(source().operators, result.map);
    if (options_.remove_folds && !result.distortion.flipped.empty()) open_conformal_folds(result);
    result.phi = Eigen::VectorXcd::Zero(source().operators.sample_count());
    result.K_max = result.distortion.K_max();
}

/// Opens folds of the map, or of its start, which where the boundary is crowded has fewer: the steps' remainder is
/// larger than the faces there. Where they do not open so, and the whole boundary slides on a circle, its vertices are
/// spread as far as faces between them need (fold_free_disk.h). There the round chart of the surface is a conformal map
/// of the same boundary, and is taken where the folds have cost more than its own.
void SlidingSolver::open_conformal_folds(ExtremalMap& result) {
    const std::vector<Freedom> freedoms = fixed_or_free(boundary_->freedoms());
    const auto take = [&](Eigen::VectorXcd map, Distortion of_map) {
        result.map = std::move(map);
        result.distortion = std::move(of_map);
        result.folds_removed = true;
    };
    for (const Eigen::VectorXcd& map : {result.map, begun_.start}) {
        LocalUnfolding opened = unfold_locally(source(), freedoms, map);
        result.factorizations += opened.factorizations;
        if (!opened.fold_free) continue;
        Distortion of_map = distortion(source().operators, opened.map);
        take(std::move(opened.map), std::move(of_map));
        boundary_->adopt(result.map);
        break;
    }
    if (const auto circle = free_circle()) {
        // Vertices that are held only fix which of the conformal maps it is, and move here.
        const auto open_disk = [&](const Eigen::VectorXcd& in_disk) {
            FoldFreeDisk opened = fold_free_disk(source(), in_disk);
            result.factorizations += opened.factorizations;
            if (!opened.fold_free) return;
            Eigen::VectorXcd map = opened.map.array() * circle->radius() + circle->centre();
            Distortion of_map = distortion(source().operators, map);
            if (result.folds_removed && of_map.mean >= result.distortion.mean) return;
            SlidingLoop loop = boundary_->loops()[0];
            if (!go_round(source().topology.boundary_loops[loop.loop], map, loop)) return;
            boundary_.emplace(source(), std::vector<SlidingLoop>{std::move(loop)}, problem_->prescribed());
            take(std::move(map), std::move(of_map));
        };
        const Eigen::VectorXcd in_disk = (result.map.array() - circle->centre()) / circle->radius();
        if (!result.folds_removed) open_disk(in_disk);
        Chart chart = round_disk_chart(source());
        result.factorizations += chart.factorizations;
        // Turned as the map is: the chart and it are the same up to that where neither has folds.
        const Complex turn = chart.vertices.dot(in_disk);
        if (std::abs(turn) > 0) chart.vertices *= turn / std::abs(turn);
        open_disk(chart.vertices);
    }
}

/// The circle on which the whole boundary slides, if it does.
std::optional<TargetCurve> SlidingSolver::free_circle() const {
    if (source().topology.boundary_loops.size() != 1 || boundary_->loops().size() != 1 ||
        !problem_->prescribed().vertices.empty() || !problem_->marked().vertices.empty() ||
        boundary_->loops()[0].curve.kind() != TargetCurve::Kind::circle)
        return std::nullopt;
    return boundary_->loops()[0].curve;
}

/// How far the map obeys its conditions.
void SlidingSolver::record_conditions(ExtremalMap& result) const {
    record_residual(problem_->prescribed(), result);
    record_residual(problem_->marked(), result);
    result.loops = loops_onto(source(), *boundary_, curves_, result.map);
    std::vector<char> is_prescribed(source().mesh.vertex_count(), 0);
    for (const int v : problem_->prescribed().vertices) is_prescribed[v] = 1;
    std::vector<LoopOnto> whole;
    for (std::size_t l = 0; l < result.loops.size(); ++l) {
        const SlidingLoop& loop = boundary_->loops()[l];
        const auto& vertices = source().topology.boundary_loops[loop.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!is_prescribed[vertices[i]])
                result.curve_residual = std::max(
                    result.curve_residual, std::abs(result.map[vertices[i]] - loop.curve.point(loop.parameters[i])));
        // Arcs hold their loop open, and may leave the curve.
        if (!has_prescribed_arc(vertices, is_prescribed)) whole.push_back(result.loops[l]);
    }
    require_not_collapsed(whole);
}

}  // namespace beltrami
