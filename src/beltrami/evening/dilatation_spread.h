#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <beltrami/operators/operators.h>

namespace beltrami {

/// What the spread of |μ| needs to know about one sample. A plain record of one cache line, with real numbers instead
/// of complex ones: sweeps read nothing else.
struct SpreadSample {
    double p_re, p_im, q_re, q_im;  ///< p = ∂f, q = ∂̄f
    double nu_re, nu_im;            ///< k conj(φ)/|φ|, 0 where φ says nothing
    double weight, anchor;          ///< shares, each of sum 1 and of sum λ
};

/// Derivatives at one sample, for a vertex with half hat gradient h that moves by d, with δp = d conj(h), δq = d h:
/// the real r changes by Re(G d), G = along_q conj(q) h + along_p conj(p) conj(h), and the complex (q − νp)/S by
/// C d, C = (h − ν conj(h))/S, where S is held.
struct SpreadTerm {
    double r, along_p, along_q;
    double inverse_size;  ///< 1/S
};

/// How far the dilatation of a map is from a constant k, and its phase from conj(φ)/|φ|:
///
///     E = Σ w ψ(r) + Σ a |q − νp|²/S²,   r = (|q| − k|p|)/S,   S² = (|p|² + |q|²)/(1 + k²),   ψ(r) = r² (1 + Q r²).
///
/// w is half the share of the area and half that of the number of samples; a, of sum λ, is the share of A|φ|, which is
/// the weight that the Reich-Strebel bound gives a sample. Q > 0 is a penalty on outliers. E depends on angles and
/// ratios only: similarities of source and image do not change it. Folded samples have a finite part.
class DilatationSpread {
  public:
    /// @param operators kept by reference
    explicit DilatationSpread(const Operators& operators);

    /// @param k      0 ≤ k < 1
    /// @param phi    #S
    /// @param anchor λ
    void set_coefficient(double k, const Eigen::VectorXcd& phi, double anchor);
    /// Takes ∂ and ∂̄ of a map (#V).
    void set_map(const Eigen::VectorXcd& f);

    /// Takes k, and map and weights of some samples, from the spread of a larger mesh.
    void set_samples(const DilatationSpread& from, const std::vector<int>& samples);

    double k() const { return k_; }
    const Operators& operators() const { return operators_; }
    /// Of the map that was set.
    std::vector<SpreadSample>& samples() { return samples_; }
    const std::vector<SpreadSample>& samples() const { return samples_; }
    struct Value {
        double energy = 0;
        int flipped = 0;  ///< samples with |p| ≤ |q|
        Value& operator+=(const Value& other) {
            energy += other.energy;
            flipped += other.flipped;
            return *this;
        }
        /// Fewer flips, or as many and less energy.
        bool better_than(const Value& other) const {
            return flipped != other.flipped ? flipped < other.flipped : energy < other.energy;
        }
        /// Less energy without a new flip.
        bool improves(const Value& other) const { return flipped <= other.flipped && energy < other.energy; }
    };
    /// @param outlier_penalty Q
    Value value(double outlier_penalty) const;

    enum class Derivative {
        size_held,  ///< as if S were constant: Gauss-Newton steps are longer and safer far from the end
        exact
    };
    static constexpr int most_unknowns = 8;
    /// Gauss-Newton derivatives of one sample's part of E by the real and imaginary parts of its stencil, vertex by
    /// vertex.
    struct Element {
        std::array<double, most_unknowns> gradient;
        std::array<double, most_unknowns*(most_unknowns + 1) / 2> hessian;  ///< (0,0), (1,0), (1,1), (2,0) …
    };
    /// @param damping adds so much of Σ w |∂̄δ − ν∂δ|²/S² for real and imaginary part alone: a Dirichlet energy of the
    /// step
    Element element(int sample, double outlier_penalty, Derivative derivative, double damping = 0) const;

  private:
    const Operators& operators_;
    double k_ = 0;
    std::vector<SpreadSample> samples_;
};

/// A sample's part of E for other p and q.
inline DilatationSpread::Value spread_value(const SpreadSample& s, double k, double outlier_penalty, double p_re,
                                            double p_im, double q_re, double q_im) {
    const double p2 = p_re * p_re + p_im * p_im, q2 = q_re * q_re + q_im * q_im;
    const double inverse = (1 + k * k) / std::max(p2 + q2, 1e-300);  // 1/S²
    const double gap = std::sqrt(q2) - k * std::sqrt(p2), r2 = gap * gap * inverse;
    const double x = q_re - (s.nu_re * p_re - s.nu_im * p_im), y = q_im - (s.nu_re * p_im + s.nu_im * p_re);
    return {s.weight * r2 * (1 + outlier_penalty * r2) + s.anchor * (x * x + y * y) * inverse, p2 <= q2};
}

/// As if S were constant.
inline SpreadTerm spread_term_held(const SpreadSample& s, double k) {
    const double p = std::sqrt(std::max(s.p_re * s.p_re + s.p_im * s.p_im, 1e-300)),
                 q = std::sqrt(std::max(s.q_re * s.q_re + s.q_im * s.q_im, 1e-300));
    const double inverse = std::sqrt((1 + k * k) / (p * p + q * q));
    return {(q - k * p) * inverse, -k * inverse / p, inverse / q, inverse};
}

/// With the exact derivative of r.
inline SpreadTerm spread_term_exact(const SpreadSample& s, double k) {
    const SpreadTerm held = spread_term_held(s, k);
    // r = (|q| − k|p|)/S and dS/S = (|p| d|p| + |q| d|q|)/(|p|² + |q|²).
    const double shrink = held.r * held.inverse_size * held.inverse_size / (1 + k * k);
    return {held.r, held.along_p - shrink, held.along_q - shrink, held.inverse_size};
}

}  // namespace beltrami
