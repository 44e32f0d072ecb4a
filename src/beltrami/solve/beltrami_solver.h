#pragma once

#include <memory>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The map with a given Beltrami coefficient: minimises Σ A |∂̄f − ν ∂f|²/(1−|ν|²) over f = f₀ + B y, where B holds
/// what each vertex is free to do. One symbolic analysis; any number of coefficients.
///
/// Where every boundary vertex is fixed, the area of the image is fixed too and the energy decouples into one real
/// symmetric positive definite #V×#V system with two right-hand sides; else real and imaginary parts are coupled.
/// Harmonic maps and least-squares conformal maps are ν = 0.
class BeltramiSolver {
  public:
    /// @param freedoms               #V
    /// @param expected_factorizations see ElementSystem
    BeltramiSolver(const Surface& source, std::vector<Freedom> freedoms, int expected_factorizations);
    ~BeltramiSolver();
    BeltramiSolver(BeltramiSolver&&) noexcept;

    /// Assembles and factorises for a coefficient.
    /// @param nu             #S coefficients in the samples' frames, |ν| < 1
    /// @param directions     #V directions of the sliding vertices (ignored elsewhere; may be empty if none slides)
    /// @param extra_diagonal #V added to the diagonal entry of sliding vertices (curvature of their curves; may be
    /// empty).
    ///                       It is held above −0.3 of the entry it is added to.
    /// @throw Error not_solved naming vertices that are not constrained
    void factorize(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& directions = {},
                   const Eigen::VectorXd& extra_diagonal = {});

    /// Solves with the last factorisation. Fixed vertices keep their value of @p start; sliding ones have moved along
    /// their direction; what free vertices have in @p start does not matter.
    Eigen::VectorXcd solve(const Eigen::VectorXcd& start) const;

    /// The same for f that minimises Σ A |∂̄f − ν ∂f + r|²/(1−|ν|²): what is added to a function whose derivatives are
    /// known, though it may be multivalued itself, to make the sum a solution.
    /// @param offset #S the r of every sample
    Eigen::VectorXcd solve(const Eigen::VectorXcd& start, const Eigen::VectorXcd& offset) const;

    /// The f that minimise Σ A |∂̄f − ν ∂f + r|²/(1−|ν|²) and are 0 at fixed vertices, for many r at once.
    /// @param offsets #S × any number, one r in each column
    /// @return #V × as many
    Eigen::MatrixXcd solve_offsets(const Eigen::MatrixXcd& offsets) const;

    /// The real function u, 0 at the fixed vertices, with ∫ ∇u·∇v = Σ load·v for every v: −Δu = load.
    /// @param load #V integrals against the vertices' hat functions
    /// @pre decoupled(), and the last factorisation is of the coefficient 0
    Eigen::VectorXd solve_poisson(const Eigen::VectorXd& load) const;

    /// The map for a coefficient near that of the last factorize(): by conjugate gradients with the old factor where
    /// that takes few steps, else with a new one.
    /// @param guess     a map to start from, e.g. that of the old coefficient
    /// @param tolerance of the error, relative to the map, in the energy norm; at least 1e-11
    Eigen::VectorXcd solve_near(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& start,
                                const Eigen::VectorXcd& guess, double tolerance = 1e-11);
    /// The same with sliding vertices, whose directions and curvature may have changed too (see factorize).
    Eigen::VectorXcd solve_near(const Eigen::VectorXcd& nu, const Eigen::VectorXcd& directions,
                                const Eigen::VectorXd& extra_diagonal, const Eigen::VectorXcd& start,
                                const Eigen::VectorXcd& guess, double tolerance = 1e-11);

    /// D^H W D f with D = ∂̄ − ν∂: the force on each vertex (#V), for curvature terms.
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& f, const Eigen::VectorXcd& nu) const;
    /// With the ν of the last factorize.
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& f) const;

    /// #V as given.
    const std::vector<Freedom>& freedoms() const;
    bool decoupled() const;
    int factorization_count() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// The harmonic map of the surface's metric: cotangent weights (Pinkall & Polthier 1993) on triangles.
/// @pre the whole boundary is prescribed
/// @throw Error bad_boundary, not_solved
Eigen::VectorXcd harmonic_map(const Surface& source, const BoundaryCondition& boundary,
                              int expected_factorizations = 1);

/// The least-squares conformal map (Lévy et al. 2002) with the given pins, at least two of which must differ; where a
/// boundary vertex is not pinned it is free. With no pins, two boundary vertices far apart are pinned at their
/// distance.
/// @throw Error bad_boundary, not_solved
Eigen::VectorXcd least_squares_conformal_map(const Surface& source, const BoundaryCondition& boundary);

}  // namespace beltrami
