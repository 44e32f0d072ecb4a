#include <beltrami/teichmuller/extremal_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/certificate/solution_bounds.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/evening/even_dilatation.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/homotopy/twist.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/teichmuller/boundary_slack.h>
#include <beltrami/teichmuller/coarse_start.h>
#include <beltrami/teichmuller/elongation.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/piecewise_solver.h>
#include <beltrami/teichmuller/prepared_problem.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/problem_chart.h>
#include <beltrami/teichmuller/record_proofs.h>
#include <beltrami/teichmuller/sliding_solver.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 8;

/// √ of the mean of |μ − k conj(φ)/|φ||², |μ| held at 1: how far a map is from the coefficient that the theory
/// promises.
double deviation(const Operators& operators, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi, double k) {
    double sum = 0, area = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const double size = std::abs(phi[s]);
        if (!(size > 0) || !std::isfinite(std::abs(mu[s]))) continue;
        const Complex m = std::abs(mu[s]) > 1 ? mu[s] / std::abs(mu[s]) : mu[s];
        sum += operators.weights[s] * std::norm(m - k * std::conj(phi[s]) / size);
        area += operators.weights[s];
    }
    return area > 0 ? std::sqrt(sum / area) : 0.0;
}

/// Where the deviation exceeds this part of k, k is no more than a rough estimate.
constexpr double kRough = 0.6;

/// A map that is farther than this part of k from |μ| = k is evened out: where φ is singular, and elsewhere.
constexpr double kUnevenAtSingularities = 0.02, kUneven = 0.1, kUnevenAtAll = 2e-3;
/// Where evening out is to be expected, the iteration ends at this change of φ, its square of k, or after so many
/// steps.
constexpr double kRoughTolerance = 0.02;
constexpr int kRoughIterations = 16;
constexpr double kRoughRounding = 0.005, kRoughStep = 0.05;
/// Newton step, as part of the whole, to which the c-step is solved after the iteration.
constexpr double kFinishingStep = 2e-3;
constexpr int kFinishingSteps = 20;
/// Width of the bracket, as part of K, from which on poles that were thought needless are needed.
constexpr double kPolesNeeded = 0.01;
/// Merits that differ by less, as part of them, do not tell which of two bounds is the larger one.
constexpr double kCloseMerit = 0.01;
/// In the plane of a chart the iteration ends once it moves by less than this part of the bracket.
constexpr double kWithinBracket = 0.01;
/// The bracket of a smooth problem, as part of K, times the number of samples, is smaller (a bump's .7).
constexpr double kTightPerSample = 4;
/// From here on coefficients of faces are too noisy for K even there.
constexpr double kLargeCoefficient = 0.8;
/// The outline of a disk in space with so many vertices is noisy where half of this slack leaves less than this part of
/// the energy (of smooth values .94 and more, of scans .23 to .8, of planted noise of a fifth of an edge .15).
constexpr double kNoiseSlack = 0.5, kNoisyRatio = 0.6;
constexpr std::size_t kNoisyRim = 60;
/// Of the map of which K is estimated with other boundary values.
constexpr double kEstimateTolerance = 1e-4;
/// A corner is clear from this significance on (those of scans have 1 to 2.5), and where the image turns by so much
/// (radians).
constexpr double kClearCorner = 3, kSharpImage = 0.35;
/// Directions of held vertices that turn by less (radians) are kept, and they are followed so often.
constexpr double kTurned = 0.02;
constexpr int kMostTurns = 4;
/// Edges between two corners that are taken at their word.
constexpr int kResolvedEdges = 12;

/// Samples that a map turns over or collapses.
int folded_samples(const Eigen::VectorXcd& mu) {
    return static_cast<int>(std::count_if(mu.begin(), mu.end(), [](Complex value) { return !(std::norm(value) < 1); }));
}

/// Prescribed vertices of @p map put in their places.
void prescribe(Eigen::VectorXcd& map, const BoundaryCondition& boundary) {
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) map[boundary.vertices[i]] = boundary.images[i];
}

}  // namespace

