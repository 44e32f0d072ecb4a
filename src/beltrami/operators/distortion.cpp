#include <beltrami/operators/distortion.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <beltrami/base/parallel.h>
#include <beltrami/mesh/planar.h>

namespace beltrami {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegenerateArea = 1e-14;
constexpr double kAntiConformal = 1e-28;  // of |∂f|²/|∂̄f|²

/// ∂̄f/∂f; infinite where ∂f is nothing but the rounding of ∂̄f.
Complex quotient(Complex d_z, Complex d_zbar) {
    const double z = std::norm(d_z), zbar = std::norm(d_zbar);
    if (z > kAntiConformal * zbar) return d_zbar / d_z;
    return zbar > 0 ? Complex(kInfinity, 0) : Complex(kNaN, kNaN);
}

/// (∂f, ∂̄f) of a map into space, in an orthonormal frame of the image oriented by the image's vertex normals.
std::array<Complex, 2> derivatives_in_space(const Operators& source, int sample, const Positions& image,
                                            const Positions& normals) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), y = x, up = x;
    const auto stencil = source.stencil(sample);
    const auto gradient = source.gradient(sample);
    const Eigen::RowVector3d base = image.row(stencil[0]);
    for (std::size_t j = 0; j < stencil.size(); ++j) {
        const Eigen::Vector3d p = image.row(stencil[j]) - base;
        x += gradient[j].real() * p;
        y += gradient[j].imag() * p;
        up += normals.row(stencil[j]);
    }
    const Eigen::Vector3d normal = x.cross(y);
    const double side = normal.dot(up) < 0 ? -1.0 : 1.0;
    const Eigen::Vector3d& axis = x.squaredNorm() >= y.squaredNorm() ? x : y;
    if (axis.squaredNorm() == 0) return {0.0, 0.0};
    const Eigen::Vector3d e1 = axis.normalized();
    // In the plane of x and y; where they are parallel the second coordinate is 0 whatever e2 is.
    Eigen::Vector3d e2 = normal.cross(e1);
    if (e2.squaredNorm() > 0) e2.normalize();
    e2 *= side;
    const Complex fx(x.dot(e1), x.dot(e2)), fy(y.dot(e1), y.dot(e2)), i(0, 1);
    return {0.5 * (fx - i * fy), 0.5 * (fx + i * fy)};
}

template <class Derivatives>
Eigen::VectorXcd coefficients(const Operators& source, Derivatives&& derivatives) {
    Eigen::VectorXcd mu(source.sample_count());
    parallel_for(0, source.sample_count(), [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const auto [d_z, d_zbar] = derivatives(s);
            mu[s] = quotient(d_z, d_zbar);
        }
    });
    return mu;
}

template <class Derivatives>
Distortion measure(const Operators& source, double squared_diameter, Derivatives&& derivatives) {
    Distortion d;
    d.mu = coefficients(source, derivatives);
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
        const auto [d_z, d_zbar] = derivatives(s);
        image_area[f] += source.weights[s] * std::abs(std::norm(d_z) - std::norm(d_zbar));
        face_area[f] += source.weights[s];
        d.face_mu[f] += source.weights[s] * d.mu[s];
        d.face_abs_mu[f] = std::fmax(d.face_abs_mu[f], std::abs(d.mu[s]));  // fmax: NaN gives way
    }
    for (int f = 0; f < source.face_count; ++f) {
        d.face_mu[f] /= face_area[f];
        if (d.face_abs_mu[f] > 1) d.flipped.push_back(f);
        if (!(image_area[f] > kDegenerateArea * squared_diameter)) d.degenerate.push_back(f);
    }
    return d;
}

}  // namespace

Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Eigen::VectorXcd& map) {
    return coefficients(source, [&](int s) { return source.derivatives(s, map); });
}

Eigen::VectorXcd beltrami_coefficient(const Operators& source, const Positions& image, const Positions& normals) {
    return coefficients(source, [&](int s) { return derivatives_in_space(source, s, image, normals); });
}

double dilatation(double abs_mu) {
    if (std::isinf(abs_mu)) return 1.0;
    return (1 + abs_mu) / std::abs(1 - abs_mu);
}

MuStatistics mu_statistics(const Eigen::VectorXcd& mu, const std::vector<double>& weights) {
    const int n = static_cast<int>(mu.size());
    Eigen::VectorXd size(n);
    for (int s = 0; s < n; ++s) size[s] = std::abs(mu[s]);
    double total = 0, sum = 0, largest = kNaN;
    std::vector<int> order;
    order.reserve(n);
    for (int s = 0; s < n; ++s) {
        largest = std::fmax(largest, size[s]);
        if (!std::isfinite(size[s])) continue;
        total += weights[s];
        sum += weights[s] * size[s];
        order.push_back(s);
    }
    if (order.empty()) return {kNaN, kNaN, kNaN, largest};
    const double mean = sum / total;
    double variance = 0;
    for (const int s : order) variance += weights[s] * (size[s] - mean) * (size[s] - mean);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return size[a] != size[b] ? size[a] < size[b] : a < b; });
    double below = 0, p99 = size[order.back()];
    for (const int s : order) {
        below += weights[s];
        if (below >= 0.99 * total) {
            p99 = size[s];
            break;
        }
    }
    return {mean, std::sqrt(variance / total), p99, largest};
}

Distortion distortion(const Operators& source, const Eigen::VectorXcd& map) {
    double x0 = kInfinity, x1 = -kInfinity, y0 = kInfinity, y1 = -kInfinity;
    for (const int v : source.vertices) {
        x0 = std::min(x0, map[v].real());
        x1 = std::max(x1, map[v].real());
        y0 = std::min(y0, map[v].imag());
        y1 = std::max(y1, map[v].imag());
    }
    return measure(source, std::norm(Complex(x1 - x0, y1 - y0)), [&](int s) { return source.derivatives(s, map); });
}

Distortion distortion(const Operators& source, const Positions& image, const Positions& normals) {
    if (image.cols() < 3) {
        Eigen::VectorXcd map(image.rows());
        for (Eigen::Index v = 0; v < image.rows(); ++v) map[v] = {image(v, 0), image(v, 1)};
        return distortion(source, map);
    }
    Eigen::RowVector3d low = Eigen::RowVector3d::Constant(kInfinity), high = -low;
    for (const int v : source.vertices) {
        low = low.cwiseMin(image.row(v));
        high = high.cwiseMax(image.row(v));
    }
    return measure(source, (high - low).squaredNorm(),
                   [&](int s) { return derivatives_in_space(source, s, image, normals); });
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
