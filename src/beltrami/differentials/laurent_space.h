#pragma once

#include <beltrami/differentials/differential_space.h>
#include <beltrami/differentials/round_domain.h>

namespace beltrami {

struct LaurentOptions {
    double tolerance = 1e-9;   ///< of φ τ² being real, see LaurentSpace::Fit
    int first_degree = 16;     ///< powers for each circle to begin with, at least 4; more while need be …
    int largest_degree = 128;  ///< … up to this
    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// The holomorphic quadratic differentials of a circle domain with φ τ² real along the boundary: what extremal maps
/// have whose boundary slides. Real coefficients; the dimension is that of dimension_of_differentials.
///
/// Combinations of powers of z, of r/(z − c) for every hole and of a simple pole at every mark are holomorphic by
/// construction. Of these, the ones with Im φ (z − c)² = 0 on every circle are found: with functions orthonormal in the
/// mean square over the circles (weighted towards marks, where φ² is not integrable), φ ↦ Im φ τ² is a real linear map
/// whose singular values are sines of angles between all functions and the wanted ones. Those of the wanted functions
/// fall geometrically with the degree; the others stay. Circles that nearly touch need high degrees.
class LaurentSpace final : public DifferentialSpace {
  public:
    /// How well the boundary condition holds.
    struct Fit {
        int degree = 0;       ///< powers for each circle
        double residual = 0;  ///< largest ‖Im φ τ²‖ / ‖φ‖ over the space, on points between those of the fit
        double next = 1;      ///< least ‖Im φ τ²‖ / ‖φ‖ outside the space: the gap is from residual to this
        /// Ascending singular values around the gap: those of the space first.
        Eigen::VectorXd singular_values;
    };

    /// @throw Error bad_option for an impossible domain; not_solved if the gap is not where it should be
    explicit LaurentSpace(RoundDomain domain, const LaurentOptions& options = {});

    int size() const override { return static_cast<int>(coefficients_.cols()); }
    bool complex_coefficients() const override { return false; }
    /// The basis itself: combinations of far more powers than there are functions.
    Eigen::MatrixXcd generators(const ChartPoints& points) const override;
    std::unique_ptr<DifferentialSpace> refined() const override { return nullptr; }

    const RoundDomain& domain() const { return domain_; }
    const Fit& fit() const { return fit_; }

  private:
    /// (scale/(z − centre))^power; power < 0: ((z − centre)/scale)^(−power).
    struct Power {
        Complex centre;
        double scale;
        int power;
    };
    std::vector<Power> powers_up_to(int degree) const;
    static Eigen::MatrixXcd values(const std::vector<Power>& powers, const Eigen::VectorXcd& points);
    /// Finds the space within powers up to a degree; returns whether the gap is at the right place.
    bool find(int degree, int dimension);

    RoundDomain domain_;
    Fit fit_;
    std::vector<Power> powers_;
    Eigen::MatrixXcd coefficients_;  ///< #powers × size()
};

}  // namespace beltrami
