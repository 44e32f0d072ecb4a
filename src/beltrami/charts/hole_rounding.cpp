#include <beltrami/charts/hole_rounding.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <beltrami/charts/hole_centre.h>
#include <beltrami/linear/dense.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

constexpr double kLargestStretch = 0.5;  // of |F′ − 1| in one step
constexpr double kFirstRidge = 1e-6;     // of the diagonal
constexpr double kSmallestRidge = 1e-9;
constexpr double kLargestRidge = 1;
constexpr double kSpread = 20;    // of a power on its rim
constexpr int kMostSamples = 96;  // of a rim
constexpr int kMostUnknowns = 600;
constexpr double kConverged = 0.1;  // a small step that lowers nothing: as round as the powers allow
constexpr double kDiverged = 1e-3;  // a step has to lower the misfit by this part

double worst_ratio(const std::vector<std::vector<Complex>>& rims) {
    double worst = 1;
    for (const auto& rim : rims) worst = std::max(worst, hole_centre(rim).ratio);
    return worst;
}

/// Root mean square of the rims' distances from their circles, relative to these.
double misfit(const std::vector<std::vector<Complex>>& rims) {
    double sum = 0;
    for (const auto& rim : rims) {
        const CircleFit circle = fit_circle(rim);
        for (const Complex z : rim) {
            const double off = std::abs(z - circle.centre) / circle.radius - 1;
            sum += off * off / static_cast<double>(rim.size() * rims.size());
        }
    }
    return std::sqrt(sum);
}

/// Product without the standard's care for infinities, which costs several times as much.
Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// The powers of one pole at a place and their derivatives: t^j and s^j.
struct Powers {
    Complex t, s, t_slope, s_slope;
    Powers(Complex z, Complex centre, double radius) {
        const Complex outside = 1.0 / (z - centre), mirror = 1.0 / (1.0 - std::conj(centre) * z);
        t = radius * outside;
        s = radius * z * mirror;
        t_slope = -t * outside;
        s_slope = radius * mirror * mirror;
    }
};

/// The Newton step from the present rims, without damping. The ridge holds back what hardly matters for the roundness:
/// the maps of the disk to itself among others.
CircleMap newton_step(const std::vector<std::vector<Complex>>& rims, int most_terms, double ridge) {
    CircleMap step;
    std::vector<std::vector<Complex>> samples;
    std::vector<int> first_column{0};
    int rows = 0;
    for (const auto& rim : rims) {
        const int n = static_cast<int>(rim.size());
        const HoleCentre centre = hole_centre(rim);
        // A power may differ along the rim by the factor kSpread at most: others are noise where the rim is near.
        const double fitting = std::log(kSpread) / std::log(std::max(centre.ratio, 1.01));
        const int terms = std::clamp(std::min(n / 3, static_cast<int>(fitting)), 1, most_terms);
        step.poles.push_back({centre.centre, centre.radius, Eigen::VectorXcd::Zero(terms)});
        auto& chosen = samples.emplace_back();
        const int count = std::min(n, kMostSamples);
        for (int i = 0; i < count; ++i) chosen.push_back(rim[static_cast<long>(i) * n / count]);
        rows += count;
        first_column.push_back(first_column.back() + 2 * terms + 3);  // the last three: C and R
    }
    const int holes = static_cast<int>(rims.size()), columns = first_column.back();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::VectorXd b(rows);
    int row = 0;
    for (int h = 0; h < holes; ++h) {
        const CircleFit circle = fit_circle(samples[h]);
        const auto& rim = samples[h];
        const int n = static_cast<int>(rim.size());
        double length = 0;
        for (int i = 0; i < n; ++i) length += std::abs(rim[(i + 1) % n] - rim[i]);
        for (int i = 0; i < n; ++i, ++row) {
            const Complex z = rim[i];
            const double share = (std::abs(rim[(i + 1) % n] - z) + std::abs(z - rim[(i + n - 1) % n])) / (2 * length);
            const double weight = std::sqrt(share) / circle.radius;
            const Complex normal = (z - circle.centre) / std::abs(z - circle.centre);
            const Complex pull = weight * std::conj(normal) * z;
            for (int k = 0; k < holes; ++k) {
                const auto& pole = step.poles[k];
                const Powers p(z, pole.centre, pole.radius);
                Complex t = 1, s = 1;
                for (Eigen::Index j = 0; j < pole.coefficients.size(); ++j) {
                    t *= p.t;
                    s *= p.s;
                    A(row, first_column[k] + 2 * j) = std::real(pull * (t - s));
                    A(row, first_column[k] + 2 * j + 1) = std::real(pull * Complex(0, 1) * (t + s));
                }
            }
            const int last = first_column[h + 1];
            A(row, last - 3) = -weight * normal.real();
            A(row, last - 2) = -weight * normal.imag();
            A(row, last - 1) = -weight;
            b[row] = -weight * (std::abs(z - circle.centre) - circle.radius);
        }
    }
    // Columns of length one, so that one ridge fits all.
    Eigen::VectorXd scale = A.colwise().norm();
    for (double& s : scale) s = s > 0 ? 1 / s : 0;
    A = A * scale.asDiagonal();
    Eigen::MatrixXd gram = gram_lower(A);
    gram.diagonal().array() += ridge;
    const Eigen::VectorXd x = scale.cwiseProduct(gram.selfadjointView<Eigen::Lower>().ldlt().solve(A.transpose() * b));
    for (int h = 0; h < holes; ++h)
        for (Eigen::Index j = 0; j < step.poles[h].coefficients.size(); ++j)
            step.poles[h].coefficients[j] = {x[first_column[h] + 2 * j], x[first_column[h] + 2 * j + 1]};
    return step;
}

