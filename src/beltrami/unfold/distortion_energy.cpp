#include <beltrami/unfold/distortion_energy.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Samples whose share q^(p−1) of the gradient is below this part of the largest keep this share of curvature, so that
/// large powers leave no sample without stiffness.
constexpr double kLeastShare = 1e-6;

/// χ_ε(D), without cancellation for negative D.
double regularised(double determinant, double root, double epsilon) {
    return determinant >= 0 ? 0.5 * (determinant + root) : 0.5 * epsilon * (epsilon / (root - determinant));
}

double ratio(double r2, double s2, Regularisation regularisation) {
    const double determinant = r2 - s2, sum = r2 + s2 + regularisation.area * (1 + determinant * determinant);
    if (regularisation.epsilon == 0) return determinant > 0 ? sum / determinant : kInfinity;
    return sum / regularised(determinant, std::hypot(regularisation.epsilon, determinant), regularisation.epsilon);
}

}  // namespace

DistortionTerm distortion_term(double r, double s, Regularisation regularisation) {
    const double epsilon = regularisation.epsilon, area = regularisation.area;
    const double sum = r * r + s * s, determinant = (r - s) * (r + s);
    const double root = std::hypot(epsilon, determinant);
    const double chi = regularised(determinant, root, epsilon);
    const double chi_1 = chi / root, chi_2 = 0.5 * (epsilon / root) * (epsilon / root) / root;
    // q = S G(D) + H(D) with S = P + Q, D = P − Q, P = r², Q = s², G = 1/χ, H = λ (1 + D²) G.
    const double g = 1 / chi, g1 = -chi_1 * g * g, g2 = (2 * chi_1 * chi_1 * g - chi_2) * g * g;
    const double square = 1 + determinant * determinant;
    const double h1 = area * (2 * determinant * g + square * g1),
                 h2 = area * (2 * g + 4 * determinant * g1 + square * g2);
    const double by_p = g + sum * g1 + h1, by_q = g - sum * g1 - h1, twice = sum * g2 + h2;
    DistortionTerm term;
    term.value = (sum + area * square) * g;
    term.r = 2 * r * by_p;
    term.s = 2 * s * by_q;
    term.rr = 2 * by_p + 4 * r * r * (2 * g1 + twice);
    term.ss = 2 * by_q + 4 * s * s * (-2 * g1 + twice);
    term.rs = -4 * r * s * twice;
    term.around_a = 2 * by_p;
    term.around_b = 2 * by_q;
    return term;
}

DistortionEnergy::DistortionEnergy(const Operators& operators, Eigen::VectorXcd nu, double power,
                                   std::vector<char> left_out)
    : operators_(operators), nu_(std::move(nu)), power_(power), left_out_(std::move(left_out)) {
    for (int s = 0; s < operators_.sample_count(); ++s)
        if (counts(s)) total_weight_ += weight(s);
}

std::array<Complex, 2> DistortionEnergy::derivatives(int sample, const Eigen::VectorXcd& f) const {
    const auto [d_z, d_zbar] = operators_.derivatives(sample, f);
    const Complex n = nu_[sample];
    const double area = 1 - std::norm(n);
    return {(d_z - std::conj(n) * d_zbar) / area, (d_zbar - n * d_z) / area};
}

DistortionEnergy::Value DistortionEnergy::value(const Eigen::VectorXcd& f, Regularisation regularisation) const {
    struct Extremes {
        double largest = 0, smallest_determinant = kInfinity;
        bool infinite = false;
        Extremes& operator+=(const Extremes& other) {
            largest = std::max(largest, other.largest);
            smallest_determinant = std::min(smallest_determinant, other.smallest_determinant);
            infinite = infinite || other.infinite;
            return *this;
        }
    };
    Eigen::VectorXd q(operators_.sample_count());
    const Extremes extremes = parallel_sum(operators_.sample_count(), Extremes{}, [&](int first, int last) {
        Extremes part;
        for (int s = first; s < last; ++s) {
            if (!counts(s)) continue;
            const auto [a, b] = derivatives(s, f);
            const double r2 = std::norm(a), s2 = std::norm(b);
            q[s] = ratio(r2, s2, regularisation);
            part.smallest_determinant = std::min(part.smallest_determinant, r2 - s2);
            if (q[s] < kInfinity)
                part.largest = std::max(part.largest, q[s]);
            else
                part.infinite = true;  // NaN too
        }
        return part;
    });
    Value result{kInfinity, kInfinity, extremes.smallest_determinant};
    if (extremes.infinite || extremes.largest == 0) return result;
    const double total = parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double part = 0;
        for (int s = first; s < last; ++s)
            if (counts(s))
                part += weight(s) * (power_ == 1 ? q[s] / extremes.largest : std::pow(q[s] / extremes.largest, power_));
        return part;
    });
    result.largest = extremes.largest;
    result.mean = extremes.largest * std::pow(total / total_weight_, 1 / power_);
    return result;
}

