#include <beltrami/evening/dilatation_spread.h>

#include <cmath>

#include <beltrami/base/parallel.h>

namespace beltrami {

DilatationSpread::DilatationSpread(const Operators& operators)
    : operators_(operators), samples_(operators.weights.size()) {
    const double area = operators.area(), count = static_cast<double>(samples_.size());
    for (std::size_t s = 0; s < samples_.size(); ++s)
        samples_[s].weight = 0.5 * operators.weights[s] / area + 0.5 / count;
}

void DilatationSpread::set_coefficient(double k, const Eigen::VectorXcd& phi, double anchor) {
    k_ = k;
    const int count = static_cast<int>(phi.size());
    const double total = parallel_sum<double>(count, 0.0, [&](int first, int last) {
        double sum = 0;
        for (int s = first; s < last; ++s) sum += operators_.weights[s] * std::sqrt(std::norm(phi[s]));
        return sum;
    });
    parallel_for(0, count, [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const double size = std::sqrt(std::norm(phi[s]));
            samples_[s].nu_re = size > 0 ? k * phi[s].real() / size : 0;
            samples_[s].nu_im = size > 0 ? -k * phi[s].imag() / size : 0;
            samples_[s].anchor = total > 0 ? anchor * operators_.weights[s] * size / total : 0;
        }
    });
}

void DilatationSpread::set_map(const Eigen::VectorXcd& f) {
    parallel_for(0, static_cast<int>(samples_.size()), [&](int first, int last) {
        for (int s = first; s < last; ++s) {
            const auto [p, q] = operators_.derivatives(s, f);
            samples_[s].p_re = p.real();
            samples_[s].p_im = p.imag();
            samples_[s].q_re = q.real();
            samples_[s].q_im = q.imag();
        }
    });
}

void DilatationSpread::set_samples(const DilatationSpread& from, const std::vector<int>& samples) {
    k_ = from.k_;
    for (std::size_t i = 0; i < samples.size(); ++i) samples_[i] = from.samples_[samples[i]];
}

DilatationSpread::Value DilatationSpread::value(double outlier_penalty) const {
    return parallel_sum(static_cast<int>(samples_.size()), Value{}, [&](int first, int last) {
        Value sum;
        for (int i = first; i < last; ++i) {
            const SpreadSample& s = samples_[i];
            sum += spread_value(s, k_, outlier_penalty, s.p_re, s.p_im, s.q_re, s.q_im);
        }
        return sum;
    });
}

DilatationSpread::Element DilatationSpread::element(int sample, double outlier_penalty, Derivative derivative,
                                                    double damping) const {
    const SpreadSample& s = samples_[sample];
    const SpreadTerm t = derivative == Derivative::exact ? spread_term_exact(s, k_) : spread_term_held(s, k_);
    const Complex p(s.p_re, s.p_im), q(s.q_re, s.q_im), nu(s.nu_re, s.nu_im);
    const Complex rest = (q - nu * p) * t.inverse_size;
    const double r2 = outlier_penalty * t.r * t.r, slope = s.weight * (1 + 2 * r2) * t.r,
                 curvature = s.weight * (1 + 6 * r2), dirichlet = 2 * damping * s.weight;
    const auto gradients = operators_.gradient(sample);
    std::array<Complex, most_unknowns / 2> across;  // C
    std::array<double, most_unknowns> along;        // r by the unknowns
    Element result;
    for (std::size_t i = 0; i < gradients.size(); ++i) {
        const Complex h = 0.5 * gradients[i];
        const Complex g = t.along_q * std::conj(q) * h + t.along_p * std::conj(p * h);
        across[i] = (h - nu * std::conj(h)) * t.inverse_size;
        along[2 * i] = g.real();
        along[2 * i + 1] = -g.imag();
        const Complex force = s.anchor * rest * std::conj(across[i]);
        result.gradient[2 * i] = slope * along[2 * i] + force.real();
        result.gradient[2 * i + 1] = slope * along[2 * i + 1] + force.imag();
    }
    double* slot = result.hessian.data();
    for (int i = 0; i < 2 * static_cast<int>(gradients.size()); ++i)
        for (int j = 0; j <= i; ++j) {
            const Complex product = std::conj(across[i / 2]) * across[j / 2];
            double anchored = 0;
            if (i % 2 == j % 2)
                anchored = (s.anchor + dirichlet) * product.real();
            else
                anchored = (i % 2 == 0 ? -1 : 1) * s.anchor * product.imag();
            *slot++ = curvature * along[i] * along[j] + anchored;
        }
    return result;
}

}  // namespace beltrami
