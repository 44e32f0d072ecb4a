#include <beltrami/solve/sphere_map_step.h>

#include <beltrami/solve/differential_weights.h>
#include <beltrami/solve/raised_corners.h>

namespace beltrami {

namespace {

std::vector<Freedom> pinned_freedoms(const Surface& source, std::span<const int> pinned) {
    std::vector<Freedom> freedoms(static_cast<std::size_t>(source.mesh.vertex_count()), Freedom::fixed);
    for (const int v : source.mesh.faces.vertices()) freedoms[v] = Freedom::free;
    for (const int v : pinned) freedoms[v] = Freedom::fixed;
    return freedoms;
}

}  // namespace

SphereMapStep::SphereMapStep(const Surface& source, std::span<const int> pinned, Positions points)
    : source_(source),
      shapes_(operators_from_corners(source.mesh, raised_corners(source))),
      barrier_(shapes_, pinned_freedoms(source, pinned), Eigen::VectorXcd::Zero(shapes_.sample_count()),
               source.operators.weights),
      weights_(source.operators.weights),
      points_(std::move(points)) {}

void SphereMapStep::weigh(const Eigen::VectorXcd& phi) {
    weights_ = weights_of_differential(source_.operators.weights, phi);
}

void SphereMapStep::solve(const Eigen::VectorXcd& nu, double /*tolerance*/) {
    barrier_.aim(nu, weights_);
    last_length_ = barrier_.step(points_).length;
}

}  // namespace beltrami
