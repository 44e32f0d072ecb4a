#include <beltrami/teichmuller/extremal_unrolled.h>

#include <algorithm>
#include <memory>
#include <utility>

#include <beltrami/certificate/certificate.h>
#include <beltrami/charts/annulus_map.h>
#include <beltrami/differentials/strip_space.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/space/unrolled_map_step.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

namespace {

/// Edges of the shorter loop to a turn of e^{inw}.
constexpr double kEdgesPerUnrolledTurn = 2.66;
constexpr int kLeastUnrolledDegree = 3, kMostUnrolledDegree = 18;
constexpr double kUnrolledTolerance = 1e-3, kUnrolledToleranceOfK = 1e-5;
constexpr int kMostUnrolledIterations = 50;
constexpr int kUnrolledClusters = 1500;

int degree_of_strip(const Surface& source) {
    const auto& loops = source.topology.boundary_loops;
    const int edges = static_cast<int>(std::min(loops[0].size(), loops[1].size()));
    return std::clamp(static_cast<int>(edges / kEdgesPerUnrolledTurn), kLeastUnrolledDegree, kMostUnrolledDegree);
}

}  // namespace

ExtremalMap extremal_unrolled_map(const Surface& source, const CornerElements& elements, const UnrolledPlaces& places,
                                  const std::vector<char>& fixed, const Progress& progress) {
    Surface corners = source;
    corners.operators = elements.operators;
    const AnnulusStrip strip = annulus_strip(source, 0);
    const auto chart = std::make_shared<const Chart>(make_atlas(corners, strip.corners));
    CoefficientStep coefficient_step(corners, *chart, {}, 0, kUnrolledClusters);
    UnrolledMapStep step(source.mesh, elements, places, fixed);
    HamiltonIteration::Options options;
    options.tolerance = kUnrolledTolerance;
    options.k_tolerance = kUnrolledToleranceOfK;
    options.max_iterations = kMostUnrolledIterations;
    options.anderson_window = 0;
    options.grow_first = options.grow_last = false;
    options.progress = progress;
    HamiltonIteration iteration(step, coefficient_step, std::move(options));
    HamiltonState state;
    // From its values at the samples: along a strip φ falls to a thousandth of its mean and less, of which the c-step
    // rounds off less where it is tabulated.
    const auto space = std::make_shared<const StripSpace>(degree_of_strip(source), strip.height);
    iteration.run(state, std::make_unique<TabulatedSpace>(space->generators({chart->positions, chart->derivatives}),
                                                          Coefficients::complex));

    ExtremalMap result;
    result.map = step.map();
    const MapDerivatives derivatives = step.derivatives();
    result.distortion = distortion(elements.operators, derivatives);
    result.termination = iteration.converged() ? Termination::converged : Termination::iteration_limit;
    result.iterations = iteration.iterations();
    result.factorizations = step.factorization_count() + 2;  // of the strip
    result.warnings = chart->warnings;
    result.history = iteration.history();
    result.phi = iteration.last_step().phi;
    result.differential = {space, chart, iteration.last_step().direction, {}, {}};
    result.dimension = 2 * space->size();
    result.k = iteration.last_step().k;
    const ReichStrebel integrals = reich_strebel(corners, result.differential, derivatives);
    result.K_max = result.distortion.K_max();
    result.K = std::min(dilatation(result.k), result.K_max);
    result.k = k_of(result.K);
    if (integrals.valid) {
        result.K_lower = std::clamp(integrals.lower, 1.0, result.K);
        result.bounds.push_back({Bound::Kind::reich_strebel, result.K_lower, Bound::Of::extremal, false});
        result.bounds.push_back({Bound::Kind::reich_strebel_estimate, integrals.estimate, Bound::Of::extremal, false});
    }
    return result;
}

}  // namespace beltrami
