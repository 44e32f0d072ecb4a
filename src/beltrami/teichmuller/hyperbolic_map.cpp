#include <beltrami/teichmuller/hyperbolic_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/differentials/holomorphic_products.h>
#include <beltrami/differentials/hyperbolic_space.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/fold_opening.h>
#include <beltrami/hyperbolic/hyperbolic_places.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

namespace {

constexpr double kHyperbolicTolerance = 1e-6, kHyperbolicToleranceOfK = 1e-2;
constexpr double kUnresolvedK = 1e-3;  // part of K by which it may be below the homology bound

HamiltonIteration::Options iteration_options(const HyperbolicMapOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = options.tolerance > 0 ? options.tolerance : kHyperbolicTolerance;
    result.k_tolerance = kHyperbolicToleranceOfK * result.tolerance;
    result.max_iterations = options.max_iterations;
    result.anderson_window = options.anderson_window;
    result.grow_first = result.grow_last = false;
    result.progress = options.progress;
    return result;
}

void record_bounds(const Surface& source, HyperbolicMap& result) {
    const ReichStrebel integrals = reich_strebel(source, result.differential, result.distortion.mu);
    if (!integrals.valid) return;  // faces are flipped
    result.K_lower = std::clamp(integrals.lower, 1.0, result.K);
    result.K_upper = std::max(integrals.upper, result.K);
}

std::optional<SplitProblem> bridges_of(const Surface& surface) {
    if (surface.topology.boundary_loops.empty()) return {};
    SplitProblem split = split_bridges(surface);
    if (split.split_edges == 0) return {};
    require_triangles(surface);
    return split;
}

/// Places on the faces of the target as it was given.
std::vector<MeshPoint> on_given_faces(const HyperbolicShape& target, std::vector<MeshPoint> places) {
    if (!target.split()) return places;
    const SplitProblem& split = *target.split();
    const Mesh& given = target.given().mesh;
    for (MeshPoint& place : places) {
        const int face = split.face_parents[place.face];
        const auto corners = given.faces[face];
        MeshPoint there{face, {corners[0], corners[1], corners[2]}, {}};
        const auto add = [&](int vertex, double weight) {
            for (std::size_t k = 0; k < 3; ++k)
                if (there.vertices[k] == vertex) there.barycentric[k] += weight;
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const int added = place.vertices[k] - given.vertex_count();
            if (added < 0) {
                add(place.vertices[k], place.barycentric[k]);
                continue;
            }
            const std::array<int, 4>& parents = split.parents[added];
            for (const int parent : {parents[0], parents[1]}) add(parent, 0.5 * place.barycentric[k]);
        }
        place = there;
    }
    return places;
}

/// |μ| weighed by |φ|.
void weigh_by_phi(const Surface& source, HyperbolicMap& result) {
    std::vector<double> weights = source.operators.weights;
    if (!result.differential.zero())
        for (Eigen::Index s = 0; s < result.phi.size(); ++s)
            weights[static_cast<std::size_t>(s)] *= std::abs(result.phi[s]);
    const MuStatistics statistics = mu_statistics(result.distortion.mu, weights);
    result.weighted_mean = statistics.mean;
    result.weighted_deviation = statistics.standard_deviation;
}

}  // namespace

HyperbolicShape::HyperbolicShape(const Surface& surface)
    : given_(surface),
      split_(bridges_of(surface)),
      split_surface_(split_ ? std::optional(surface_of(split_->mesh, split_->metric)) : std::nullopt),
      metric_(hyperbolic_surface(this->surface())),
      forms_(harmonic_basis(this->surface())) {}

const HyperbolicShape::Differentials& HyperbolicShape::differentials() const {
    if (!differentials_) {
        HyperbolicSpace found = hyperbolic_space(surface(), metric_);
        // The kernel tells that the mesh resolves all of them; products are more exact.
        std::optional<TabulatedSpace> products;
        if (!metric_.has_boundary()) products = holomorphic_products(surface(), period_matrix(surface(), forms_));
        TabulatedSpace& best = products ? *products : found.space;
        differentials_ = {std::make_shared<TabulatedSpace>(std::move(best)), found.kernel, found.next, found.solves};
    }
    return *differentials_;
}

