#include <beltrami/space/unrolled_map.h>

#include <cmath>
#include <utility>

#include <beltrami/operators/distortion.h>
#include <beltrami/space/uniform_iteration.h>
#include <beltrami/space/unrolled_problem.h>

namespace beltrami {

std::optional<UnrolledPlaces> unrolled_places(const ParametricTarget& target, const FaceList& faces,
                                              const Target::Points& points) {
    const std::optional<ParametricTarget::Unrolled> plane = target.unrolled();
    if (!plane) return {};
    UnrolledPlaces result{Eigen::VectorXcd(points.size()), Eigen::VectorXcd::Zero(faces.corner_count())};
    for (std::size_t v = 0; v < points.size(); ++v) {
        const Eigen::Vector2d at = plane->unit.cwiseProduct(points[v].parameters);
        result.vertices[static_cast<Eigen::Index>(v)] = {at.x(), at.y()};
    }
    const auto turns = [](double away, double turn) { return turn > 0 ? -turn * std::round(away / turn) : 0.0; };
    for (int f = 0; f < faces.size(); ++f)
        for (int j = 1; j < faces.degree(f); ++j) {
            const Complex away = result.vertices[faces[f][j]] - result.vertices[faces[f][0]];
            result.turns[faces.first_corner(f) + j] = {turns(away.real(), plane->turns.x()),
                                                       turns(away.imag(), plane->turns.y())};
        }
    return result;
}

Target::Points rolled_up(const ParametricTarget& target, const Eigen::VectorXcd& vertices) {
    const Eigen::Vector2d unit = target.unrolled().value().unit;
    Target::Points points;
    points.reserve(static_cast<std::size_t>(vertices.size()));
    for (const Complex& z : vertices) points.push_back(target.at(z.real() / unit.x(), z.imag() / unit.y()));
    return points;
}

Eigen::VectorXcd unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                              const std::vector<char>& fixed, const Eigen::VectorXcd& mu) {
    UnrolledProblem problem(source, elements, places, fixed);
    problem.solve(mu);
    return problem.map();
}

UnrolledMap uniform_unrolled_map(const Mesh& source, const CornerElements& elements, const UnrolledPlaces& places,
                                 const std::vector<char>& fixed, const UniformOptions& options) {
    options.validate();
    UnrolledProblem problem(source, elements, places, fixed);
    problem.solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
    UnrolledMap result;
    result.first = problem.map();
    const UniformRun run = iterate_to_uniform(
        elements, source,
        {[&](const Eigen::VectorXcd& mu) { problem.solve(mu); },
         [&] { return cut_off_means(elements.operators, beltrami_coefficient(problem.derivatives())); },
         [&](const Eigen::VectorXcd& from, const Eigen::VectorXcd& to) { return problem.best_step(from, to); }},
        options);
    result.vertices = problem.map();
    result.solves = 1 + run.solves;
    result.converged = run.converged;
    return result;
}

}  // namespace beltrami