struct ExtremalSolver::Implementation {
    ExtremalOptions options;
    BoundaryCondition boundary;
    Correspondence wanted;
    PreparedProblem prepared;
    const Surface& source;
    ExtremalProblem problem;
    HamiltonState state;
    Eigen::VectorXcd start;  // empty where φ is known from elsewhere
    Eigen::VectorXcd map;
    CoefficientStep::Result step;
    struct Settled {
        Eigen::VectorXcd map;
        CoefficientStep::Result step;
    };
    std::optional<Settled> before_evening;  // the map of the last c-step before it was evened out, if it has no folds
    std::vector<std::string> warnings;
    std::vector<Iteration> history;
    std::vector<BoundaryCorner> corners;
    std::vector<LoopPath> paths;  // along which turns are counted
    HeldVertices held_alone;      // as the space of differentials has them
    bool converged = false;
    int other_factorizations = 0;           // of the chart and the finish
    int earlier_iterations = 0;             // from a start that was given up
    bool elongated = false;                 // see elongation.h
    bool smooth = true;                     // φ has no singularities
    std::optional<Singularities> withheld;  // that φ may have but need not
    std::optional<SlackReport> slack;
    BoundaryCondition given_boundary;  // where there is slack
    std::optional<NoiseCost> noise;
    std::optional<Chart> instead;  // for φ that needs those
    bool evened = false, folds_removed = false;

    Implementation(const Surface& given, const Constraints& c, const ExtremalOptions& o, PreparedProblem p)
        : options(o),
          boundary(c.prescribed),
          wanted(c.correspondence),
          prepared(std::move(p)),
          source(prepared.surface_of(given)),
          problem(source, boundary, kExpectedFactorizations) {
        if (prepared.split) warnings.push_back(prepared.split_warning("prescribed"));
        corners = find_corners(source, boundary);
        ProblemChart charts = chart_of_problem(source, boundary, corners, wanted.outer_loop, problem.solver());
        instead = std::move(charts.instead);
        other_factorizations += charts.chart.factorizations;
        warnings.insert(warnings.end(), charts.chart.warnings.begin(), charts.chart.warnings.end());
        if (options.slack > 0) take_slack(charts.chart);
        elongated = has_plain_start() && source.topology.boundary_loops.size() == 1 && boundary.lines.empty() &&
                    boundary.vertices.size() == source.topology.boundary_loops[0].size() && image_corners() > 2 &&
                    is_elongated(source.operators, problem.harmonic());
        Singularities singularities = take_chart(std::move(charts.chart), problem.harmonic());
        // Corners that only a fine mesh would resolve need no poles; that they do not, the coarse problem shows. In a
        // chart far from conformal poles at corners would see its errors as dilatation.
        if (!elongated && (singularities.only_corners() || (instead && singularities.empty())) && has_plain_start() &&
            problem.chart_is_round()) {
            CoarseStart coarse = coarse_start(source, boundary, problem.chart(), problem.phase(),
                                              problem.largest_degree(), options, instead ? 0 : kCoarseStartPays);
            if (coarse.tight) {
                smooth = true;
                state = std::move(coarse.state);
                withheld = std::move(singularities);
                singularities = {};
            }
        }
        if (instead && !withheld) singularities = take_instead(problem.harmonic());
        if (elongated) singularities = {};
        problem.set_singularities(std::move(singularities), options.cluster_count);
        if (elongated) problem.coefficient_step().set_clip(clip_of_elongated(source.operators, problem.harmonic()));
        if (source.topology.boundary_loops.size() > 1)
            paths = loop_paths(source, problem.chart().vertices, wanted.outer_loop);
        choose_start();
    }

    /// Moves the boundary points as far as they may.
    void take_slack(const Chart& chart) {
        SlackBoundary slackened = slacken(source, chart, boundary, options.slack);
        slack = SlackReport{options.slack, slackened.largest_move, slackened.energy_before, slackened.energy_after, 1};
        given_boundary = std::move(boundary);
        boundary = std::move(slackened.boundary);
        problem.set_boundary(boundary);
        corners = find_corners(source, boundary);
    }

