#include <beltrami/certificate/modulus.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/mesh/strip.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

/// Images are on a side of a rectangle within this part of its size.
constexpr double kOnSide = 1e-12;
/// Largest cosine of an angle that is taken for a right one.
constexpr double kRight = 1e-9;

using detail::Laplacian;

/// The harmonic function that is 0 on some vertices and 1 on others, free elsewhere; its energy is returned.
double condenser(const Operators& operators, const std::vector<int>& at_zero, const std::vector<int>& at_one,
                 Eigen::VectorXd& u, int& factorizations) {
    std::vector<char> held(static_cast<std::size_t>(operators.vertex_count), 0);
    u.setZero(operators.vertex_count);
    for (const int v : at_zero) held[v] = 1;
    for (const int v : at_one) {
        held[v] = 1;
        u[v] = 1;
    }
    const Laplacian form(operators, held);
    factorizations += form.factorization_count();
    u -= form.solve(form.apply(u));
    return form.energy(u);
}

/// The energy of the harmonic function on a ring that grows by 1 around.
double period_energy(const Surface& ring, const Operators& operators, int& factorizations) {
    const FaceList& faces = ring.mesh.faces;
    const std::vector<double> offset = jumps_across_strip(ring.mesh, ring.topology, 0, 1);
    std::vector<char> held(static_cast<std::size_t>(operators.vertex_count), 0);
    held[operators.vertices.front()] = 1;
    const Laplacian form(operators, held);
    factorizations += form.factorization_count();
    // Samples of a face have its corners in order.
    const auto gradient_of = [&](int s, const Eigen::VectorXd& u) {
        Complex sum = 0;
        const int begin = operators.offsets[s], first = faces.first_corner(operators.faces[s]);
        for (int j = begin; j < operators.offsets[s + 1]; ++j)
            sum += (u[operators.vertices[j]] + offset[first + j - begin]) * operators.gradients[j];
        return sum;
    };
    Eigen::VectorXd force = Eigen::VectorXd::Zero(operators.vertex_count), u = force;
    for (int s = 0; s < operators.sample_count(); ++s) {
        const Complex along = operators.weights[s] * gradient_of(s, u);
        for (int j = operators.offsets[s]; j < operators.offsets[s + 1]; ++j)
            force[operators.vertices[j]] -= std::real(std::conj(operators.gradients[j]) * along);
    }
    u = form.solve(force);
    double energy = 0;
    for (int s = 0; s < operators.sample_count(); ++s) energy += operators.weights[s] * std::norm(gradient_of(s, u));
    return energy;
}

}  // namespace

Sides sides_between(const std::vector<int>& loop, const std::array<int, 4>& positions) {
    Sides sides;
    const int n = static_cast<int>(loop.size());
    for (int i = 0; i < 4; ++i) {
        const int from = positions[i];
        int to = positions[(i + 1) % 4];
        if (to <= from) to += n;
        for (int p = from; p <= to; ++p) sides[i].push_back(loop[p % n]);
    }
    return sides;
}

QuadrilateralPotentials quadrilateral_potentials(const Operators& operators, const Sides& sides) {
    QuadrilateralPotentials result;
    result.u_energy = condenser(operators, sides[3], sides[1], result.u, result.factorizations);
    result.v_energy = condenser(operators, sides[0], sides[2], result.v, result.factorizations);
    return result;
}

ModulusBracket quadrilateral_modulus(const Operators& operators, const Sides& sides) {
    const QuadrilateralPotentials potentials = quadrilateral_potentials(operators, sides);
    return {1 / potentials.u_energy, potentials.v_energy, potentials.factorizations};
}

ModulusBracket ring_modulus(const Surface& ring, const Operators& operators) {
    ModulusBracket result{};
    const auto& loops = ring.topology.boundary_loops;
    Eigen::VectorXd u;
    result.lower = 1 / condenser(operators, loops[0], loops[1], u, result.factorizations);
    result.upper = period_energy(ring, operators, result.factorizations);
    return result;
}

ModulusBracket ring_modulus(const Surface& ring) {
    return ring_modulus(ring, ring.operators);
}

double round_ring_modulus(Complex outer_centre, double outer_radius, Complex hole_centre, double hole_radius) {
    const double apart = std::norm(hole_centre - outer_centre),
                 c = (outer_radius * outer_radius + hole_radius * hole_radius - apart) /
                     (2 * outer_radius * hole_radius);
    return std::acosh(std::max(1.0, c)) / (2 * kPi);
}

double elliptic_ratio(double x, double complement) {
    const auto integral = [](double m1) {  // 𝒦 with parameter 1 − m1
        double a = 1, b = std::sqrt(m1);
        while (std::abs(a - b) > 1e-16 * a) {
            const double mean = 0.5 * (a + b);
            b = std::sqrt(a * b);
            if (mean == a) break;
            a = mean;
        }
        return kPi / (2 * a);
    };
    return integral(x) / integral(complement);
}

double disk_modulus(const std::array<double, 4>& t) {
    const auto chord = [&](int i, int j) { return std::abs(std::sin(0.5 * (t[j] - t[i]))); };
    const double all = chord(0, 2) * chord(1, 3);
    // Between arcs 30 and 12, cross ratio of their ends.
    const double x = chord(1, 2) * chord(3, 0) / all, y = chord(0, 1) * chord(2, 3) / all;
    return elliptic_ratio(x, y);
}

double modulus_ratio(const ModulusBracket& source, const ModulusBracket& image) {
    return std::max({1.0, image.lower / source.upper, source.lower / image.upper});
}

std::optional<RectangleImage> rectangle_image(const std::vector<Complex>& images) {
    const int n = static_cast<int>(images.size());
    if (n < 4) return std::nullopt;
    double size = 0;
    for (const Complex z : images) size = std::max(size, std::abs(z - images[0]));
    // Corners: where the loop turns by a right angle; it turns nowhere else.
    std::vector<int> turns;
    for (int i = 0; i < n; ++i) {
        const Complex in = images[i] - images[(i + n - 1) % n], out = images[(i + 1) % n] - images[i];
        const double scale = std::abs(in) * std::abs(out);
        if (!(scale > 0)) return std::nullopt;
        const Complex turn = out * std::conj(in) / scale;
        if (turn.imag() > 0.5 && std::abs(turn.real()) < kRight)
            turns.push_back(i);
        else if (turn.real() < 0)
            return std::nullopt;
        if (turns.size() > 4) return std::nullopt;
    }
    if (turns.size() != 4) return std::nullopt;
    RectangleImage result{{turns[0], turns[1], turns[2], turns[3]}, 0};
    std::array<Complex, 4> corner;
    for (int i = 0; i < 4; ++i) corner[i] = images[turns[i]];
    for (int i = 0; i < 4; ++i) {
        const Complex a = corner[i], side = corner[(i + 1) % 4] - a;
        const int to = turns[(i + 1) % 4] > turns[i] ? turns[(i + 1) % 4] : turns[(i + 1) % 4] + n;
        for (int p = turns[i]; p <= to; ++p)
            if (std::abs(std::imag(std::conj(side) * (images[p % n] - a))) > kOnSide * size * std::abs(side))
                return std::nullopt;
    }
    result.modulus = std::abs(corner[1] - corner[0]) / std::abs(corner[2] - corner[1]);
    return result;
}

}  // namespace beltrami
