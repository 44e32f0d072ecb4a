#include <beltrami/space/uniform_map.h>

#include <cmath>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/mesh/edge_table.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/space/uniform_iteration.h>

namespace beltrami {

namespace {

/// |μ| counts as at most this, so that flipped faces do not spoil the mean.
constexpr double kMostMu = 0.98;

Complex phase_of(Complex z) {
    const double size = std::abs(z);
    return size > 0 ? z / size : Complex(0);
}

/// Coefficients of the faces in space, flipped ones cut off.
Eigen::VectorXcd face_coefficients(const Operators& operators, const Mesh& source, const Positions& map) {
    Mesh image;
    image.positions = map;
    image.faces = source.faces;
    return cut_off_means(operators, beltrami_coefficient(derivatives(operators, map, vertex_normals(image))));
}

}  // namespace

void UniformOptions::validate() const {
    if (max_iterations < 0) throw Error(Cause::bad_option, "the number of iterations is negative");
    if (!(tolerance >= 0)) throw Error(Cause::bad_option, "the tolerance is negative");
    if (smoothing_passes < 0) throw Error(Cause::bad_option, "the number of smoothing passes is negative");
}

Eigen::VectorXcd smoothed_over_edges(const CornerElements& elements, const Mesh& mesh, const Eigen::VectorXcd& mu,
                                     int passes) {
    const EdgeTable edges = edge_table(mesh.faces, mesh.vertex_count());
    const int faces = mesh.face_count();
    double mean = 0;
    Eigen::VectorXcd phase(faces);
    for (int f = 0; f < faces; ++f) {
        mean += std::abs(mu[f]) / faces;
        phase[f] = phase_of(mu[f]);
    }
    for (int pass = 0; pass < passes; ++pass) {
        Eigen::VectorXcd on_edge = Eigen::VectorXcd::Zero(edges.edge_count());
        for (int e = 0; e < edges.edge_count(); ++e) {
            for (const int c : edges.corners_of(e)) {
                const Complex direction = elements.edge_direction[c];
                on_edge[e] += std::conj(direction * direction) * phase[edges.corner_faces[c]];
            }
            on_edge[e] /= static_cast<double>(edges.corners_of(e).size());
        }
        for (int f = 0; f < faces; ++f) {
            Complex sum = 0;
            for (int c = mesh.faces.first_corner(f); c < mesh.faces.first_corner(f) + mesh.faces.degree(f); ++c)
                sum += elements.edge_direction[c] * elements.edge_direction[c] * on_edge[edges.corner_edges[c]];
            phase[f] = phase_of(sum);
        }
    }
    return mean * phase;
}

Eigen::VectorXcd cut_off_means(const Operators& operators, Eigen::VectorXcd mu) {
    for (Complex& value : mu) {  // ∂f = 0
        if (!std::isfinite(std::abs(value))) value = kMostMu;
    }
    mu = face_means(operators, mu);
    for (Complex& value : mu) {
        const double size = std::abs(value);
        if (size > kMostMu) value *= kMostMu / size;
    }
    return mu;
}

UniformRun iterate_to_uniform(const CornerElements& elements, const Mesh& source, const UniformSteps& steps,
                              const UniformOptions& options) {
    const Operators& operators = elements.operators;
    UniformRun run;
    run.wanted = Eigen::VectorXcd::Zero(source.face_count());
    for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
        const Eigen::VectorXcd mu = steps.coefficients();
        Eigen::VectorXcd next = smoothed_over_edges(elements, source, mu, options.smoothing_passes);
        if (options.progress && !options.progress(iteration, mu.cwiseAbs().mean()))
            throw Error(Cause::cancelled, "cancelled after iteration " + std::to_string(iteration));
        if (options.line_search)
            next = run.wanted + steps.best_step(face_values_at_samples(operators, run.wanted),
                                                face_values_at_samples(operators, next)) *
                                    (next - run.wanted);
        const double change = (next - run.wanted).cwiseAbs().mean();
        run.wanted = std::move(next);
        if (iteration > 1 && change < options.tolerance) {
            run.converged = true;
            break;
        }
        steps.solve(face_values_at_samples(operators, run.wanted));
        ++run.solves;
    }
    return run;
}

UniformMap uniform_map(LeastSquaresMap& problem, const Mesh& source, const UniformOptions& options) {
    options.validate();
    const CornerElements& elements = problem.elements();
    UniformMap result;
    result.map = result.first = problem.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
    UniformRun run = iterate_to_uniform(elements, source,
                                        {[&](const Eigen::VectorXcd& mu) { result.map = problem.solve(mu); },
                                         [&] { return face_coefficients(elements.operators, source, result.map); },
                                         [&](const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) {
                                             return problem.best_step(from, to, result.map);
                                         }},
                                        options);
    result.wanted = std::move(run.wanted);
    result.solves = 1 + run.solves;
    result.converged = run.converged;
    return result;
}

}  // namespace beltrami