    /// K of other boundary values, by one f-step with the φ and k at hand and one c-step.
    double estimate_with(const BoundaryCondition& other) {
        Eigen::VectorXcd moved = map;
        prescribe(moved, other);
        moved = problem.solver().solve_near(
            problem.coefficient_on_source(problem.coefficient_step().coefficient(step.k, step.phi)), moved, moved,
            kEstimateTolerance);
        const CoefficientStep::Result one =
            problem.coefficient_step().solve(coefficient_of(moved), step.direction, kFinishingStep, kFinishingSteps);
        return (1 + one.k) / (1 - one.k);
    }

    /// What the noise of the outline costs, or what slack has gained.
    void compare_outlines() {
        noise.reset();
        if (slack) slack->K_without = estimate_with(given_boundary);
        const auto& loops = source.topology.boundary_loops;
        if (slack || !problem.chart_metric() || loops[0].size() < kNoisyRim) return;
        try {
            const SlackBoundary quarter = slacken(source, problem.chart(), boundary, 0.5 * kNoiseSlack);
            const double ratio = quarter.energy_after / quarter.energy_before;
            if (!(ratio < kNoisyRatio)) return;
            const SlackBoundary half = slacken(source, problem.chart(), boundary, kNoiseSlack);
            noise = NoiseCost{kNoiseSlack, estimate_with(half.boundary), ratio};
        } catch (const Error& error) {  // the boundary values do not run forward: nothing is said about noise
            if (error.cause() != Cause::bad_boundary && error.cause() != Cause::bad_option) throw;
        }
    }

    /// Corners of the image.
    std::ptrdiff_t image_corners() const {
        return std::count_if(corners.begin(), corners.end(), [](const BoundaryCorner& corner) {
            return std::abs(corner.image_angle - std::numbers::pi) > kSharpImage;
        });
    }

    /// Whether no corner is more than what the outline of a scan has everywhere. In the plane of the chart φ then needs
    /// no poles: they would be fitted to single edges.
    bool corners_are_noise() const {
        return std::none_of(corners.begin(), corners.end(), [](const BoundaryCorner& corner) {
            return corner.significance > kClearCorner || std::abs(corner.image_angle - std::numbers::pi) > kSharpImage;
        });
    }

    /// Makes a chart that of the problem; returns where φ may be singular in it.
    Singularities take_chart(Chart chart, const Eigen::VectorXcd& at) {
        Singularities result = singularities_of(source, chart, boundary, corners, at);
        const bool plain = (options.chart_metric || options.slack > 0) && !elongated &&
                           (result.empty() || result.only_corners()) && corners_are_noise();
        held_alone = held_vertices(source, chart, boundary, at);
        problem.set_chart(std::move(chart));
        if (plain && problem.take_chart_metric()) result = {};
        smooth = result.empty();
        return result;
    }
    Singularities take_instead(const Eigen::VectorXcd& at) {
        Chart chart = std::move(*instead);
        instead.reset();
        return take_chart(std::move(chart), at);
    }

    /// Whether enough edges run from a corner to the next ones of its loop for its angles and speeds to mean something:
    /// between teeth and in notches of a few edges they do not.
    bool resolved(const BoundaryCorner& corner) const {
        const int n = static_cast<int>(source.topology.boundary_loops[corner.loop].size());
        for (const BoundaryCorner& other : corners) {
            const int apart = std::abs(other.position - corner.position);
            if (other.loop == corner.loop && apart > 0 && std::min(apart, n - apart) < kResolvedEdges) return false;
        }
        return true;
    }

    void choose_start() {
        map = problem.harmonic();
        if (options.start) {
            map = prepared.split ? with_parents_means(*options.start, prepared.split->parents) : *options.start;
            prescribe(map, boundary);
        } else if (wanted.waypoints) {
            const Eigen::VectorXcd places = source.in_plane() && wanted.outer_loop == 0
                                                ? planar_coordinates(source.mesh)
                                                : problem.chart().vertices;
            map = follow(source, Continuation(source, places, wanted.outer_loop, boundary, *wanted.waypoints)).map;
        } else if (!wanted.turns.empty()) {
            map = start_in_class(source, problem.chart().vertices, wanted.outer_loop, boundary, wanted.turns).map;
        } else if (smooth && !elongated && !state.space) {
            state = coarse_start(source, boundary, problem.chart(), problem.phase(), problem.largest_degree(), options)
                        .state;
        }
        start = state.space ? Eigen::VectorXcd() : map;
    }

