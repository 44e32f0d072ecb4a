#include <beltrami/teichmuller/extremal_onto.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/differentials/dimension.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/one_form_squares.h>
#include <beltrami/differentials/projected_space.h>
#include <beltrami/maps/fold_free.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/polygon.h>
#include <beltrami/teichmuller/sliding_map_step.h>
#include <beltrami/teichmuller/sliding_start.h>

namespace beltrami {

namespace {

/// How many solves the system is ordered for.
constexpr int kExpectedFactorizations = 6;
/// Newton steps of the boundary after the iteration, until no vertex moves by more than this part of its curve.
constexpr int kLastSteps = 10;
constexpr double kSettled = 1e-9;
/// Newton steps of the boundary where there are no differentials: the map is conformal.
constexpr int kConformalSteps = 100;
/// A loop's image encloses at least this part of what its curve does.
constexpr double kLeastArea = 0.5;
/// Points of the c-step on large meshes, and what sharper differences of φ ask for.
constexpr int kClusters = 1500;

/// The mesh on which no edge across the surface joins two boundary vertices.
struct Prepared {
    std::optional<SplitProblem> split;
    std::optional<Surface> surface;  ///< of split
};

Prepared prepare(const Surface& source, const OntoOptions& options) {
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
    // Any values will do: only edges between boundary vertices are split.
    BoundaryCondition boundary;
    const auto& all = source.topology.boundary_loops;
    for (std::size_t l = 0; l < all.size(); ++l)
        for (std::size_t i = 0; i < all[l].size(); ++i)
            boundary.pin(all[l][i],
                         std::polar(1.0 + static_cast<double>(l),
                                    6.283185307179586 * static_cast<double>(i) / static_cast<double>(all[l].size())));
    Prepared result;
    SplitProblem split = split_prescribed(source, boundary);
    if (split.split_edges == 0) return result;
    result.surface = surface_of(split.mesh, split.metric);
    result.split = std::move(split);
    return result;
}

/// The chart in whose circle domain φ is written down, or the frames of the samples where it is tabulated; and φ's
/// space.
struct Differentials {
    Chart chart;
    std::unique_ptr<DifferentialSpace> space;  ///< null where there are none: the map is conformal
    double gap = 0;
    OntoOptions::Space kind;
    std::vector<std::string> warnings;
};

/// #V tangents of the circles of a circle domain.
Eigen::VectorXcd circle_tangents(const Surface& source, const CircleDomainChart& domain) {
    Eigen::VectorXcd result = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    const auto& loops = source.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (const int v : loops[l])
            result[v] = Complex(0, 1) * (domain.chart.vertices[v] - domain.circle(static_cast<int>(l)).centre);
    return result;
}

Differentials differentials(const Surface& source, const CircleDomainChart& domain, const OntoOptions& options,
                            const std::vector<int>& marked, int dimension) {
    using Space = OntoOptions::Space;
    Differentials result;
    result.kind = options.space;
    const bool quadrilateral = domain.holes.empty() && marked.size() == 4;
    if (result.kind == Space::automatic) result.kind = quadrilateral ? Space::one_form_squares : Space::projection;
    if (dimension == 0) return result;
    if (result.kind == Space::one_form_squares) {
        if (!quadrilateral)
            throw Error(Cause::bad_option, "squares of 1-forms are for disks with four marks",
                        "leave the space to be chosen automatically");
        result.chart = chart_of_frames(source);
        result.space = std::make_unique<TabulatedSpace>(
            std::move(quadrilateral_space(source, {marked[0], marked[1], marked[2], marked[3]}).space));
        result.gap = std::numeric_limits<double>::infinity();
        return result;
    }
    result.chart = domain.chart;
    if (result.kind == Space::projection) {
        ProjectionOptions how;
        how.marked = marked;
        how.tangents = circle_tangents(source, domain);
        ProjectedSpace projected = projected_space(source, domain.chart, how);
        result.gap = projected.gap;
        result.warnings = std::move(projected.warnings);
        result.space = std::make_unique<TabulatedSpace>(std::move(projected.space));
        return result;
    }
    const std::optional<RoundDomain> round = round_domain(source, domain.chart, marked);
    if (!round) throw Error(Cause::not_solved, "the chart of the source is not a circle domain");
    auto laurent = std::make_unique<LaurentSpace>(*round);
    result.gap = laurent->fit().next / std::max(laurent->fit().residual, 1e-16);
    result.space = std::move(laurent);
    return result;
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

/// Holds as many vertices as conformal maps of the source to itself leave free: one of an annulus, three of a disk.
void hold_what_conformal_maps_move(const Surface& source, std::vector<SlidingLoop>& loops, int outer,
                                   std::size_t marks) {
    const std::size_t holes = loops.size() - 1;
    const std::size_t free = holes == 0 ? 3 : holes == 1 ? 1 : 0;
    if (marks >= free) return;
    for (SlidingLoop& sliding : loops) {
        if (sliding.loop != outer) continue;
        // Places that share the curve evenly with the marks of this loop.
        const std::size_t n = source.topology.boundary_loops[outer].size();
        for (std::size_t more = marks; more < free; ++more) {
            std::size_t best = 0;
            double farthest = -1;
            for (std::size_t i = 0; i < n; ++i) {
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t j = 0; j < n; ++j)
                    if (sliding.held[j])
                        nearest =
                            std::min(nearest, std::abs(std::remainder(sliding.parameters[i] - sliding.parameters[j],
                                                                      sliding.curve.length())));
                if (nearest > farthest * (1 + 1e-9)) farthest = nearest, best = i;
            }
            sliding.held[best] = 1;
        }
    }
}

double enclosed_area(const std::vector<int>& loop, const Eigen::VectorXcd& map) {
    double twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Complex a = map[loop[i]], b = map[loop[(i + 1) % loop.size()]];
        twice += std::imag(std::conj(a) * b);
    }
    return 0.5 * twice;
}

/// Boundary vertices that keep their places.
std::vector<Freedom> held_boundary(const Surface& source) {
    std::vector<Freedom> result(source.mesh.vertex_count(), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices())
        if (!source.topology.on_boundary[v]) result[v] = Freedom::free;
    return result;
}

/// Rotation of the c-step's grid, tied to the source's shape.
double phase_of(const CircleDomainChart& domain, const Surface& source) {
    for (const RoundHole& hole : domain.holes)
        if (std::abs(hole.centre) > 1e-3) return std::arg(hole.centre);
    return std::arg(domain.chart.vertices[source.topology.boundary_loops[domain.outer_loop()][0]]);
}

class OntoProblem {
  public:
    OntoProblem(const Surface& given, const OntoOptions& options)
        : options_(options),
          prepared_(prepare(given, options)),
          source_(prepared_.surface ? *prepared_.surface : given),
          domain_(circle_domain_chart(source_, options.outer_loop)),
          marked_(marked_vertices(source_, options.marks)) {}

