#include <beltrami/teichmuller/torus_map.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

void require_vertex(const Surface& surface, int vertex, const char* of) {
    const auto& vertices = surface.mesh.faces.vertices();
    if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end())
        throw Error(Cause::bad_option,
                    "the " + std::string(of) + " has no vertex " + std::to_string(vertex) + " in a face",
                    "name another one", {Things::vertices, {vertex}});
}

/// The affine map in lattice coordinates: x → M x + offset.
struct LatticeMap {
    Eigen::Matrix2d matrix;
    Eigen::RowVector2d offset;

    LatticeMap(const FlatTorus& source, const FlatTorus& target, const TorusMarking& marking,
               const std::array<int, 2>& vertices)
        : matrix(marking.cast<double>()), offset(0, 0) {
        if (vertices[0] >= 0) offset -= source.lattice.row(vertices[0]) * matrix.transpose();
        if (vertices[1] >= 0) offset += target.lattice.row(vertices[1]);
    }
    Positions operator()(const Positions& points) const {
        Positions images = points * matrix.transpose();
        images.rowwise() += offset;
        return images;
    }
};

Eigen::VectorXcd in_plane(const Positions& lattice, Complex tau) {
    return lattice.col(0).cast<Complex>() + tau * lattice.col(1).cast<Complex>();
}

/// Lattice coordinates of the corners where the faces of the layout lie.
Positions layout_lattice(const FlatTorus& torus) {
    Positions result(static_cast<Eigen::Index>(torus.layout.corners.size()), 2);
    for (std::size_t c = 0; c < torus.layout.corners.size(); ++c) {
        const auto z = torus.layout.points.row(torus.layout.corners[c]);
        const double beta = z[1] / torus.tau.imag();
        result.row(static_cast<Eigen::Index>(c)) << z[0] - torus.tau.real() * beta, beta;
    }
    return result;
}

}  // namespace

TorusMap torus_map(const Surface& source, const FlatTorus& flat_source, const Surface& target,
                   const FlatTorus& flat_target, const TorusMapOptions& options) {
    TorusMap result;
    result.marking = options.marking.value_or(nearest_marking(flat_source.tau, flat_target.tau));
    if (result.marking.determinant() != 1)
        throw Error(Cause::bad_option,
                    "the marking has determinant " + std::to_string(result.marking.determinant()) +
                        ", and that of maps that keep the orientation is 1",
                    "give another one");
    if (options.vertices[0] >= 0) require_vertex(source, options.vertices[0], "source");
    if (options.vertices[1] >= 0) require_vertex(target, options.vertices[1], "target");
    result.target_tau = tau_in_basis(flat_target.tau, result.marking);
    const Complex from = flat_source.tau, to = result.target_tau;
    const double distance = hyperbolic_distance(from, to), error = flat_source.tau_error + flat_target.tau_error;
    result.K = std::exp(distance);
    result.k = std::tanh(0.5 * distance);
    result.K_lower = std::exp(std::max(0.0, distance - error));
    result.K_upper = std::exp(distance + error);
    result.mu = -(to - from) / (to - std::conj(from));

    const LatticeMap map(flat_source, flat_target, result.marking, options.vertices);
    const Positions images = map(flat_source.lattice);
    result.map = in_plane(images, flat_target.tau);
    result.distortion = distortion(per_corner(source.operators, source.mesh.faces),
                                   in_plane(map(layout_lattice(flat_source)), flat_target.tau));
    result.places = places_on_torus(flat_target, images);
    result.measure(source, target, result.distortion.mu);
    result.factorizations = flat_source.factorizations + flat_target.factorizations;
    warn_of_folds_and_limit({}, result);
    return result;
}

TorusMap torus_map(const Surface& source, const Surface& target, const TorusMapOptions& options) {
    return torus_map(source, flat_torus(source), target, flat_torus(target), options);
}

TorusDistances torus_distances(const std::vector<Surface>& surfaces, const std::vector<std::string>& names) {
    const auto n = static_cast<int>(surfaces.size());
    if (n < 2) throw Error(Cause::bad_option, "a distance needs two shapes");
    TorusDistances result;
    std::vector<double> errors;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        try {
            const FlatTorus torus = flat_torus(surfaces[i]);
            result.tau.push_back(torus.tau);
            errors.push_back(torus.tau_error);
        } catch (const Error& error) {
            const std::string name = i < names.size() ? names[i] : "shape " + std::to_string(i);
            throw Error(error.cause(), name + ": " + error.what(), {}, {Things::shapes, {static_cast<int>(i)}});
        }
    }
    result.matrix.distance = result.matrix.lower = result.matrix.upper = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j) {
            const TorusMarking marking = nearest_marking(result.tau[i], result.tau[j]);
            const double twice = hyperbolic_distance(result.tau[i], tau_in_basis(result.tau[j], marking)),
                         error = errors[i] + errors[j];
            const auto set = [&](Eigen::MatrixXd& matrix, double value) { matrix(i, j) = matrix(j, i) = 0.5 * value; };
            set(result.matrix.distance, twice);
            set(result.matrix.lower, std::max(0.0, twice - error));
            set(result.matrix.upper, twice + error);
            result.markings.push_back({i, j, marking});
        }
    return result;
}

}  // namespace beltrami