    bool has_plain_start() const { return !options.start && !wanted.waypoints && wanted.turns.empty(); }

    /// Whether vertices that are held to lines one by one move otherwise under the map than φ takes them to.
    bool held_have_turned() const {
        const HeldVertices now = held_vertices(source, problem.chart(), boundary, map);
        for (std::size_t i = 0; i < now.vertices.size(); ++i)
            if (std::abs(std::imag(now.directions[i] * std::conj(held_alone.directions[i]))) > kTurned) return true;
        return false;
    }

    /// Runs the iteration, with poles that follow the map at vertices held to lines one by one.
    void iterate(const HamiltonIteration::Options& how) {
        iterate_once(how);
        for (int turn = 0; turn < kMostTurns && held_have_turned(); ++turn) {
            held_alone = held_vertices(source, problem.chart(), boundary, map);
            problem.set_singularities(singularities_of(source, problem.chart(), boundary, corners, map),
                                      options.cluster_count);
            state = {};
            iterate_once(how);
        }
    }

    /// The options as they are in the metric of the iteration.
    HamiltonIteration::Options adapted(HamiltonIteration::Options how) const {
        if (problem.chart_metric()) {
            how.within_bracket = kWithinBracket;
            how.tight = kTightPerSample / source.operators.sample_count();
        }
        return how;
    }

    std::unique_ptr<DifferentialSpace> first_space() const {
        if (elongated) return harmonic_square_space(source, problem.chart(), problem.harmonic());
        return problem.starting_space(problem.largest_degree());
    }

    /// Runs the iteration from where it stands.
    void iterate_once(const HamiltonIteration::Options& how) {
        problem.map_step().set_near(state.space && problem.solver().factorization_count() > 1);
        problem.map_step().set_map(map);
        HamiltonIteration iteration(problem.step_in_domain(), problem.coefficient_step(), adapted(how));
        // Only a run from nothing needs a space to begin with, and its basis is costly.
        iteration.run(state, state.space ? nullptr : first_space());
        map = problem.map_step().map();
        step = iteration.last_step();
        converged = iteration.converged();
        // A run that goes on begins with where the last one ended.
        const auto& steps = iteration.history();
        history.insert(history.end(), steps.begin() + (history.empty() ? 0 : 1), steps.end());
    }

    /// μ of a map in the metric of the iteration.
    Eigen::VectorXcd coefficient_of(const Eigen::VectorXcd& of) const {
        return beltrami_coefficient(problem.domain().operators, of);
    }

    bool folded() const { return folded_samples(beltrami_coefficient(source.operators, map)) > 0; }

    /// Whether the map is far from |μ| = k, or folded.
    bool uneven() const {
        const Eigen::VectorXcd mu = coefficient_of(map);
        if (problem.chart_metric()) return folded_samples(mu) > 0;
        const double part = problem.singular() ? kUnevenAtSingularities : kUneven;
        return folded_samples(mu) > 0 ||
               deviation(problem.domain().operators, mu, step.phi, step.k) > std::max(kUnevenAtAll, part * step.k);
    }

    /// What vertices may do after the iteration: those on lines stay where they are.
    std::vector<Freedom> held() const {
        std::vector<Freedom> freedom = freedoms(boundary, source);
        std::replace(freedom.begin(), freedom.end(), Freedom::sliding, Freedom::fixed);
        return freedom;
    }

    /// Evens |μ| out, φ and k following the map.
    bool even_out() {
        if (!folded()) before_evening = {map, step};
        const auto update = [&](const Eigen::VectorXcd& at, Eigen::VectorXcd& phi, double& k) {
            step =
                problem.coefficient_step().solve(coefficient_of(at), step.direction, kFinishingStep, kFinishingSteps);
            phi = problem.differential_on_source(step.phi);
            k = step.k;
            return true;
        };
        EvenDilatation even =
            even_dilatation(source, held(), map, step.k, problem.differential_on_source(step.phi), update);
        other_factorizations += even.factorizations;
        if (!even.improved) return false;
        map = std::move(even.map);
        return true;
    }

