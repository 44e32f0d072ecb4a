#include <beltrami/operators/distortion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>
#include <beltrami/mesh/planar.h>

namespace beltrami {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegenerateArea = 1e-14;
constexpr double kAntiConformal = 1e-28;  // of |∂f|²/|∂̄f|²

/// ∂̄f/∂f; infinite where ∂f is nothing but the rounding of ∂̄f.
Complex quotient(Complex d_z, Complex d_zbar) {
    const double z = std::norm(d_z), zbar = std::norm(d_zbar);
    if (z > kAntiConformal * zbar) return d_zbar / d_z;
    return zbar > 0 ? Complex(kInfinity, 0) : Complex(kNaN, kNaN);
}

}  // namespace

Eigen::VectorXcd beltrami_coefficient(const MapDerivatives& map) {
    Eigen::VectorXcd mu(map.dz.size());
    parallel_for(0, static_cast<int>(mu.size()), [&](int begin, int end) {
        for (int s = begin; s < end; ++s) mu[s] = quotient(map.dz[s], map.dzbar[s]);
    });
    return mu;
}

Distortion distortion(const Operators& source, const MapDerivatives& map) {
    Distortion d;
    d.mu = beltrami_coefficient(map);
    const MuStatistics statistics = mu_statistics(d.mu, source.weights);
    d.mean = statistics.mean;
    d.standard_deviation = statistics.standard_deviation;
    d.p99 = statistics.p99;
    d.max = statistics.max;

    d.face_mu = Eigen::VectorXcd::Zero(source.face_count);
    d.face_abs_mu = Eigen::VectorXd::Constant(source.face_count, kNaN);
    Eigen::VectorXd face_area = Eigen::VectorXd::Zero(source.face_count), image_area = face_area;
    for (int s = 0; s < source.sample_count(); ++s) {
        const int f = source.faces[s];
        image_area[f] += source.weights[s] * std::abs(std::norm(map.dz[s]) - std::norm(map.dzbar[s]));
        face_area[f] += source.weights[s];
        d.face_mu[f] += source.weights[s] * d.mu[s];
        d.face_abs_mu[f] = std::fmax(d.face_abs_mu[f], std::sqrt(std::norm(d.mu[s])));  // fmax: NaN gives way
    }
    for (int f = 0; f < source.face_count; ++f) {
        d.face_mu[f] /= face_area[f];
        if (d.face_abs_mu[f] > 1) d.flipped.push_back(f);
        if (!(image_area[f] > kDegenerateArea * map.image_diameter * map.image_diameter)) d.degenerate.push_back(f);
    }
    return d;
}

Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Eigen::VectorXcd& map) {
    return beltrami_coefficient(derivatives(source, map));
}

Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Positions& image, const Positions& normals) {
    return beltrami_coefficient(derivatives(source, image, normals));
}

double dilatation(double abs_mu) {
    if (std::isinf(abs_mu)) return 1.0;
    return (1 + abs_mu) / std::abs(1 - abs_mu);
}

double Distortion::K_max() const {
    return flipped.empty() ? max_dilatation() : std::numeric_limits<double>::infinity();
}

double k_of(double K) {
    return (K - 1) / (K + 1);
}

namespace {

/// The least value at which values in ascending order reach a weight: what lies on one side of it is never sorted.
/// @param order values with their indices, put into another order
double value_at_weight(std::vector<std::pair<double, int>>& order, const std::vector<double>& weights, double wanted) {
    constexpr std::ptrdiff_t kSorted = 1024;
    auto first = order.begin(), last = order.end();
    double below = 0;
    while (last - first > kSorted) {
        const auto middle = first + (last - first) / 2;
        std::nth_element(first, middle, last);
        double sum = below;
        for (auto i = first; i < middle; ++i) sum += weights[i->second];
        if (sum >= wanted) {
            last = middle;
        } else {
            first = middle;
            below = sum;
        }
    }
    std::sort(first, last);
    for (auto i = first; i < last; ++i) {
        below += weights[i->second];
        if (below >= wanted) return i->first;
    }
    return (last - 1)->first;
}

}  // namespace

MuStatistics mu_statistics(const Eigen::VectorXcd& mu, const std::vector<double>& weights) {
    const int n = static_cast<int>(mu.size());
    Eigen::VectorXd size(n);
    parallel_for(0, n, [&](int begin, int end) {
        for (int s = begin; s < end; ++s) size[s] = std::sqrt(std::norm(mu[s]));
    });
    double total = 0, sum = 0, largest = kNaN;
    std::vector<std::pair<double, int>> order;
    order.reserve(static_cast<std::size_t>(n));
    for (int s = 0; s < n; ++s) {
        largest = std::fmax(largest, size[s]);
        if (!std::isfinite(size[s])) continue;
        total += weights[s];
        sum += weights[s] * size[s];
        order.emplace_back(size[s], s);
    }
    if (order.empty()) return {kNaN, kNaN, kNaN, largest};
    const double mean = sum / total;
    double variance = 0;
    for (const auto& [at, s] : order) variance += weights[s] * (at - mean) * (at - mean);
    return {mean, std::sqrt(variance / total), value_at_weight(order, weights, 0.99 * total), largest};
}

Distortion distortion(const Operators& source, const Eigen::VectorXcd& map) {
    return distortion(source, derivatives(source, map));
}

Distortion distortion(const Operators& source, const Positions& image, const Positions& normals) {
    if (image.cols() < 3) {
        Eigen::VectorXcd map(image.rows());
        for (Eigen::Index v = 0; v < image.rows(); ++v) map[v] = {image(v, 0), image(v, 1)};
        return distortion(source, map);
    }
    return distortion(source, derivatives(source, image, normals));
}

namespace {

/// A planar image as its planar source is seen.
Positions seen_with(const Mesh& source, Positions image) {
    if (is_planar(source) && seen_from_below(source)) image.col(1) *= -1;
    return image;
}

}  // namespace

Distortion distortion_to(const Mesh& source, const Mesh& image) {
    if (is_planar(image)) return distortion(operators(source), seen_with(source, image.positions.leftCols(2)));
    return distortion(operators(source), image.positions, vertex_normals(image));
}

Distortion distortion_to_corners(const Mesh& source, const Positions& corners) {
    return distortion(per_corner(operators(source), source.faces), seen_with(source, corners));
}

Complex change_frame(Complex mu, double angle) {
    return mu * std::polar(1.0, -2 * angle);
}

Complex compose_coefficients(Complex mu_f, Complex mu_g, Complex d_z_f) {
    const Complex turned = mu_g * (std::conj(d_z_f) / d_z_f);
    return (mu_f + turned) / (1.0 + std::conj(mu_f) * turned);
}

Complex decompose_coefficients(Complex mu_f, Complex mu_g, Complex d_z_f) {
    return (mu_g - mu_f) / (1.0 - std::conj(mu_f) * mu_g) * (d_z_f / std::conj(d_z_f));
}

}  // namespace beltrami
