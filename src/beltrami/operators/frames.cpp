#include <beltrami/operators/frames.h>

#include <cmath>
#include <string>
#include <utility>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

constexpr double kOnSphere = 1e-6;  // how far from it a vertex may be

void require_on_sphere(const Mesh& mesh) {
    std::vector<int> off;
    for (const int v : mesh.faces.vertices())
        if (!(std::abs(mesh.point(v).norm() - 1) < kOnSphere)) off.push_back(v);
    if (off.empty()) return;
    const std::string first = "vertex " + std::to_string(off[0]);
    throw Error(Cause::bad_option,
                "coefficients are given in the stereographic frame, but " + first + " does not lie on the unit sphere",
                "give them in frames of the faces", {Things::vertices, std::move(off)});
}

/// The derivative of z = (x + iy)/(1 + x₃), at the point of the sphere below a point, along a direction there.
Complex stereographic_change(const Eigen::Vector3d& at, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d y = at.normalized();
    const Eigen::Vector3d change = (direction - direction.dot(y) * y) / at.norm();
    const double height = 1 + y.z();
    return (Complex(change.x(), change.y()) - Complex(y.x(), y.y()) * change.z() / height) / height;
}

}  // namespace

Eigen::VectorXcd first_edge_directions(const Surface& surface) {
    const Operators& operators = surface.operators;
    Eigen::VectorXcd directions = Eigen::VectorXcd::Ones(operators.sample_count());
    const Eigen::VectorXcd* z = surface.coordinate();
    if (!z) return directions;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto corners = operators.stencil(s);
        const Complex edge = (*z)[corners[1]] - (*z)[corners[0]];
        directions[s] = edge / std::abs(edge);
    }
    return directions;
}

Eigen::VectorXcd mu_along_first_edge(const Surface& surface, const Eigen::VectorXcd& mu) {
    return mu.array() * first_edge_directions(surface).array().conjugate().square();
}

Eigen::VectorXcd phi_along_first_edge(const Surface& surface, const Eigen::VectorXcd& phi) {
    return phi.array() * first_edge_directions(surface).array().square();
}

Eigen::VectorXcd stereographic_derivatives(const Surface& surface) {
    require_on_sphere(surface.mesh);
    const Operators& operators = surface.operators;
    Eigen::VectorXcd result(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero(), x = middle, y = middle;
        const auto stencil = operators.stencil(s);
        for (const int v : stencil) middle += surface.mesh.point(v) / static_cast<double>(stencil.size());
        const auto gradient = operators.gradient(s);
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const Eigen::Vector3d from_middle = surface.mesh.point(stencil[j]) - middle;
            x += gradient[j].real() * from_middle;
            y += gradient[j].imag() * from_middle;
        }
        result[s] = 0.5 * (stereographic_change(middle, x) - Complex(0, 1) * stereographic_change(middle, y));
    }
    return result;
}

Eigen::VectorXcd mu_at_samples(const Surface& surface, const Eigen::VectorXcd& face_mu, CoefficientFrame frame) {
    const Operators& operators = surface.operators;
    if (face_mu.size() != operators.face_count)
        throw Error(Cause::bad_option, "there are " + std::to_string(face_mu.size()) + " coefficients for " +
                                           std::to_string(operators.face_count) + " faces");
    if (frame == CoefficientFrame::plane && !surface.in_plane())
        throw Error(Cause::bad_option,
                    "the coefficients are given in the frame of a plane, in which the surface does not lie",
                    "give them in frames of the faces");
    Eigen::VectorXcd mu(operators.sample_count());
    for (int s = 0; s < operators.sample_count(); ++s) mu[s] = face_mu[operators.faces[s]];
    if (frame == CoefficientFrame::first_edge) mu.array() *= first_edge_directions(surface).array().square();
    if (frame == CoefficientFrame::stereographic) {
        const Eigen::VectorXcd dz = stereographic_derivatives(surface);
        mu.array() *= dz.array().conjugate() / dz.array();
    }
    return mu;
}

}  // namespace beltrami
