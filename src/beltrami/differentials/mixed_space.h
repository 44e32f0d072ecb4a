#pragma once

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/mixed_domain.h>

namespace beltrami {

/// The holomorphic quadratic differentials of a domain on whose boundary conditions mix: φ τ² real (τ the tangent)
/// along what slides, anything along what is prescribed, with simple poles at pins and marks. Then Re ∫φ ∂̄V = 0 for
/// every V that is tangent along what slides and 0 at what is prescribed. Real coefficients.
///
/// Combinations of powers of z, of r/(z − c) for every hole and of simple poles are holomorphic by construction. Where
/// the condition changes on a circle, at p_1 … p_2m, φ = (z − p)^-1 Σ a_j (z − p)^(j/2): reflection in what slides
/// leaves a slit along what is prescribed. Powers alone fail there, so such a circle has
///     A(w)/∏(1 − w conj ω_j) + B(w)/√∏(1 − w conj ω_j)
/// with polynomials A and B in place of powers of w, where w is z/R on the outer circle and r/(z − c) outside a hole,
/// and ω_j that of p_j: single-valued in the domain.
///
/// Functions are made orthonormal in the mean square over the boundary (weighted towards singular ends), where
/// φ ↦ Im φ τ² along what slides is a real linear map whose singular values are sines of angles between functions and
/// wanted ones. Where every loop has one condition their number is known: with F powers and polynomials for what is
/// prescribed, n holes that slide and q pins it is 2F + 3n + 2q, and 3 less where the outer loop slides. Otherwise they
/// are the values below a cut, in a gap. (slit_space.h has them exactly where only the outer circle slides.)
///
/// refined() raises the degree of what is prescribed; what slides has powers enough throughout.
class MixedSpace final : public DifferentialSpace {
  public:
    /// How well the condition holds.
    struct Fit {
        double residual = 0;  ///< largest ‖Im φ τ²‖/‖φ‖ over the space along what slides, on points between those of
                              ///< the fit
        double last = 0;  ///< largest singular value of the space …
        double next = 1;  ///< … and the least outside it; 1 if there is none
    };

    /// @param degree         of polynomials for the outer loop, and least one of the powers of holes, to begin with
    /// @param largest_degree refined() goes so far with the outer loop …
    /// @param largest_powers … and with every hole, if it is prescribed in part (one number per hole)
    /// @throw Error not_solved if the gap is not where it should be
    MixedSpace(MixedDomain domain, int degree, int largest_degree, const std::vector<int>& largest_powers);

    int size() const override { return static_cast<int>(coefficients_.cols()); }
    bool complex_coefficients() const override { return false; }
    /// The basis itself: combinations of far more powers than there are functions.
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    std::unique_ptr<DifferentialSpace> refined() const override;

    const MixedDomain& domain() const { return family_->domain; }
    const Fit& fit() const { return fit_; }
    /// Of the outer loop.
    int degree() const { return degree_; }

  private:
    /// w^power/q^root of a loop, q² = ∏(1 − w conj ω_j); or scale/(z − centre).
    struct Function {
        int loop;  ///< −1: a pole
        int power, root;
        Complex centre;
        double scale;
    };
    struct Family {
        MixedDomain domain;
        std::vector<std::vector<Complex>> roots;  ///< conj ω_j of every loop
        int largest_degree;
        std::vector<int> largest_powers;
        int resolving;  ///< powers of loops that slide
        BoundarySamples samples;
    };

    explicit MixedSpace(std::shared_ptr<const Family> family) : family_(std::move(family)) {}
    static std::shared_ptr<const Family> family(MixedDomain domain, int largest_degree, std::vector<int> largest_powers,
                                                int resolving);
    /// Appends functions up to a degree, and finds the space again; returns whether the gap is where it should be.
    bool raise(int degree, int power);
    std::vector<Function> functions_up_to(int degree, int power);
    Eigen::MatrixXcd values(const std::vector<Function>& functions, const Eigen::VectorXcd& points) const;
    void orthonormalise(const std::vector<Function>& more);
    Eigen::MatrixXd conditions() const;
    int known_dimension() const;
    void measure();

    std::shared_ptr<const Family> family_;
    int degree_ = -1, power_ = 0;
    std::vector<Function> functions_;
    Eigen::VectorXd lengths_;        ///< of the functions on the samples
    Eigen::MatrixXcd orthonormal_;   ///< #samples × n: weighted values of an orthonormal basis of all of them
    Eigen::MatrixXcd triangle_;      ///< #functions × n: that basis in terms of the functions
    Eigen::MatrixXd space_;          ///< 2n × size(): real and imaginary coefficients of the space in that basis
    Eigen::MatrixXcd coefficients_;  ///< #functions × size()
    Fit fit_;
};

}  // namespace beltrami
