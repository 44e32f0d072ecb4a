#pragma once

#include <memory>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/space/corner_elements.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What a map of a surface into space keeps of it, beside the prescribed places.
enum class Preserve {
    nothing,
    normals,  ///< vertices move in their tangent planes: ⟨f − X, N⟩ = 0
    area,     ///< the first variation of the area vanishes: ⟨L X, f − X⟩ = 0, L the cotangent Laplacian
};

/// The least-squares quasiconformal maps of a surface into space, which minimise
///
///     QC_μ(f) = 2 Σ_T A_T ( |∂̄f_t − μ ∂f_t|² + |∂̄h − μ ∂h|² ),
///
/// f_t the part of f in the tangent plane of the source's triangle T as a complex number, h its height above it.
/// Sources: Gruber, Aulisa 2022, "Quasiconformal mappings for surface mesh optimization" (Algorithms 1 and 2), where
/// the energy is written in quaternions. Here its matrix has blocks of 3×3,
///
///     J_jk = 2 A ( Re(c̄_j c_k) I + Im(c̄_j c_k) [N]× ),    c_k = ½ (g_k − μ ḡ_k),
///
/// g_k the hat gradients and N the triangle's normal. The area constraint is theirs without the multiplier's block, the
/// normal constraint holds exactly: two unknowns a vertex, the limit of their penalty.
class LeastSquaresMap {
  public:
    /// @param source    mesh in space; kept by reference, as are the elements
    /// @param elements  of the source's own metric or of reference shapes
    /// @param places    #V×3: the prescribed places of fixed vertices; others are not read
    /// @param fixed     #V
    /// @throw Error bad_boundary where the problem collapses to a point: nothing preserved and less than two places
    ///        prescribed on some component
    LeastSquaresMap(const Mesh& source, const CornerElements& elements, Positions places, std::vector<char> fixed,
                    Preserve preserve);
    ~LeastSquaresMap();

    /// The map with a coefficient in the elements' frames.
    /// @param mu #S, |μ| < 1
    /// @return #V×3
    /// @throw Error not_solved
    Positions solve(const Eigen::VectorXcd& mu);

    /// J f: half the gradient of QC_μ, #V×3.
    Positions gradient(const Eigen::VectorXcd& mu, const Positions& map) const;
    /// QC_μ(f).
    double energy(const Eigen::VectorXcd& mu, const Positions& map) const;
    /// Part of the way from one coefficient to another, 0 … 1, on which QC(f) is least (exact).
    double best_step(const Eigen::VectorXcd& from, const Eigen::VectorXcd& to, const Positions& map) const;

    const CornerElements& elements() const { return elements_; }
    int factorization_count() const;

  private:
    struct System;

    std::vector<int> unreferenced() const;
    void hold_gauge();
    void refuse_collapse() const;

    const Mesh& source_;
    const CornerElements& elements_;
    Positions normals_;  // #S×3
    Positions places_;   // #V×3, the source's positions where free
    std::vector<char> fixed_;
    Preserve preserve_;
    std::unique_ptr<System> system_;
};

}  // namespace beltrami
