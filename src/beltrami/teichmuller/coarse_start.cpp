#include <beltrami/teichmuller/coarse_start.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/teichmuller/hamilton_options.h>
#include <beltrami/teichmuller/problem.h>

namespace beltrami {

namespace {

/// Triangles of the coarse mesh: a part of the samples, within limits.
constexpr int kCoarsePart = 7, kFewestTriangles = 1'200, kMostTriangles = 5'000;

/// The iteration ends there at this part of its bracket: a start need not be exact.
constexpr double kWithinCoarseBracket = 0.01;
/// From so many samples on a step costs more than all of another coarse mesh, of this part of the samples: there the
/// iteration goes on until it knows how f-step and c-step answer, which the fine one then need not learn.
constexpr int kAnsweredFrom = 300'000, kAnsweredPart = 50;
constexpr double kAnsweredChange = 1e-4;

/// Polynomials of this degree, until φ changes by less than this, at most so often.
constexpr int kRoughDegree = 8, kRoughCoarseIterations = 12;
constexpr double kRoughChange = 0.2;

/// The prescribed values along the canonical circle.
struct CircleValues {
    std::vector<double> angle;  ///< increasing, from 0 to below 2π, relative to the first
    std::vector<Complex> image;
    Complex first;

    Complex at(double turn) const {
        const auto next = std::upper_bound(angle.begin(), angle.end(), turn);
        const std::size_t i = static_cast<std::size_t>(next - angle.begin()) - 1, j = (i + 1) % angle.size();
        const double end = j == 0 ? kTurn : angle[j];
        return image[i] + (turn - angle[i]) / (end - angle[i]) * (image[j] - image[i]);
    }
};

/// @return empty if the loop does not run monotonically
CircleValues circle_values(const Surface& source, const BoundaryCondition& boundary, const Chart& chart) {
    const auto& loop = source.topology.boundary_loops[0];
    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    CircleValues values;
    values.first = chart.vertices[loop[0]] / std::abs(chart.vertices[loop[0]]);
    double angle = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        values.angle.push_back(angle);
        values.image.push_back(images[loop[i]]);
        const double step = std::arg(chart.vertices[loop[(i + 1) % loop.size()]] / chart.vertices[loop[i]]);
        if (!(step > 0)) return {};
        angle += step;
    }
    if (std::abs(angle - kTurn) > 1e-6) return {};
    return values;
}

}  // namespace

CoarseStart coarse_start(const Surface& source, const BoundaryCondition& boundary, const Chart& chart, double phase,
                         int largest_degree, const ExtremalOptions& options, int least_samples, bool grown) {
    if (source.operators.sample_count() < least_samples) return {};
    const CircleValues values = circle_values(source, boundary, chart);
    if (values.angle.empty()) return {};

    const int samples = source.operators.sample_count();
    const bool answered = samples >= kAnsweredFrom;
    Mesh mesh = disk(disk_rings_for_triangles(
        answered ? samples / kAnsweredPart : std::clamp(samples / kCoarsePart, kFewestTriangles, kMostTriangles)));
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z = std::polar(1.0, phase) * Complex(mesh.positions(v, 0), mesh.positions(v, 1));
        mesh.positions.row(v) << z.real(), z.imag();
    }
    const Surface model(std::move(mesh));
    BoundaryCondition coarse;
    for (const int v : model.topology.boundary_loops[0]) {
        const Complex z(model.mesh.positions(v, 0), model.mesh.positions(v, 1));
        double turn = std::arg(z / values.first);
        if (turn < 0) turn += kTurn;
        coarse.pin(v, values.at(turn));
    }
    ExtremalProblem problem(model, coarse, 1);
    problem.set_chart(round_disk_chart(model, problem.solver()));
    problem.set_singularities({}, options.cluster_count,
                              grown ? CoefficientStep::Sums::over_cells : CoefficientStep::Sums::over_samples);
    HamiltonIteration::Options coarse_options = iteration_options(options);
    coarse_options.progress = {};
    coarse_options.grow_last = false;
    coarse_options.within_bracket = answered ? 0 : kWithinCoarseBracket;
    adapt_to_smooth(options, coarse_options);
    if (answered) {
        coarse_options.tolerance = std::max(coarse_options.tolerance, kAnsweredChange);
        coarse_options.k_tolerance = std::max(coarse_options.k_tolerance, kAnsweredChange * kAnsweredChange);
    }
    problem.map_step().set_near(false);
    CoarseStart result;
    if (largest_degree > kRoughDegree) {
        // Where φ still turns about, few functions do as well, and cost a part of all.
        HamiltonIteration::Options rough = coarse_options;
        rough.tolerance = kRoughChange;
        rough.k_tolerance = kRoughChange * kRoughChange;
        rough.max_iterations = kRoughCoarseIterations;
        HamiltonIteration(problem.map_step(), problem.coefficient_step(), rough)
            .run(result.state, std::make_unique<PolynomialSpace>(kRoughDegree, kRoughDegree));
        result.state.space = std::make_unique<PolynomialSpace>(grown ? largest_degree : kRoughDegree, largest_degree);
        result.state.direction.conservativeResizeLike(Eigen::VectorXcd::Zero(result.state.space->size()));
    }
    HamiltonIteration iteration(problem.map_step(), problem.coefficient_step(), coarse_options);
    // The degrees that the fine mesh resolves: on the coarse one the highest are rough, which is good enough for a
    // start.
    iteration.run(result.state, grown ? std::make_unique<PolynomialSpace>(largest_degree, largest_degree)
                                      : problem.starting_space(largest_degree));
    if (!answered) result.state.acceleration.reset();  // it has seen too little of the iteration
    if (iteration.converged()) result.bracket_by_triangles = bracket(iteration.last_step()) * model.mesh.face_count();
    return result;
}

}  // namespace beltrami
