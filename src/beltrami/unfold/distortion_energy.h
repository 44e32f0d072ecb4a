#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <beltrami/operators/operators.h>

namespace beltrami {

/// How the energy is made finite for folds.
struct Regularisation {
    double epsilon = 0;  ///< ε ≥ 0 of χ_ε(D) = ½(D + √(ε² + D²))
    double area =
        0;  ///< λ ≥ 0: with ε > 0 a map can lower the plain energy by shrinking; the term λ(1 + D²)/χ_ε(D) stops that
};

/// q = (r² + s² + λ(1 + D²))/χ_ε(D), D = r² − s², with r = |a| and s = |b|: the mean of the squared singular values of
/// a linear map over its regularised determinant. Without regularisation it is (1+|μ|²)/(1−|μ|²), at least 1.
///
/// q sees a and b in the plane only through their lengths, so its 4×4 Hessian is block diagonal in the frame of a and
/// b:
/// [[rr, rs], [rs, ss]] along them, around_a and around_b across them.
struct DistortionTerm {
    double value = 0;
    double r = 0, s = 0;                ///< first derivatives
    double rr = 0, rs = 0, ss = 0;      ///< second derivatives
    double around_a = 0, around_b = 0;  ///< q_r/r and q_s/s, finite at r = 0 and s = 0
};

/// @pre ε > 0, or ε = λ = 0 and r > s
DistortionTerm distortion_term(double r, double s, Regularisation regularisation);

/// The generalised MIPS energy in the metric of a Beltrami coefficient ν,
///
///     M(f) = ( Σ w q^p / Σ w )^{1/p},   w = A(1−|ν|²),   a = (∂f − conj(ν)∂̄f)/(1−|ν|²),   b = (∂̄f − ν∂f)/(1−|ν|²).
///
/// a, b are the derivatives of f in a frame in which a map with coefficient ν is conformal; |a|² − |b|² is the
/// determinant there, w the area. Without regularisation M = 1 exactly if f has the coefficient ν everywhere, and ν =
/// 0, p = 1 is the MIPS energy of Hormann and Greiner (1999). A term with ε = 0 that is folded makes M infinite.
/// Samples whose vertices are all fixed are left out.
class DistortionEnergy {
  public:
    struct Value {
        double mean = 0;                  ///< M
        double largest = 0;               ///< largest q
        double smallest_determinant = 0;  ///< least |a|² − |b|²
        bool finite() const { return mean < std::numeric_limits<double>::infinity(); }
    };
    /// Which second derivatives element() returns.
    enum class Curvature {
        exact,     ///< of Σ w q^p, scaled like the gradient
        projected  ///< the nearest positive semidefinite ones, every eigenvalue at least the floor
    };
    static constexpr int most_unknowns = 8;
    /// Derivatives of one sample's part of M by the real and imaginary parts of its stencil, vertex by vertex.
    struct Element {
        int unknowns = 0;
        std::array<double, most_unknowns> gradient;
        std::array<double, most_unknowns*(most_unknowns + 1) / 2> hessian;  ///< (0,0), (1,0), (1,1), (2,0) …
    };

    /// @param operators must outlive this
    /// @param nu        #S, |ν| < 1
    /// @param power     p ≥ 1
    /// @param left_out  #S flags of samples that do not count; may be empty
    DistortionEnergy(const Operators& operators, Eigen::VectorXcd nu, double power, std::vector<char> left_out = {});

    void set_power(double power) { power_ = power; }
    bool counts(int sample) const { return left_out_.empty() || !left_out_[sample]; }
    /// (a, b) at a sample.
    std::array<Complex, 2> derivatives(int sample, const Eigen::VectorXcd& f) const;

    Value value(const Eigen::VectorXcd& f, Regularisation regularisation) const;
    /// @param at    value(f, regularisation), finite
    /// @param floor least eigenvalue of the projected 4×4 Hessian, in units of w/Σw
    Element element(int sample, const Eigen::VectorXcd& f, Regularisation regularisation, const Value& at,
                    Curvature curvature, double floor = 0) const;
    /// ∂M/∂(Re f_v) + i ∂M/∂(Im f_v) (#V).
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& f, Regularisation regularisation) const;
    /// The largest t such that f + τd has no folded sample for 0 ≤ τ < t; infinite if there is none.
    /// @pre f has no folded sample
    double step_to_fold(const Eigen::VectorXcd& f, const Eigen::VectorXcd& d) const;

  private:
    const Operators& operators_;
    Eigen::VectorXcd nu_;
    double power_;
    std::vector<char> left_out_;
    double total_weight_ = 0;

    double weight(int sample) const { return operators_.weights[sample] * (1 - std::norm(nu_[sample])); }
};

}  // namespace beltrami
