#include <beltrami/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/charts/averaged_coefficient.h>
#include <beltrami/coefficient/differential_quadrature.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

bool Bound::proves_from_below() const {
    return rigorous && of == Of::extremal && kind != Kind::attained && kind != Kind::verified &&
           kind != Kind::moduli_upper;
}

const char* to_string(Bound::Kind kind) {
    switch (kind) {
        case Bound::Kind::reich_strebel:
            return "reich_strebel";
        case Bound::Kind::reich_strebel_estimate:
            return "reich_strebel_estimate";
        case Bound::Kind::reich_strebel_upper:
            return "reich_strebel_upper";
        case Bound::Kind::averaged_estimate:
            return "averaged_estimate";
        case Bound::Kind::corner:
            return "corner";
        case Bound::Kind::edge_corner:
            return "edge_corner";
        case Bound::Kind::moduli:
            return "moduli";
        case Bound::Kind::moduli_upper:
            return "moduli_upper";
        case Bound::Kind::pair:
            return "pair";
        case Bound::Kind::verified:
            return "verified";
        case Bound::Kind::mesh_harmonic:
            return "mesh_harmonic";
        case Bound::Kind::attained:
            return "attained";
    }
    return "unknown";
}

const char* to_string(Bound::Of of) {
    switch (of) {
        case Bound::Of::extremal:
            return "K*";
        case Bound::Of::mesh:
            return "mesh";
        case Bound::Of::polygons:
            return "polygons";
    }
    return "unknown";
}

namespace {

/// A smaller part of ∫|φ| that the quadrature leaves unresolved does not count.
constexpr double kUnresolved = 1e-6;
/// |μ| of averages is held at this.
constexpr double kMostAveraged = 0.995;

}  // namespace

ReichStrebel reich_strebel_of(double total, double norm, double pairing, double unresolved) {
    ReichStrebel result;
    if (!std::isfinite(total) || !std::isfinite(norm) || !std::isfinite(pairing) || !std::isfinite(unresolved))
        return result;
    result.valid = true;
    result.resolved = unresolved <= kUnresolved;
    if (!(total > 0)) {  // φ = 0: nothing is known beyond K ≥ 1
        result.lower = result.estimate = result.upper = 1;
        return result;
    }
    result.lower = total / (norm - pairing);
    result.upper = (norm + pairing) / total;
    result.estimate = std::sqrt((norm + pairing) / (norm - pairing));
    return result;
}

ReichStrebel reich_strebel(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                           const Eigen::VectorXcd& coefficients, const Eigen::VectorXcd& mu) {
    const int samples = source.operators.sample_count();
    for (int s = 0; s < samples; ++s)
        if (!chart.excluded[s] && !(std::norm(mu[s]) < 1)) return {};
    const auto [phi, abs_phi, unresolved] = integrals_over_samples(source, chart, space, coefficients);
    double total = 0, norm = 0, pairing = 0;
    for (int s = 0; s < samples; ++s) {
        if (chart.excluded[s]) continue;
        const double size = std::norm(mu[s]);
        total += abs_phi[s];
        norm += abs_phi[s] * (1 + size) / (1 - size);
        pairing += 2 * std::real(mu[s] * phi[s]) / (1 - size);
    }
    return reich_strebel_of(total, norm, pairing, unresolved);
}

ReichStrebel reich_strebel(const Surface& source, const QuadraticDifferential& phi, const Eigen::VectorXcd& mu) {
    const Eigen::Index samples = source.operators.sample_count();
    const Eigen::MatrixXcd* table = phi.space ? phi.space->tabulated() : nullptr;
    for (const auto& [name, count] : {std::pair("μ", mu.size()), std::pair("φ", table ? table->rows() : samples)})
        if (count != samples)
            throw Error(Cause::bad_option, std::string(name) + " has " + std::to_string(count) + " values for " +
                                               std::to_string(samples) + " samples");
    if (phi.zero()) return (mu.array().abs2() < 1).all() ? reich_strebel_of(0, 0, 0, 0) : ReichStrebel();
    return reich_strebel(source, *phi.chart, *phi.space, phi.coefficients, mu);
}

ReichStrebel reich_strebel(const Surface& source, const QuadraticDifferential& phi, const MapDerivatives& map) {
    return reich_strebel(source, phi, beltrami_coefficient(map));
}

ReichStrebel averaged_estimate(const Surface& source, const Chart& chart, const Eigen::VectorXcd& phi,
                               const Eigen::VectorXcd& map) {
    const Eigen::VectorXcd mu = averaged_coefficient(source, chart, phi, map);
    double total = 0, norm = 0, pairing = 0;
    for (Eigen::Index s = 0; s < mu.size(); ++s) {
        const double size = std::abs(phi[s]);
        if (chart.excluded[s] || !(size > 0) || !std::isfinite(std::norm(mu[s]))) continue;
        const Complex held = mu[s] * (kMostAveraged / std::max(std::abs(mu[s]), kMostAveraged));
        const double weight = source.operators.weights[s] * size, square = std::norm(held);
        total += weight;
        norm += weight * (1 + square) / (1 - square);
        pairing += source.operators.weights[s] * 2 * std::real(held * phi[s]) / (1 - square);
    }
    return reich_strebel_of(total, norm, pairing, 0);
}

bool proves(const Surface& source, const Chart& chart) {
    return chart.exact && chart.excluded_faces == 0 && all_triangles(source.mesh);
}

bool proves(const Surface& source, const QuadraticDifferential& phi) {
    return phi.zero() || (!phi.tabulated() && proves(source, *phi.chart));
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