/// q and q′.
std::array<Complex, 2> exponent(const CircleMap& map, Complex z) {
    Complex q = 0, slope = 0;
    for (const auto& pole : map.poles) {
        const Powers p(z, pole.centre, pole.radius);
        Complex t = 1, s = 1;
        for (Eigen::Index j = 0; j < pole.coefficients.size(); ++j) {
            const Complex a = pole.coefficients[j], mirrored = std::conj(a);
            const Complex at = times(a, t), as = times(mirrored, s);
            slope += static_cast<double>(j + 1) * (times(at, p.t_slope) - times(as, p.s_slope));
            t = times(t, p.t);
            s = times(s, p.s);
            q += times(at, p.t) - times(as, p.s);
        }
    }
    return {q, slope};
}

/// Largest |(z q)′| on the rims and on the unit circle, by the maximum principle that of the domain.
double largest_stretch(const CircleMap& map, const std::vector<std::vector<Complex>>& rims) {
    double largest = 0;
    const auto visit = [&](Complex z) {
        const auto [q, slope] = exponent(map, z);
        largest = std::max(largest, std::abs(q + z * slope));
    };
    for (const auto& rim : rims)
        for (std::size_t i = 0; i < rim.size(); ++i) visit(rim[i]);
    for (int i = 0; i < 128; ++i) visit(std::polar(1.0, 0.0490873852123405 * i));
    return largest;
}

}  // namespace

std::array<Complex, 2> CircleMap::operator()(Complex z) const {
    const auto [q, slope] = exponent(*this, z);
    const Complex factor = std::exp(q);
    return {z * factor, factor * (1.0 + z * slope)};
}

std::array<Complex, 2> HoleRounding::operator()(Complex z) const {
    Complex derivative = 1;
    for (const CircleMap& step : steps) {
        const auto [value, slope] = step(z);
        z = value;
        derivative *= slope;
    }
    return {z, derivative};
}

HoleRounding round_holes(std::vector<std::vector<Complex>> rims, const HoleRoundingOptions& options) {
    HoleRounding result;
    result.ratio = result.ratio_before = worst_ratio(rims);
    const int terms =
        std::clamp(kMostUnknowns / (2 * static_cast<int>(std::max<std::size_t>(1, rims.size()))), 2, options.terms);
    double error = misfit(rims), ridge = kFirstRidge;
    for (int trial = 0; trial < options.max_steps && result.ratio > options.wanted_ratio && ridge < kLargestRidge;
         ++trial) {
        CircleMap step = newton_step(rims, terms, ridge);
        const double stretch = largest_stretch(step, rims);
        std::vector<std::vector<Complex>> moved = rims;
        double moved_error = error;
        if (std::isfinite(stretch)) {
            if (stretch > kLargestStretch)
                for (auto& pole : step.poles) pole.coefficients *= kLargestStretch / stretch;
            for (auto& rim : moved)
                for (Complex& z : rim) z = step(z)[0];
            moved_error = misfit(moved);
        }
        if (!(moved_error < (1 - kDiverged) * error)) {
            if (stretch < kConverged) break;
            ridge *= 30;
            continue;
        }
        ridge = std::max(kSmallestRidge, ridge / 5);
        error = moved_error;
        rims = std::move(moved);
        result.ratio = worst_ratio(rims);
        result.steps.push_back(std::move(step));
    }
    if (!(result.ratio < result.ratio_before)) {
        result.steps.clear();
        result.ratio = result.ratio_before;
    }
    return result;
}

}  // namespace beltrami