    /// Opens what folds are left; of a convex target, where all else fails, from a map that never had any.
    bool remove_folds() {
        const Eigen::VectorXcd nu = problem.coefficient_on_source(teichmueller_coefficient(step.k, step.phi));
        FoldFreeMap opened = fold_free_map(source, held(), nu, map);
        other_factorizations += opened.factorizations;
        if (!opened.fold_free)
            if (const auto embedding = convex_embedding(source, boundary, other_factorizations)) {
                opened = fold_free_map(source, held(), nu, *embedding);
                other_factorizations += opened.factorizations;
            }
        if (opened.fold_free) map = opened.map;
        return opened.fold_free;
    }

    /// The c-step of a map that came after the iteration.
    void update_coefficient() {
        step = problem.coefficient_step().solve(coefficient_of(map), step.direction, kFinishingStep);
    }

    ReichStrebel integrals_of(const Distortion& distortion, const CoefficientStep::Result& with) const {
        return reich_strebel(problem.domain(), problem.chart(), *state.space, with.direction, distortion.mu);
    }

    SolutionBounds bounds_of(const Eigen::VectorXcd& of, const CoefficientStep::Result& with,
                             const Distortion& distortion, const ReichStrebel& integrals) const {
        return solution_bounds(
            {problem.domain(), boundary, problem.chart(), *state.space, with.direction, with.phi, with.k, of,
             distortion, integrals, paths, wanted.outer_loop, wanted.turns},
            problem.chart_metric() && !options.sharpen && with.k < kLargeCoefficient ? -1 : options.sharpen);
    }

    /// Of the map, or of the one before it was evened out: evening makes the bounds, as a rule, a little worse.
    SolutionBounds best_bounds(const Distortion& measured) const {
        if (!before_evening || before_evening->step.merit < (1 - kCloseMerit) * step.merit)
            return bounds_of(map, step, measured, integrals_of(measured, step));
        const auto& [earlier_map, earlier_step] = *before_evening;
        const Distortion earlier = distortion(problem.domain().operators, earlier_map);
        const ReichStrebel earlier_integrals = integrals_of(earlier, earlier_step);
        if (earlier_integrals.valid && earlier_step.merit > (1 + kCloseMerit) * step.merit)
            return bounds_of(earlier_map, earlier_step, earlier, earlier_integrals);
        const auto lower = [](const ReichStrebel& integrals) { return integrals.valid ? integrals.lower : 1; };
        const ReichStrebel integrals = integrals_of(measured, step);
        if (lower(earlier_integrals) >= lower(integrals))
            return bounds_of(earlier_map, earlier_step, earlier, earlier_integrals);
        return bounds_of(map, step, measured, integrals);
    }

    /// The iteration from where it stands, and what comes after it.
    void run();

    /// Whether singularities that were thought needless are needed after all.
    bool needs_poles() const { return withheld && bracket(step) > kPolesNeeded; }

    /// Lets φ have its singularities after all.
    void take_poles() {
        if (instead) *withheld = take_instead(map);
        problem.set_singularities(std::move(*withheld), options.cluster_count);
        withheld.reset();
        smooth = false;
        state = {};
    }

    /// Gives up the start that was asked for: a map so folded that the class of μ means nothing leads nowhere.
    void start_again() {
        const int folds = folded_samples(beltrami_coefficient(source.operators, map));
        warnings.push_back("from the start that was given the iteration ended with " + std::to_string(folds) +
                           " flipped faces; the map comes from the " +
                           (wanted.waypoints || !wanted.turns.empty() ? "start without it" : "harmonic start") +
                           ", whose homotopy class may be another");
        options.start.reset();
        state = {};
        before_evening.reset();
        earlier_iterations += static_cast<int>(history.size()) - 1;
        history.clear();
        choose_start();
        run();
    }

    ExtremalMap record() const;
};