double homology_bound(const HyperbolicShape& source, const HyperbolicShape& target, const Eigen::MatrixXi& homology) {
    // Row l has the class of the image of loop l.
    const Eigen::MatrixXd P = homology.cast<double>();
    const bool kept = homology * target.forms().homology.intersections * homology.transpose() ==
                      source.forms().homology.intersections;
    if (!kept || !(std::abs(std::abs(P.determinant()) - 1) < 0.5))
        throw Error(Cause::bad_option,
                    "the start is not of degree 1: it does not keep the intersection numbers of loops",
                    "bring the source nearer to the target (by an alignment, say), tell the class by a start or by "
                    "loops, or turn the faces of one surface round");
    const Eigen::VectorXd values =
        symmetric_eigen(target.forms().energies, P.transpose() * source.forms().energies * P).values;
    return std::max(values[values.size() - 1], 1 / values[0]);
}

namespace {

void require_same_topology(const HyperbolicShape& source, const HyperbolicShape& target) {
    const Topology &here = source.surface().topology, &there = target.surface().topology;
    if (here.genus != there.genus)
        throw Error(
            Cause::bad_mesh,
            "the source has genus " + std::to_string(here.genus) + ", the target " + std::to_string(there.genus),
            "take surfaces of one genus");
    if (here.boundary_loops.size() != there.boundary_loops.size())
        throw Error(Cause::bad_mesh,
                    "the source has " + std::to_string(here.boundary_loops.size()) + " boundary loops, the target " +
                        std::to_string(there.boundary_loops.size()),
                    "take surfaces with as many");
}

/// How far one comes along the boundary from its start, by steps that are translations along it.
double along_boundary(const DiskIsometry& step) {
    return 2 * std::atanh(step.place().real());
}

/// Every boundary loop must go once around one of the target's, the surface on the left.
void require_loops_onto_loops(const HyperbolicShape& source, const HyperbolicShape& target, const EquivariantMap& map) {
    const Topology& of_target = target.surface().topology;
    std::vector<int> loop_of(static_cast<std::size_t>(target.surface().mesh.vertex_count()), -1);
    const std::vector<double> lengths = boundary_lengths(target.metric(), of_target);
    for (std::size_t l = 0; l < lengths.size(); ++l)
        for (const int v : of_target.boundary_loops[l]) loop_of[v] = static_cast<int>(l);
    const Topology& topology = source.surface().topology;
    std::vector<char> reached(lengths.size(), 0);
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l) {
        const std::vector<int>& loop = topology.boundary_loops[l];
        double sum = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const int a = loop[i], b = loop[(i + 1) % loop.size()];
            const DiskIsometry& step = map.steps[static_cast<std::size_t>(edge_between(topology, a, b))];
            sum += along_boundary(a < b ? step : step.inverse());
        }
        const int partner = loop_of[map.bases[loop[0]]];
        const double turns = partner < 0 ? 0 : sum / lengths[partner];
        if (!(std::abs(turns - 1) < 1e-3) || reached[partner]++)
            throw Error(Cause::bad_option,
                        "the start takes boundary loop " + std::to_string(l) + " of the source " +
                            std::to_string(std::lround(turns)) + " times around one of the target, not once",
                        "turn the faces of one surface round, or bring the source nearer to the target",
                        {Things::loops, {static_cast<int>(l)}});
    }
}

}  // namespace

