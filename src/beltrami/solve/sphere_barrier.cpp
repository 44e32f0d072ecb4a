#include <beltrami/solve/sphere_barrier.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/solve/damping.h>
#include <beltrami/solve/image_frame.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

constexpr int kExpectedFactorizations = 20;
constexpr double kLongestMotion = 0.7;  // radians
constexpr double kShortest = 1e-6;      // step length below which no step is taken
constexpr double kShift = 1e-9, kLargestShift = 1e-3;
constexpr double kNoticeable = 1e-2;

}  // namespace

/// A sample of the map.
struct SphereBarrier::Sample : ImageFrame {
    Complex quotient;     // T
    Complex denominator;  // 1 − conj(σ) μ
};

SphereBarrier::SphereBarrier(const Operators& operators, std::vector<Freedom> freedoms, Eigen::VectorXcd sigma,
                             std::vector<double> weights)
    : operators_(operators), freedoms_(std::move(freedoms)), system_(operators, freedoms_, kExpectedFactorizations) {
    aim(std::move(sigma), std::move(weights));
}

void SphereBarrier::aim(Eigen::VectorXcd sigma, std::vector<double> weights) {
    sigma_ = std::move(sigma);
    weights_ = std::move(weights);
    total_weight_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

SphereBarrier::Sample SphereBarrier::at(int sample, const Positions& points) const {
    Sample s{image_frame(operators_, sample, points, points), {}, {}};
    if (!s.upright) return s;
    const Complex mu = s.q / s.p;
    s.denominator = 1.0 - std::conj(sigma_[sample]) * mu;
    s.quotient = (mu - sigma_[sample]) / s.denominator;
    s.upright = std::norm(s.quotient) < 1;
    return s;
}

double SphereBarrier::value(const Positions& points) const {
    const double sum = parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double part = 0;
        for (int s = first; s < last; ++s) {
            const Sample sample = at(s, points);
            if (!sample.upright) return kInfinity;
            const double square = std::norm(sample.quotient);
            part += weights_[s] * square / (1 - square);
        }
        return part;
    });
    return sum / total_weight_;
}

void SphereBarrier::assemble(const Positions& points, const Eigen::VectorXd& units) {
    system_.set_zero();
    constexpr int kMost = 8;
    std::array<double, kMost> along, across, gradient;
    std::array<double, kMost*(kMost + 1) / 2> hessian;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const Sample sample = at(s, points);
        const auto stencil = operators_.stencil(s);
        const auto g = operators_.gradient(s);
        const double d = std::abs(sample.quotient), rest = 1 - d * d;
        Complex phase = std::conj(sample.p) / sample.p;
        phase *= std::norm(sample.denominator) / (sample.denominator * sample.denominator);
        if (d > 1e-14) phase *= std::conj(sample.quotient) / d;
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const TangentFrame frame(points.row(stencil[j]));
            for (int a = 0; a < 2; ++a) {
                const Eigen::Vector3d direction = units[stencil[j]] * (a == 0 ? frame.first : frame.second);
                const Complex change = sample.change(g[j], direction) * phase;
                along[2 * j + a] = change.real();
                across[2 * j + a] = change.imag();
            }
        }
        const double weight = weights_[s] / (rest * total_weight_);
        const auto unknowns = 2 * stencil.size();
        std::size_t entry = 0;
        for (std::size_t i = 0; i < unknowns; ++i) {
            gradient[i] = weight * d * along[i];
            for (std::size_t j = 0; j <= i; ++j)
                hessian[entry++] = weight * (along[i] * along[j] + rest * rest * across[i] * across[j]);
        }
        system_.add(s, gradient.data(), hessian.data());
    }
}

SphereBarrier::Taken SphereBarrier::step(Positions& points) {
    const double before = value(points);
    const Eigen::VectorXd units = local_sizes(operators_, points);
    CoupledSystem::Step step;
    for (double shift = kShift;; shift *= 100) {
        assemble(points, units);
        system_.scale_diagonal(1 + shift + damping_);
        try {
            step = system_.solve();
            break;
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved || shift >= kLargestShift) throw;
        }
    }
    Positions motion = Positions::Zero(points.rows(), 3);
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        if (freedoms_[v] == Freedom::fixed) continue;
        const TangentFrame frame(points.row(v));
        motion.row(v) =
            units[v] * (step.direction[v].real() * frame.first + step.direction[v].imag() * frame.second).transpose();
    }
    const double largest = motion.rowwise().norm().maxCoeff();
    Taken taken;
    double length = std::min(1.0, kLongestMotion / largest);
    while (length > kShortest) {
        Positions trial = points + length * motion;
        for (Eigen::Index v = 0; v < trial.rows(); ++v)
            if (freedoms_[v] != Freedom::fixed) trial.row(v).normalize();
        const double there = value(trial);
        if (!(there < before)) {
            length *= 0.5;
            continue;
        }
        points = std::move(trial);
        taken = {length, 1 - there / before, damping_ > kNoticeable};
        break;
    }
    if (taken.length < kShort)
        damping_ = std::max(kDampingFactor * damping_, kFirstDamping);
    else if (taken.length > kNearlyFull)
        damping_ = damping_ / kDampingFactor < kLeastDamping ? 0 : damping_ / kDampingFactor;
    return taken;
}

Eigen::VectorXcd coefficient_change(const Operators& operators, const Positions& points, const Positions& motion) {
    Eigen::VectorXcd change(operators.sample_count());
    parallel_for(0, operators.sample_count(), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const ImageFrame frame = image_frame(operators, s, points, points);
            const auto stencil = operators.stencil(s);
            const auto gradient = operators.gradient(s);
            Complex sum = 0;
            for (std::size_t j = 0; j < stencil.size(); ++j)
                sum += frame.change(gradient[j], motion.row(stencil[j]).transpose());
            change[s] = sum * std::conj(frame.p) / frame.p;
        }
    });
    return change;
}

}  // namespace beltrami