ExtremalSolver::ExtremalSolver(const Surface& source, const Constraints& constraints, const ExtremalOptions& options) {
    if (!constraints.all_prescribed() && !constraints.all_slides())
        throw Error(Cause::bad_option, "a solver is kept for boundaries that are prescribed or slide everywhere",
                    "extremal_map solves problems in which they mix");
    if (!constraints.all_prescribed()) {
        sliding_ = std::make_unique<SlidingSolver>(source, constraints, options);
        return;
    }
    PreparedProblem prepared = prepare(source, constraints, options);
    const Correspondence& wanted = constraints.correspondence;
    ProblemPieces cut;
    // A class that is asked for is one of the whole.
    if (wanted.turns.empty() && !wanted.waypoints) cut = pieces_of(prepared.surface_of(source), constraints.prescribed);
    if (cut.pieces.empty()) {
        implementation_ = std::make_unique<Implementation>(source, constraints, options, std::move(prepared));
        if (!cut.obstacle.empty()) implementation_->warnings.push_back(cut.obstacle);
    } else {
        pieces_ =
            std::make_unique<PiecewiseSolver>(source, constraints, options, std::move(prepared), std::move(cut.pieces));
    }
}
ExtremalSolver::~ExtremalSolver() = default;
ExtremalSolver::ExtremalSolver(ExtremalSolver&&) noexcept = default;

ExtremalSolver::Update ExtremalSolver::update(const std::vector<Complex>& images, int max_iterations) {
    if (max_iterations < 1) throw Error(Cause::bad_option, "an update needs at least one iteration");
    if (pieces_) return pieces_->update(images, max_iterations);
    if (sliding_) return sliding_->update(images, max_iterations);
    Implementation& m = *implementation_;
    if (images.size() != m.boundary.images.size())
        throw Error(Cause::bad_boundary, "there are " + std::to_string(images.size()) + " new images for " +
                                             std::to_string(m.boundary.images.size()) + " prescribed vertices");
    BoundaryCondition moved = m.boundary;
    moved.images = images;
    require_feasible(m.source, moved, m.wanted.outer_loop);
    m.boundary = std::move(moved);
    m.problem.map_step().prescribe(prescribed_values(m.boundary, m.source), line_directions(m.boundary, m.source));
    HamiltonIteration::Options how = iteration_options(m.options);
    how.max_iterations = max_iterations;
    how.grow_first = how.grow_last = false;
    m.history.clear();
    m.iterate(how);
    const Eigen::VectorXcd mu = beltrami_coefficient(m.source.operators, m.map);
    return {m.map, m.step.k, m.history.back().change, folded_samples(mu), m.converged};
}

ExtremalMap ExtremalSolver::solve() {
    if (pieces_) return pieces_->solve();
    if (sliding_) return sliding_->solve();
    Implementation& m = *implementation_;
    m.history.clear();
    m.earlier_iterations = 0;
    m.run();
    if (m.options.start && m.folded()) m.start_again();
    m.compare_outlines();
    ExtremalMap result = m.record();
    m.before_evening.reset();
    return result;
}

void ExtremalSolver::Implementation::run() {
    using Evening = ExtremalOptions::Evening;
    evened = false;
    if ((problem.singular() || withheld) && !problem.jumps() && options.evening != Evening::never) {
        // Evening out moves φ more than the last digits of the iteration do.
        HamiltonIteration::Options rough = iteration_options(options);
        rough.tolerance = std::max(rough.tolerance, kRoughTolerance);
        rough.k_tolerance = std::max(rough.k_tolerance, kRoughTolerance * kRoughTolerance);
        rough.max_iterations = std::min(rough.max_iterations, kRoughIterations);
        rough.step_below_change = kRoughStep;
        rough.grow_last = false;
        problem.coefficient_step().set_least_rounding(kRoughRounding);
        iterate(rough);
        problem.coefficient_step().set_least_rounding(0);
        evened = converged && !needs_poles() && uneven() && even_out();
    }
    if (!evened) {
        HamiltonIteration::Options rest = iteration_options(options);
        rest.max_iterations -= std::max(0, static_cast<int>(history.size()) - 1);
        if (rest.max_iterations > 0) iterate(rest);
        if (needs_poles()) {
            take_poles();
            return run();
        }
        evened = (options.evening == Evening::always || (options.evening == Evening::where_needed && uneven())) &&
                 even_out();
    }
    folds_removed = options.remove_folds && folded() && remove_folds();
    if (evened || folds_removed) update_coefficient();
}

