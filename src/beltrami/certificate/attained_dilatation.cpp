#include <beltrami/certificate/attained_dilatation.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/certificate/refined_problem.h>

namespace beltrami {

namespace {

/// The bound of K may be above what is attained by this part.
constexpr double kClose = 1e-3;
/// How often a quad is divided into four for that.
constexpr int kDepth = 9;

/// A bilinear function on a square by its values at (0, 0), (1, 0), (1, 1), (0, 1).
using Bilinear = std::array<Complex, 4>;

Bilinear quarter(const Bilinear& f, int corner) {
    const Complex centre = 0.25 * (f[0] + f[1] + f[2] + f[3]);
    Bilinear result;
    for (int i = 0; i < 4; ++i)
        result[i] = i == corner ? f[corner] : i == (corner + 2) % 4 ? centre : 0.5 * (f[corner] + f[i]);
    return result;
}

/// The Bernstein coefficients of |f|², of degree 2 in each direction.
std::array<double, 9> square_of(const Bilinear& f) {
    const Complex at[2][2] = {{f[0], f[3]}, {f[1], f[2]}};
    constexpr double kBinomial[3] = {1, 2, 1};
    std::array<double, 9> result{};
    for (int s = 0; s < 2; ++s)
        for (int t = 0; t < 2; ++t)
            for (int u = 0; u < 2; ++u)
                for (int v = 0; v < 2; ++v)
                    result[3 * (s + t) + u + v] +=
                        std::real(at[s][u] * std::conj(at[t][v])) / (kBinomial[s + t] * kBinomial[u + v]);
    return result;
}

double dilatation_of_square(double square) {
    return square < 1 ? dilatation(std::sqrt(std::max(square, 0.0))) : kInfinity;
}

/// |μ|² at the worst corner.
double attained_by(const Bilinear& p, const Bilinear& q) {
    double square = 0;
    for (int i = 0; i < 4; ++i) {
        const double below = std::norm(q[i]);
        square = std::max(square, below > 0 ? std::norm(p[i]) / below : kInfinity);
    }
    return square;
}

/// A number that K nowhere exceeds; infinite where it is not proved that there is one.
double bound_of(const Bilinear& p, const Bilinear& q, int depth) {
    const double attained = attained_by(p, q);
    if (!(attained < 1)) return kInfinity;
    const std::array<double, 9> above = square_of(p), below = square_of(q);
    double square = 0;
    for (std::size_t i = 0; i < above.size(); ++i)
        square = std::max(square, below[i] > 0 ? above[i] / below[i] : kInfinity);
    const double K = dilatation_of_square(square);
    if (depth == 0 || K <= (1 + kClose) * dilatation_of_square(attained)) return K;
    double largest = 1;
    for (int corner = 0; corner < 4; ++corner)
        largest = std::max(largest, bound_of(quarter(p, corner), quarter(q, corner), depth - 1));
    return largest;
}

/// The vectors from a corner of a quad to the next and the last one.
struct CornerSides {
    Eigen::RowVectorXd here_to_next, here_to_last;
    Complex next, last;  ///< of the image
};

CornerSides sides_at(const Positions& corners, const FaceList& faces, const Eigen::VectorXcd& map, int face,
                     int corner) {
    const int first = faces.first_corner(face), here = first + corner, next = first + (corner + 1) % 4,
              last = first + (corner + 3) % 4;
    const Complex image = map[faces.vertices()[here]];
    return {corners.row(next) - corners.row(here), corners.row(last) - corners.row(here),
            map[faces.vertices()[next]] - image, map[faces.vertices()[last]] - image};
}

/// K at a corner of a quad, infinite where it turns over.
double at_corner(const CornerSides& sides) {
    const double E = sides.here_to_next.squaredNorm(), G = sides.here_to_last.squaredNorm(),
                 F = sides.here_to_next.dot(sides.here_to_last), area = std::sqrt(std::max(0.0, E * G - F * F));
    const double energy = std::norm(sides.next) * G + std::norm(sides.last) * E -
                          2 * F * std::real(sides.next * std::conj(sides.last)),
                 image_area = std::imag(std::conj(sides.next) * sides.last);
    if (!(image_area > 0) || !(area > 0)) return kInfinity;
    return dilatation_of_square((energy - 2 * area * image_area) / (energy + 2 * area * image_area));
}

/// The bound of a quad in the plane.
double bound_in_plane(const Surface& source, const Eigen::VectorXcd& map, int face) {
    const auto v = source.mesh.faces[face];
    const Eigen::VectorXcd& x = *source.coordinate();
    Bilinear p, q;
    for (int i = 0; i < 4; ++i) {
        // Derivatives in the direction of the first side, and across it, at corner i.
        const int side = i < 2 ? 0 : 3, across = i == 0 || i == 3 ? 0 : 1;
        const auto along = [&](const Eigen::VectorXcd& f) { return side == 0 ? f[v[1]] - f[v[0]] : f[v[2]] - f[v[3]]; };
        const auto up = [&](const Eigen::VectorXcd& f) { return across == 0 ? f[v[3]] - f[v[0]] : f[v[2]] - f[v[1]]; };
        const Complex a = along(x), b = up(x), A = along(map), B = up(map);
        p[i] = a * B - b * A;
        q[i] = A * std::conj(b) - B * std::conj(a);
    }
    return bound_of(p, q, kDepth);
}

}  // namespace

AttainedDilatation attained_dilatation(const Surface& source, const Eigen::VectorXcd& map, const Distortion& measured) {
    AttainedDilatation result{measured.K_max(), true};
    if (all_triangles(source.mesh) || !std::isfinite(result.K)) return result;
    const FaceList& faces = source.mesh.faces;
    const Positions corners = source.metric ? *source.metric : corner_positions(source.mesh);
    for (int f = 0; f < faces.size(); ++f) {
        if (faces.degree(f) != 4) continue;
        const double bound = source.in_plane() ? bound_in_plane(source, map, f) : kInfinity;
        if (std::isfinite(bound)) {
            result.K = std::max(result.K, bound);
            continue;
        }
        result.rigorous = false;
        for (int c = 0; c < 4; ++c)
            if (const double K = at_corner(sides_at(corners, faces, map, f, c)); std::isfinite(K))
                result.K = std::max(result.K, K);
    }
    return result;
}

}  // namespace beltrami
