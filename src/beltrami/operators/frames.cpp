#include <beltrami/operators/frames.h>

#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

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
    return mu;
}

}  // namespace beltrami
