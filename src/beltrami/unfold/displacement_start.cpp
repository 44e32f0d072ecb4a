#include <beltrami/unfold/displacement_start.h>

#include <algorithm>

#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

/// z ↦ turn · z + shift.
struct Similarity {
    Complex turn, shift;
    Complex operator()(Complex z) const { return turn * z + shift; }
};

/// The one that fits prescribed images best; a shift where all of them are of one vertex or in one place.
Similarity fitting(const Eigen::VectorXcd& places, const BoundaryCondition& boundary) {
    Complex from = 0, to = 0, pairing = 0;
    double spread = 0;
    const auto count = static_cast<double>(boundary.vertices.size());
    if (boundary.vertices.empty()) return {1.0, 0.0};
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
        from += places[boundary.vertices[i]] / count;
        to += boundary.images[i] / count;
    }
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
        const Complex z = places[boundary.vertices[i]] - from;
        pairing += (boundary.images[i] - to) * std::conj(z);
        spread += std::norm(z);
    }
    const Complex turn = spread > 0 && std::norm(pairing) > 0 ? pairing / spread : 1.0;
    return {turn, to - turn * from};
}

}  // namespace

Eigen::VectorXcd displacement_start(const Surface& source, const Eigen::VectorXcd& places,
                                    const BoundaryCondition& boundary) {
    const Similarity similarity = fitting(places, boundary);
    Eigen::VectorXcd map = places.unaryExpr(similarity);
    Eigen::VectorXcd displacement = Eigen::VectorXcd::Zero(map.size());
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        displacement[boundary.vertices[i]] = boundary.images[i] - map[boundary.vertices[i]];
    for (const BoundaryCondition::Line& line : boundary.lines) {
        const Complex along = line.direction / std::abs(line.direction), to_point = line.point - map[line.vertex];
        displacement[line.vertex] = to_point - along * std::real(to_point * std::conj(along));
    }
    std::vector<Freedom> freedom = freedoms(boundary, source);
    std::replace(freedom.begin(), freedom.end(), Freedom::sliding, Freedom::fixed);

    Eigen::MatrixXd parts(map.size(), 2);
    parts << displacement.real(), displacement.imag();
    parts = detail::Laplacian(source.operators, detail::fixed_vertices(freedom)).extend(parts);
    displacement.real() = parts.col(0);
    displacement.imag() = parts.col(1);
    return map + displacement;
}

}  // namespace beltrami
