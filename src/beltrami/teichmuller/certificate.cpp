#include <beltrami/teichmuller/certificate.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

/// |φ| varying by more than this factor over a triangle asks for a division of the triangle.
constexpr double kVariation = 1.5;
constexpr int kDeepest = 6;

/// Triangles (in the canonical domain) with what they belong to; the quadrature works through them in rounds, so that φ
/// is always evaluated on many points at once.
struct Piece {
    std::array<Complex, 3> z;
    int sample;
    double share;  ///< part of the sample's area
};

/// ∫φ and ∫|φ| over every sample.
struct Integrals {
    Eigen::VectorXcd phi;
    Eigen::VectorXd abs_phi;
};

Integrals integrate(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                    const Eigen::VectorXcd& coefficients) {
    const Operators& operators = source.operators;
    const int samples = operators.sample_count();
    Integrals result{Eigen::VectorXcd::Zero(samples), Eigen::VectorXd::Zero(samples)};
    std::vector<Piece> pieces;
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        const auto v = operators.stencil(s);
        if (v.size() == 3) {
            pieces.push_back({{chart.vertices[v[0]], chart.vertices[v[1]], chart.vertices[v[2]]}, s, 1.0});
        } else {
            const Complex z = chart.positions[s];  // a Gauss point of a quad stands for its part of the quad
            pieces.push_back({{z, z, z}, s, 1.0});
        }
    }
    for (int depth = 0; !pieces.empty(); ++depth) {
        // Edge midpoints (exact for quadratics) and corners (to see the variation) of every piece.
        ChartPoints points;
        points.positions.resize(static_cast<Eigen::Index>(6 * pieces.size()));
        points.derivatives.resize(points.positions.size());
        for (std::size_t i = 0; i < pieces.size(); ++i)
            for (int j = 0; j < 3; ++j) {
                const auto at = static_cast<Eigen::Index>(6 * i + 2 * j);
                points.positions[at] = pieces[i].z[j];
                points.positions[at + 1] = 0.5 * (pieces[i].z[j] + pieces[i].z[(j + 1) % 3]);
                points.derivatives[at] = points.derivatives[at + 1] = chart.derivatives[pieces[i].sample];
            }
        const Eigen::VectorXcd phi = space.combination(points, coefficients);
        std::vector<Piece> divided;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const auto values = phi.segment(static_cast<Eigen::Index>(6 * i), 6);
            const Eigen::VectorXd sizes = values.cwiseAbs();
            const Piece& p = pieces[i];
            if (depth < kDeepest && sizes.maxCoeff() > kVariation * sizes.minCoeff()) {
                const std::array<Complex, 3> mid{0.5 * (p.z[0] + p.z[1]), 0.5 * (p.z[1] + p.z[2]),
                                                 0.5 * (p.z[2] + p.z[0])};
                const double share = 0.25 * p.share;
                divided.push_back({{p.z[0], mid[0], mid[2]}, p.sample, share});
                divided.push_back({{mid[0], p.z[1], mid[1]}, p.sample, share});
                divided.push_back({{mid[2], mid[1], p.z[2]}, p.sample, share});
                divided.push_back({{mid[0], mid[1], mid[2]}, p.sample, share});
                continue;
            }
            const double area = operators.weights[p.sample] * p.share / 3;
            result.phi[p.sample] += area * (values[1] + values[3] + values[5]);
            result.abs_phi[p.sample] += area * (sizes[1] + sizes[3] + sizes[5]);
        }
        pieces.swap(divided);
    }
    return result;
}

}  // namespace

ReichStrebel reich_strebel(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                           const Eigen::VectorXcd& coefficients, const Eigen::VectorXcd& mu) {
    ReichStrebel result;
    const Integrals integrals = integrate(source, chart, space, coefficients);
    double total = 0, norm = 0, pairing = 0;  // ∫|φ|, ∫a|φ|, Re ∫2bφ
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        if (chart.excluded[s]) continue;
        const double size = std::norm(mu[s]);
        if (!(size < 1)) return result;
        total += integrals.abs_phi[s];
        norm += integrals.abs_phi[s] * (1 + size) / (1 - size);
        pairing += 2 * std::real(mu[s] * integrals.phi[s]) / (1 - size);
    }
    if (!(total > 0)) {  // φ = 0: nothing is known beyond K ≥ 1
        result.lower = result.estimate = 1;
        result.upper = 1;
        result.valid = true;
        return result;
    }
    result.lower = total / (norm - pairing);
    result.upper = (norm + pairing) / total;
    result.estimate = std::sqrt((norm + pairing) / (norm - pairing));
    result.valid = true;
    return result;
}

double mesh_harmonic_bound(const Operators& source, const Eigen::VectorXcd& harmonic) {
    double energy = 0, area = 0;
    for (int s = 0; s < source.sample_count(); ++s) {
        const auto [dz, dzbar] = source.derivatives(s, harmonic);
        energy += source.weights[s] * (std::norm(dz) + std::norm(dzbar));
        area += source.weights[s] * (std::norm(dz) - std::norm(dzbar));
    }
    if (!(area > 0)) return 1;
    const double c = std::max(1.0, energy / area);
    return c + std::sqrt(c * c - 1);
}

}  // namespace beltrami