    const Surface& source() const { return source_; }
    const CircleDomainChart& domain() const { return domain_; }

    ExtremalMapOnto solve(const TargetModel& target) {
        SlidingStart start = sliding_start(source_, domain_, target, options_);
        hold_what_conformal_maps_move(source_, start.loops, options_.outer_loop, marked_.size());
        ExtremalMapOnto result;
        result.start = start.map;
        result.rotation = start.rotation;
        result.path = start.path;
        result.led = start.led;
        result.start_flips = start.flips;
        result.expected_dimension =
            dimension_of_differentials(static_cast<int>(domain_.holes.size()), static_cast<int>(marked_.size()));
        result.factorizations = domain_.factorizations + target.factorizations() + start.factorizations;

        SlidingBoundary boundary(source_, start.loops);
        SlidingMapStep step(source_, boundary, kExpectedFactorizations);
        Differentials phi = differentials(source_, domain_, options_, marked_, result.expected_dimension);
        result.space = phi.kind;
        result.dimension_gap = phi.gap;
        result.warnings = phi.warnings;
        result.dimension = phi.space ? phi.space->size() : 0;
        result.map = start.map;
        if (phi.space) {
            iterate(std::move(phi), boundary, step, result);
        } else {
            conformal(boundary, step, result);
        }
        result.factorizations += step.factorization_count();
        record_loops(start.curves, boundary, result);
        record_warnings(result);
        result.split = prepared_.split;
        return result;
    }