DistortionEnergy::Element DistortionEnergy::element(int sample, const Eigen::VectorXcd& f,
                                                    Regularisation regularisation, const Value& at, Curvature curvature,
                                                    double floor) const {
    const auto [a, b] = derivatives(sample, f);
    const double r = std::abs(a), s = std::abs(b);
    const DistortionTerm q = distortion_term(r, s, regularisation);

    // dM = factor dq with factor = (w/Σw) (q/M)^(p−1).
    const double part = weight(sample) / total_weight_;
    const double share = power_ == 1 ? 1.0 : std::pow(q.value / at.mean, power_ - 1);
    const double factor = part * share;
    double stiffness = factor;
    if (curvature == Curvature::projected && power_ > 1)
        stiffness = part * std::max(share, kLeastShare * std::pow(at.largest / at.mean, power_ - 1));
    const double bend = (power_ - 1) / q.value;  // of q^p beyond that of q
    const double rr = q.rr + bend * q.r * q.r, rs = q.rs + bend * q.r * q.s, ss = q.ss + bend * q.s * q.s;

    // Eigenvalues and -vectors of the block along a and b.
    const double middle = 0.5 * (rr + ss), half = 0.5 * (rr - ss), radius = std::hypot(half, rs);
    double c = 1, d = 0;  // eigenvector of middle + radius
    if (radius > 0) {
        const double angle = 0.5 * std::atan2(rs, half);
        c = std::cos(angle);
        d = std::sin(angle);
    }
    std::array<double, 4> eigenvalues{stiffness * (middle + radius), stiffness * (middle - radius),
                                      stiffness * q.around_a, stiffness * q.around_b};
    if (curvature == Curvature::projected)
        for (double& value : eigenvalues) value = std::max(value, floor * part);

    const Complex turn_a = r > 0 ? std::conj(a) / r : 1.0, turn_b = s > 0 ? std::conj(b) / s : 1.0;
    const Complex n = nu_[sample];
    const double area = 1 - std::norm(n);
    const auto gradients = operators_.gradient(sample);
    std::array<std::array<double, 4>, most_unknowns> along;  // of every unknown, in the eigenvectors
    Element result;
    for (const Complex g : gradients)
        for (const Complex unit : {Complex(1, 0), Complex(0, 1)}) {
            const Complex d_z = 0.5 * unit * std::conj(g), d_zbar = 0.5 * unit * g;
            const Complex da = turn_a * (d_z - std::conj(n) * d_zbar) / area, db = turn_b * (d_zbar - n * d_z) / area;
            result.gradient[result.unknowns] = factor * (q.r * da.real() + q.s * db.real());
            along[result.unknowns++] = {c * da.real() + d * db.real(), c * db.real() - d * da.real(), da.imag(),
                                        db.imag()};
        }
    int slot = 0;
    for (int i = 0; i < result.unknowns; ++i)
        for (int j = 0; j <= i; ++j) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) sum += eigenvalues[k] * along[i][k] * along[j][k];
            result.hessian[slot++] = sum;
        }
    return result;
}

Eigen::VectorXcd DistortionEnergy::gradient(const Eigen::VectorXcd& f, Regularisation regularisation) const {
    const Value at = value(f, regularisation);
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(f.size());
    for (int s = 0; s < operators_.sample_count(); ++s) {
        if (!counts(s)) continue;
        const Element e = element(s, f, regularisation, at, Curvature::projected);
        const auto stencil = operators_.stencil(s);
        for (std::size_t j = 0; j < stencil.size(); ++j)
            sum[stencil[j]] += Complex(e.gradient[2 * j], e.gradient[2 * j + 1]);
    }
    return sum;
}

double DistortionEnergy::step_to_fold(const Eigen::VectorXcd& f, const Eigen::VectorXcd& d) const {
    double longest = kInfinity;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        if (!counts(s)) continue;
        const auto [a, b] = derivatives(s, f);
        const auto [da, db] = derivatives(s, d);
        // Determinant along the step: c0 + 2 c1 t + c2 t², c0 > 0; its smallest positive root.
        const double c0 = std::norm(a) - std::norm(b), c2 = std::norm(da) - std::norm(db);
        const double c1 = std::real(std::conj(a) * da) - std::real(std::conj(b) * db);
        const double discriminant = c1 * c1 - c0 * c2;
        if (discriminant < 0 || (c1 >= 0 && c2 >= 0)) continue;
        // Of the two roots c0/(−c1 ± √) the smaller positive one; the denominator has no cancellation where it matters.
        const double denominator = -c1 + std::sqrt(discriminant);
        if (denominator > 0) longest = std::min(longest, c0 / denominator);
    }
    return longest;
}

}  // namespace beltrami
