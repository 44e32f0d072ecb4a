#include <beltrami/teichmuller/quadratic_products.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/certificate/quadratic_map.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/teichmuller/crowding.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

namespace {

/// Samples of a triangle (quadratic_operators).
constexpr int kSamplesOfTriangle = 3;
/// Samples that are held may have this part of ∫|φ|.
constexpr double kMostHeld = 1e-3;
/// φ rounded off as in the rough iteration before, and a c-step solved to this part of the last change of φ.
constexpr double kQuadraticRounding = 0.005, kQuadraticStep = 0.2;
/// The system is factorised for the harmonic functions and for each map.
constexpr int kFactorizationsExpected = 8;

/// The surface with quadratic elements: nodes are vertices, then the midpoints of edges.
Surface with_quadratic_elements(const Surface& source) {
    Surface result = source;
    result.operators = quadratic_operators(source);
    for (const auto& beside : source.topology.edge_faces)
        result.topology.on_boundary.push_back(beside[0] < 0 || beside[1] < 0);
    return result;
}

/// The vertices and midpoints of the rim.
std::vector<RimNode> quadratic_rim_nodes(const Surface& source, const Eigen::VectorXcd& map) {
    const std::vector<RimNode> vertices = rim_nodes(source, map);
    const auto& edges = source.topology.edges;
    std::vector<RimNode> rim;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const RimNode &from = vertices[i], &to = vertices[(i + 1) % vertices.size()];
        const std::array<int, 2> ends{std::min(from.node, to.node), std::max(from.node, to.node)};
        const auto edge = std::lower_bound(edges.begin(), edges.end(), ends) - edges.begin();
        rim.push_back(from);
        rim.push_back({source.mesh.vertex_count() + static_cast<int>(edge),
                       0.5 * (from.way + (i + 1 < vertices.size() ? to.way : kTurn))});
    }
    return rim;
}

/// The coefficients of the combination of orthonormal columns that is nearest to a φ that is constant on triangles.
Eigen::VectorXcd projected(const Operators& operators, const Eigen::MatrixXcd& columns, const Eigen::VectorXcd& phi) {
    Eigen::VectorXcd weighted(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) weighted[s] = operators.weights[s] * phi[s / kSamplesOfTriangle];
    const Eigen::VectorXcd coefficients = columns.adjoint() * weighted;
    const double length = coefficients.norm();
    return length > 0 ? Eigen::VectorXcd(coefficients / length) : coefficients;
}

/// The integrals, with |μ| held.
void integrate(const Operators& operators, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi, double clip,
               QuadraticProducts& result) {
    double total = 0, norm = 0, pairing = 0, held = 0;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const double mass = operators.weights[s] * std::abs(phi[s]), size = std::abs(mu[s]);
        Complex m = mu[s];
        if (!(size <= clip)) {
            m = std::isfinite(size) ? Complex(mu[s] * (clip / size)) : Complex(clip);
            held += mass;
        }
        const double square = std::norm(m);
        total += mass;
        norm += mass * (1 + square) / (1 - square);
        pairing += operators.weights[s] * 2 * std::real(m * phi[s]) / (1 - square);
    }
    result.integrals = reich_strebel_of(total, norm, pairing, total);
    result.held = total > 0 ? held / total : 0;
    result.integrals.valid = result.integrals.valid && result.held <= kMostHeld;
}

/// Means over the samples of each triangle.
Eigen::MatrixXcd over_triangles(const Eigen::MatrixXcd& values) {
    Eigen::MatrixXcd means(values.rows() / kSamplesOfTriangle, values.cols());
    for (Eigen::Index f = 0; f < means.rows(); ++f)
        means.row(f) = values.middleRows(kSamplesOfTriangle * f, kSamplesOfTriangle).colwise().mean();
    return means;
}

}  // namespace

QuadraticProducts quadratic_products(const Surface& source, const BoundaryCondition& boundary,
                                     const Eigen::VectorXcd& harmonic, const Eigen::VectorXcd& phi, double k,
                                     const QuadraticProductsOptions& options) {
    QuadraticProducts result;
    const Surface quadratic = with_quadratic_elements(source);
    const Operators& operators = quadratic.operators;
    const int samples = operators.sample_count();
    std::vector<Freedom> freedom(static_cast<std::size_t>(operators.vertex_count), Freedom::free);
    for (std::size_t n = 0; n < freedom.size(); ++n)
        if (quadratic.topology.on_boundary[n]) freedom[n] = Freedom::fixed;
    BeltramiSolver solver(quadratic, std::move(freedom), kFactorizationsExpected);
    solver.factorize(Eigen::VectorXcd::Zero(samples));

    const QuadraticMap prescribed = straight(source, prescribed_values(boundary, source));
    const QuadraticMap harmonic_nodes = straight(source, harmonic);
    auto space =
        std::make_shared<TabulatedSpace>(form_product_space(operators, quadratic_rim_nodes(source, harmonic), solver));
    HamiltonState state{space, projected(operators, *space->tabulated(), phi), k};

    Chart places;
    places.vertices = harmonic_nodes;
    const Chart chart = uncrowded(quadratic, std::move(places), harmonic_nodes);
    // Every sample by itself: Newton's method with means over several takes ten times the steps.
    CoefficientStep coefficient_step(quadratic, chart, {}, 0, samples);
    coefficient_step.set_clip(options.clip);
    coefficient_step.set_least_rounding(kQuadraticRounding);
    FixedMapStep map_step(quadratic, solver);
    map_step.prescribe(prescribed, {});
    map_step.set_map(harmonic_nodes);

    HamiltonIteration::Options how;
    how.tolerance = options.tolerance;
    how.k_tolerance = options.tolerance * options.tolerance;
    how.max_iterations = options.max_iterations;
    how.step_below_change = kQuadraticStep;
    how.grow_first = how.grow_last = false;
    how.progress = options.progress;
    HamiltonIteration iteration(map_step, coefficient_step, how);
    iteration.run(state, nullptr);

    const CoefficientStep::Result& last = iteration.last_step();
    integrate(operators, beltrami_coefficient(map_step.derivatives()), last.phi, options.clip, result);
    result.space = std::make_shared<TabulatedSpace>(over_triangles(*space->tabulated()), Coefficients::complex);
    result.direction = last.direction;
    result.phi = *result.space->tabulated() * last.direction;
    result.k = last.k;
    result.history.assign(iteration.history().begin() + 1, iteration.history().end());
    result.settled = iteration.converged();
    result.factorizations = solver.factorization_count();
    return result;
}

}  // namespace beltrami