  private:
    void iterate(Differentials phi, SlidingBoundary& boundary, SlidingMapStep& step, ExtremalMapOnto& result) {
        CoefficientStep coefficient_step(source_, phi.chart, {}, phase_of(domain_, source_), kClusters);
        HamiltonIteration::Options how;
        how.tolerance = how.k_tolerance = options_.tolerance;
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
            if (step.movement() < kSettled) break;
        }
        result.distortion = distortion(source_.operators, result.map);
        if (options_.remove_folds && !result.distortion.flipped.empty()) {
            const FoldFreeMap opened = fold_free_map(source_, held_boundary(source_), nu, result.map);
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
    void conformal(SlidingBoundary&, SlidingMapStep& step, ExtremalMapOnto& result) const {
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

    static double worst(const Distortion& measured) {
        return measured.flipped.empty() ? dilatation(measured.max) : std::numeric_limits<double>::infinity();
    }

    static void record_bounds(const ReichStrebel& integrals, double k, ExtremalMapOnto& result) {
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

    void record_loops(const std::vector<int>& curves, const SlidingBoundary& boundary, ExtremalMapOnto& result) const {
        for (const SlidingLoop& sliding : boundary.loops()) {
            const auto& vertices = source_.topology.boundary_loops[sliding.loop];
            const double area = enclosed_area(vertices, result.map);
            const double whole = sliding.curve.counter_clockwise() ? sliding.curve.area() : -sliding.curve.area();
            result.loops.push_back({sliding.loop, curves[sliding.loop], sliding.parameters, area / whole});
            if (!(result.loops.back().area_ratio > kLeastArea))
                throw Error(Cause::not_solved,
                            "boundary loop " + std::to_string(sliding.loop) + " has collapsed: its image encloses " +
                                std::to_string(100 * result.loops.back().area_ratio) + " % of what its curve does",
                            "give the loop more vertices, or lead the start there by waypoints");
        }
        for (const Mark& mark : options_.marks) {
            for (const SlidingLoop& sliding : boundary.loops())
                if (curves[sliding.loop] == mark.curve)
                    result.boundary_residual =
                        std::max(result.boundary_residual,
                                 std::abs(result.map[mark.vertex] - sliding.curve.point(mark.parameter)));
        }
    }

    void record_warnings(ExtremalMapOnto& result) const {
        if (prepared_.split)
            result.warnings.push_back(
                std::to_string(prepared_.split->split_edges) +
                " edges between boundary vertices were split; added vertices follow the source's");
        result.warnings.insert(result.warnings.end(), domain_.chart.warnings.begin(), domain_.chart.warnings.end());
        if (result.dimension != result.expected_dimension)
            result.warnings.push_back("the space of differentials has dimension " + std::to_string(result.dimension) +
                                      ", theory says " + std::to_string(result.expected_dimension));
        if (!result.distortion.flipped.empty())
            result.warnings.push_back(
                "flipped faces in the result: " + std::to_string(result.distortion.flipped.size()) +
                "; it is not one-to-one there");
        if (result.termination == Termination::iteration_limit)
            result.warnings.push_back("stopped after " + std::to_string(result.iterations) +
                                      " iterations before k and φ settled");
    }

    const OntoOptions& options_;
    Prepared prepared_;
    const Surface& source_;
    CircleDomainChart domain_;
    std::vector<int> marked_;
};

/// Mean edge of the source in the unit disk, carried over to a target of some size.
double edge_length_for(const Surface& source, const TargetDomain& target, const OntoOptions& options) {
    if (options.target_edge_length > 0) return options.target_edge_length;
    double area = target.outer.area();
    for (const TargetCurve& hole : target.holes) area -= hole.area();
    return std::sqrt(4 / std::sqrt(3.0) * area / source.mesh.face_count());
}

}  // namespace

const char* to_string(OntoOptions::Space space) {
    switch (space) {
        case OntoOptions::Space::automatic:
            return "automatic";
        case OntoOptions::Space::laurent:
            return "laurent";
        case OntoOptions::Space::projection:
            return "projection";
        case OntoOptions::Space::one_form_squares:
            return "one_form_squares";
    }
    return "";
}

void OntoOptions::validate() const {
    if (!(tolerance > 0)) throw Error(Cause::bad_option, "the tolerance must be positive");
    if (max_iterations < 1) throw Error(Cause::bad_option, "there must be at least one iteration");
    if (anderson_window < 0) throw Error(Cause::bad_option, "the window of the acceleration must not be negative");
    if (outer_loop < 0) throw Error(Cause::bad_option, "the outer loop must not be negative");
    if (!(target_edge_length >= 0) || std::isinf(target_edge_length))
        throw Error(Cause::bad_option, "the target's edge length must be positive, or 0");
    for (const double turn : start_turns)
        if (!std::isfinite(turn)) throw Error(Cause::bad_option, "a start turn is not a number");
}

namespace {

/// Curves of the target's circle domain: 0 for the outer loop, then the holes of the chart.
int curve_of_loop(const CircleDomainChart& chart, int loop) {
    if (loop == chart.outer_loop()) return 0;
    for (std::size_t h = 0; h < chart.holes.size(); ++h)
        if (chart.holes[h].loop == loop) return static_cast<int>(h) + 1;
    throw Error(Cause::bad_option, "the target has no boundary loop " + std::to_string(loop),
                "`beltrami info` prints the loops' numbers");
}

/// Options in which loops and vertices of the target have become curves and places of its circle domain.
OntoOptions on_circles(const OntoOptions& options, const Surface& target, const CircleDomainChart& chart) {
    if (!options.marks.empty())
        throw Error(Cause::bad_option, "marks on curves are given for a target that is a surface",
                    "give pairs of vertices instead");
    OntoOptions result = options;
    for (auto& [loop, curve] : result.loops) curve = curve_of_loop(chart, curve);
    const auto& loops = target.topology.boundary_loops;
    for (const auto& [vertex, image] : options.mark_vertices) {
        int on = -1;
        for (std::size_t l = 0; l < loops.size(); ++l)
            if (std::find(loops[l].begin(), loops[l].end(), image) != loops[l].end()) on = static_cast<int>(l);
        if (on < 0)
            throw Error(Cause::bad_boundary,
                        "the mark's vertex " + std::to_string(image) + " is not on the boundary of the target",
                        "mark boundary vertices only", {image});
        const RoundHole circle = chart.circle(on);
        const int curve = curve_of_loop(chart, on);
        const double angle = std::arg(chart.chart.vertices[image] - circle.centre);
        result.marks.push_back({vertex, curve, circle.radius * (curve == 0 ? angle : -angle)});
    }
    return result;
}

}  // namespace

ExtremalMapOnto extremal_map(const Surface& source, const TargetDomain& target, const OntoOptions& options) {
    if (!options.mark_vertices.empty())
        throw Error(Cause::bad_option, "marks by vertices of the target are given for a target that has none",
                    "give places on its curves instead");
    OntoProblem problem(source, options);
    return problem.solve(*target_model(target, edge_length_for(source, target, options)));
}

ExtremalMapOntoSurface extremal_map(const Surface& source, const Surface& target, const OntoOptions& options,
                                    int outer) {
    ExtremalMapOntoSurface result;
    result.target = circle_domain_chart(target, outer);
    const OntoOptions own = on_circles(options, target, result.target);
    OntoProblem problem(source, own);
    result.plane = problem.solve(*target_model(circle_target(result.target), 0));
    result.plane.factorizations += result.target.factorizations;
    const std::vector<Complex> images(result.plane.map.begin(), result.plane.map.end());
    result.places = locate_in_chart(target, result.target.chart.vertices, images);
    result.positions = positions_on(target.mesh, result.places);
    return result;
}

}  // namespace beltrami