/// Everything that is measured on the final map, with φ of the last c-step.
ExtremalMap ExtremalSolver::Implementation::record() const {
    const Operators& operators = source.operators;
    ExtremalMap result;
    result.map = map;
    result.harmonic = problem.harmonic();
    result.start = start;
    result.history = history;
    result.warnings = warnings;
    result.iterations = earlier_iterations + static_cast<int>(history.size()) - 1;
    result.evened = evened;
    result.folds_removed = folds_removed;
    result.factorizations = other_factorizations + problem.solver().factorization_count();
    result.termination = converged ? Termination::converged : Termination::iteration_limit;
    result.split = prepared.split;
    result.slack = slack;
    result.noise = noise;
    if (!paths.empty()) {
        result.homotopy = homotopy_class(source, paths, map, wanted.outer_loop);
        if (!wanted.turns.empty())
            for (const HoleTurns& hole : result.homotopy.holes)
                if (hole.turns != wanted.turns[hole.loop])
                    throw Error(Cause::not_solved,
                                "the hole of loop " + std::to_string(hole.loop) +
                                    " has lost its turns: " + std::to_string(wanted.turns[hole.loop]) +
                                    " were wanted, the map has " + std::to_string(hole.turns),
                                "the mesh is too coarse to hold them: refine it, or ask for fewer", {hole.loop});
    }
    result.distortion = distortion(operators, map);
    result.differential = problem.differential(state.space, step.direction);
    result.phi = problem.differential_on_source(step.phi);
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        result.boundary_residual =
            std::max(result.boundary_residual, std::abs(map[boundary.vertices[i]] - boundary.images[i]));

    result.K_max = largest_dilatation(result.distortion);
    std::optional<Distortion> in_chart;
    if (const ChartMetric* metric = problem.chart_metric()) {
        in_chart = distortion(metric->plane().operators, map);
        result.in_chart =
            InChart{metric->chart_mean(), in_chart->mean, in_chart->standard_deviation, problem.largest_degree()};
    }
    const SolutionBounds bounds = best_bounds(in_chart ? *in_chart : result.distortion);
    result.K = std::min(bounds.K, result.K_max);
    result.k = (result.K - 1) / (result.K + 1);
    result.K_lower = bounds.K_lower;
    result.bounds = bounds.bounds;
    result.factorizations += bounds.factorizations;
    result.corners = corners;
    for (const BoundaryCorner& corner : corners)
        // An infinite bound is that of an angle measured as none: no smooth data have it.
        if (corner.safe_bound > 1 && std::isfinite(corner.safe_bound) && resolved(corner) &&
            (!result.sharpest || corner.safe_bound > result.sharpest->safe_bound))
            result.sharpest = corner;
    if (result.sharpest) {
        result.bounds.push_back({"corner", result.sharpest->safe_bound, Bound::Of::extremal, false});
        // Where the bracket is closed, the corner is one of the mesh's outline and not of the problem.
        const bool proved =
            std::isfinite(result.K_max) && !corner_decides({.safe_bound = result.K_max}, result.K_lower);
        if (converged && !proved && corner_decides(*result.sharpest, result.K)) {
            result.termination = Termination::not_teichmuller;
            result.warnings.push_back(corner_warning(*result.sharpest));
        }
    }
    result.bounds.push_back({"mesh_harmonic", mesh_harmonic_bound(operators, result.harmonic), Bound::Of::mesh, true});
    if (std::isfinite(result.K_max)) result.bounds.push_back({"attained", result.K_max, Bound::Of::extremal, true});
    if (!result.distortion.flipped.empty())
        result.warnings.push_back("flipped faces in the result: " + std::to_string(result.distortion.flipped.size()) +
                                  "; it is not one-to-one there" +
                                  (result.K_lower > 1 ? "" : " and no lower bound can be given"));
    if (result.termination == Termination::iteration_limit)
        result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                  " iterations before k and φ settled");
    if (result.k > 1e-3 &&
        std::hypot(result.distortion.standard_deviation, result.distortion.mean - result.k) > kRough * result.k)
        result.warnings.push_back(
            "the map is far from constant dilatation: the mesh is too coarse for its shape, or the extremal map is not "
            "smooth; K is a rough estimate and K_lower may be far below K*");
    record_proofs(source, boundary, options, result);
    return result;
}

}  // namespace beltrami
