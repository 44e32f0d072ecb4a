#pragma once

#include <memory>
#include <vector>

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/mixed_domain.h>

namespace beltrami {

/// The holomorphic quadratic differentials of a circle domain whose outer circle slides in part: φ τ² real (τ the
/// tangent) along arcs that slide, anything along arcs and holes that are prescribed, with simple poles at pins and
/// marks and, where the condition changes, the exponents −1, −½, 0, ½ … of mixed_space.h. Real coefficients.
///
/// In a coordinate x that takes the disk to the upper half plane, ∞ in the middle of an arc that slides, reflection
/// continues φ dx² to the plane less slits, the prescribed arcs, and less the prescribed holes and their mirror images:
/// φ(conj x) = conj φ(x), and φ = O(x^-4). Laurent's theorem and Cauchy's integral make it a sum of
///     J^-n/(u² − 1), n ≥ −1, for every slit, u = (2x − a − b)/(b − a), J = u + √(u² − 1), |J| > 1 outside [a, b];
///     α (r/(x − c))^n + conj α (r/(x − conj c))^n, n ≥ 1, for every hole, the same with n = 1 for every pin;
///     1/(x − m) for every mark,
/// with real coefficients, where the terms in 1/x, 1/x² and 1/x³ cancel. The pairs of polynomials of mixed_space.h
/// span the same, but from degree 20 on rounding does not tell them apart, and their real combinations have to be
/// found.
///
/// refined() raises the powers.
class SlitSpace final : public DifferentialSpace {
  public:
    /// Whether a domain is of this kind: some arc of the outer circle slides and some is prescribed, the holes are
    /// prescribed.
    static bool describes(const MixedDomain& domain);

    /// @param degree         powers of J to begin with; of holes half as many
    /// @param largest_degree refined() goes so far …
    /// @param largest_powers … and with every hole (one number per hole)
    /// @pre describes(domain)
    SlitSpace(const MixedDomain& domain, int degree, int largest_degree, const std::vector<int>& largest_powers);

    int size() const override { return static_cast<int>(coefficients_.cols()); }
    bool complex_coefficients() const override { return false; }
    /// The functions above.
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    const Eigen::MatrixXcd* transform() const override { return &coefficients_; }
    std::unique_ptr<DifferentialSpace> refined() const override;

    int degree() const { return degree_; }

  private:
    struct Slit {
        double middle, half;
    };
    /// A hole or a pole, with its mirror image.
    struct Place {
        Complex centre;
        double radius;
        int largest_power;
        std::vector<Complex> coefficients;  ///< α that are admissible
    };
    /// (radius/(x − centre))^power and its mirror image, J^-power/(u² − 1), or 1/(x − mark).
    struct Function {
        enum class Kind { slit, place, mark } kind;
        int index;
        int power;
        Complex coefficient;
    };
    struct Family {
        Complex infinity = 1;         ///< on the circle: x = ∞
        double shift = 0, scale = 1;  ///< of x, so that the first slit is [−1, 1]
        std::vector<Slit> slits;
        std::vector<Place> places;
        std::vector<double> marks;
        int largest_degree = 0;
        BoundarySamples samples;

        Complex coordinate(Complex w) const;
        Complex derivative(Complex w) const;
    };

    explicit SlitSpace(std::shared_ptr<const Family> family) : family_(std::move(family)) {}
    static std::shared_ptr<const Family> family(const MixedDomain& domain, int largest_degree,
                                                const std::vector<int>& largest_powers);
    void raise(int degree);
    std::vector<Function> functions_up_to(int degree) const;
    Eigen::MatrixXcd values(const std::vector<Function>& functions, const Eigen::VectorXcd& points) const;
    Eigen::Vector3d tail(const Function& function) const;

    std::shared_ptr<const Family> family_;
    int degree_ = 1;
    std::vector<Function> functions_;  ///< the first three cancel the tails of the others
    Eigen::MatrixXd orthonormal_;      ///< 2#samples × size(): weighted values, real parts over imaginary ones
    Eigen::MatrixXcd coefficients_;    ///< #functions × size(), real
};

}  // namespace beltrami
