#include <beltrami/teichmuller/hyperbolic_map.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Dense>

#include <beltrami/base/error.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/differentials/holomorphic_products.h>
#include <beltrami/differentials/hyperbolic_space.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/hyperbolic_places.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

namespace {

constexpr double kTolerance = 1e-6, kToleranceOfK = 1e-2;

HamiltonIteration::Options iteration_options(const HyperbolicMapOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = options.tolerance > 0 ? options.tolerance : kTolerance;
    result.k_tolerance = kToleranceOfK * result.tolerance;
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
    : surface_(surface), metric_(hyperbolic_surface(surface)), forms_(harmonic_basis(surface)) {}

const HyperbolicShape::Differentials& HyperbolicShape::differentials() const {
    if (!differentials_) {
        HyperbolicSpace found = hyperbolic_space(surface_, metric_);
        // The kernel tells that the mesh resolves all of them; products are more exact.
        std::optional<TabulatedSpace> products = holomorphic_products(surface_, period_matrix(surface_, forms_));
        TabulatedSpace& best = products ? *products : found.space;
        differentials_ = {std::make_shared<TabulatedSpace>(std::move(best)), found.kernel, found.next, found.solves};
    }
    return *differentials_;
}

double homology_bound(const HyperbolicShape& source, const HyperbolicShape& target, const Eigen::MatrixXi& homology) {
    // The wedge products of forms that are dual to loops are the inverse of the intersections, transposed.
    const auto wedges = [](const HarmonicBasis& basis) {
        return Eigen::MatrixXd(basis.homology.intersections.cast<double>().inverse().transpose());
    };
    const Eigen::MatrixXd P = homology.cast<double>();
    const Eigen::MatrixXd pulled_back = P.transpose() * wedges(source.forms()) * P;
    if ((pulled_back - wedges(target.forms())).cwiseAbs().maxCoeff() > 0.5)
        throw Error(Cause::bad_option,
                    "the start is not of degree 1: it does not keep the intersection numbers of loops",
                    "turn the faces of one surface round, or give another start");
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratios(
        target.forms().energies, P.transpose() * source.forms().energies * P, Eigen::EigenvaluesOnly);
    const Eigen::VectorXd& values = ratios.eigenvalues();
    return std::max(values[values.size() - 1], 1 / values[0]);
}

HyperbolicMap hyperbolic_map(const HyperbolicShape& source, const HyperbolicShape& target, EquivariantMap start,
                             const HyperbolicMapOptions& options) {
    if (source.metric().genus != target.metric().genus)
        throw Error(Cause::bad_mesh,
                    "the source has genus " + std::to_string(source.metric().genus) + ", the target " +
                        std::to_string(target.metric().genus),
                    "take surfaces of one genus");
    const Surface& surface = source.surface();
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
    result.distortion = distortion(surface.operators, step.derivatives());
    result.equivariant = step.map();
    record_bounds(surface, result);
    weigh_by_phi(surface, result);

    result.places = places_of(target.metric(), result.equivariant);
    result.measure(surface, target.surface(), result.distortion.mu);
    result.k_in_space = coefficient_step.solve(result.in_space.mu, last.direction).k;
    warn_of_folds_and_limit(std::to_string(iteration.iterations()) + " iterations before the map settled", result);
    return result;
}

Marking inverse_marking(const HyperbolicShape& source, const HyperbolicShape& target, const HyperbolicMap& map) {
    Mesh image = source.surface().mesh;
    image.positions = map.positions;
    const Mesh& of_target = target.surface().mesh;
    Positions points(of_target.vertex_count(), 3);
    for (int v = 0; v < of_target.vertex_count(); ++v) points.row(v) = of_target.point(v).transpose();
    return marking_by_vertices(target.surface(), target.metric().original, source.group(),
                               nearest_vertices(image, source.metric().metric.triangles, points));
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