HyperbolicMap hyperbolic_map(const HyperbolicShape& source, const HyperbolicShape& target, EquivariantMap start,
                             const HyperbolicMapOptions& options) {
    require_same_topology(source, target);
    const Surface& surface = source.surface();
    require_loops_onto_loops(source, target, start);
    HyperbolicMap result;
    result.homology = periods_of_images(surface.topology, start, source.forms().homology.loops);
    result.K_homology = homology_bound(source, target, result.homology);

    EquivariantMapStep step(surface, std::move(start));
    result.start_steps = step.relax();
    result.energy = step.energy();
    const auto chart = std::make_shared<Chart>(chart_of_frames(surface));
    const auto& space = source.differentials().space;
    CoefficientStep coefficient_step(surface, *chart, {}, 0, surface.operators.sample_count(),
                                     CoefficientStep::Sums::over_samples);
    coefficient_step.set_space(*space);
    const CoefficientStep::Result first = coefficient_step.solve(beltrami_coefficient(step.derivatives()), {});
    HamiltonState state{space, first.direction, first.k};
    HamiltonIteration iteration(step, coefficient_step, iteration_options(options));
    iteration.run(state, nullptr);

    const CoefficientStep::Result& last = iteration.last_step();
    result.k = last.k;
    result.K = dilatation(last.k);
    result.phi = last.phi;
    result.differential = {space, chart, last.direction, {}, {}};
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;
    result.iterations = result.start_steps + iteration.iterations();
    result.factorizations = step.factorization_count();
    result.history = iteration.history();
    result.equivariant = step.map();
    if (open_folds(surface, result.equivariant) > 0) step.set_map(result.equivariant);
    result.distortion = distortion(surface.operators, step.derivatives());
    record_bounds(surface, result);
    weigh_by_phi(surface, result);

    result.places = on_given_faces(target, places_of(target.metric(), result.equivariant));
    result.measure(surface, target.given(), result.distortion.mu);
    if (source.split())
        result.warnings.push_back(
            {WarningKind::edges_split, counted(static_cast<std::size_t>(source.split()->split_edges), "edge", "edges") +
                                           " between boundary vertices split at the midpoint"});
    result.k_in_space = coefficient_step.solve(result.in_space.mu, last.direction).k;
    const bool below_bound = result.K_homology > result.K * (1 + kUnresolvedK);
    if (iteration.converged() && !result.one_to_one())
        result.termination = Termination::unconfirmed;
    else if (iteration.converged() && below_bound)
        result.termination = Termination::below_bound;
    if (below_bound)
        result.warnings.push_back({WarningKind::below_bound,
                                   "K is " + std::to_string(result.K) + ", and energies of harmonic forms ask for " +
                                       std::to_string(result.K_homology) +
                                       ": the meshes do not resolve the difference, K is below their resolution"});
    warn_of_folds_and_limit(std::to_string(iteration.iterations()) + " iterations before the map settled", result);
    return result;
}

Marking inverse_marking(const HyperbolicShape& source, const HyperbolicShape& target, const HyperbolicMap& map) {
    Mesh image = source.surface().mesh;
    image.positions = map.positions;
    const Mesh& of_target = target.surface().mesh;
    const Topology& of_target_topology = target.surface().topology;
    Positions points(of_target.vertex_count(), 3);
    for (int v = 0; v < of_target.vertex_count(); ++v) points.row(v) = of_target.point(v).transpose();
    return marking_by_vertices(target.surface(), target.metric().original, source.group(),
                               nearest_vertices(of_target_topology, source.surface().topology, image,
                                                source.metric().metric.triangles, points));
}

Distance hyperbolic_distance_of(const HyperbolicMap& there, const HyperbolicMap& back) {
    const auto half_log = [](double K) { return 0.5 * std::log(std::max(1.0, K)); };
    const auto settled = [](const HyperbolicMap& map) {
        return map.termination == Termination::converged && map.one_to_one();
    };
    Distance result{0.5 * (half_log(there.K) + half_log(back.K)),
                    std::max(half_log(there.K_lower), half_log(back.K_lower)),
                    std::min(half_log(there.K_upper), half_log(back.K_upper)), settled(there) && settled(back)};
    // Errors of second order can make the bounds of the two directions cross.
    if (result.lower > result.upper) std::swap(result.lower, result.upper);
    result.distance = std::clamp(result.distance, result.lower, result.upper);
    return result;
}

}  // namespace beltrami
