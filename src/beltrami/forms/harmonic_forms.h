#pragma once

#include <beltrami/operators/surface.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami::detail {

/// The discrete holomorphic quadratic differentials of Weber, Myles & Zorin 2012, section 4.1: harmonic 1-forms.
///
/// With a complex coordinate z of the whole source, φ dz² is holomorphic exactly when the real 1-form h = Re(φ dz) is
/// closed and coclosed. Their unknowns are the values of h on the edges, constrained (eq. 10) to add up to 0 around
/// every face and, with cotangent weights, around every interior vertex. The closed ones are the differences h = du of
/// a function of the vertices that grows by a constant period around each hole; here u and the periods are the
/// unknowns, the same space without its first constraint. On a face φ = 2∂u, which is their eq. (8); as printed, (8)
/// gives the conjugate. Quads take the bilinear u at their samples.
///
/// The coordinate of a planar source is its own. Of any other it is a conformal flattening (conformal/flatten.h), as in
/// the paper's section 4.2, its holes filled by cones first. It serves only to write φ down; unlike the paper, u is
/// harmonic and ∂ taken in the metric of the source, so the flattening's error does not enter f and μ.
class HarmonicForms {
  public:
    struct Form {
        Eigen::VectorXd potential;  ///< #V
        Eigen::VectorXd periods;    ///< #holes
    };

    /// @param warnings of the flattening are added
    /// @pre one component with a boundary
    /// @throw Error bad_mesh unless the genus is 0; not_solved if the flattening fails
    HarmonicForms(const Surface& source, Warnings& warnings);

    Form zero() const;
    /// #S values of φ in the samples' frames.
    Eigen::VectorXcd values(const Form& form) const;
    /// The form that minimises Σ weights |φ|² − 2 Re Σ conj(pull) φ, by conjugate gradients over the harmonic forms.
    /// They are preconditioned by the forms that are harmonic in the weighted metric (one factorisation), which near
    /// the boundary, where it matters, are almost the same. The error left is about 1e-5 of the solution.
    /// @param weights #S, positive
    /// @param pull    #S
    /// @param start   a guess
    Form fit(const Eigen::VectorXd& weights, const Eigen::VectorXcd& pull, const Form& start);

    int hole_count() const { return static_cast<int>(hole_fields_.size()); }
    int factorization_count() const { return neumann_.factorization_count() + dirichlet_.factorization_count(); }

  private:
    Eigen::VectorXcd field(const Form& form) const;
    Form force(const Eigen::VectorXcd& flux) const;
    Form precondition(const Form& residual) const;
    Eigen::VectorXd laplacian(const Eigen::VectorXd& u) const;

    const Operators& operators_;
    Eigen::VectorXcd dz_;                        // #S derivative of the coordinate in the samples' frames
    Laplacian neumann_;                          // of the last weights
    Laplacian dirichlet_;                        // of the metric, the boundary held
    std::vector<Eigen::VectorXcd> hole_fields_;  // per hole: #S, the form of period 1 there and of least norm
    Eigen::MatrixXd hole_gram_inverse_;          // of the last weights
};

}  // namespace beltrami::detail
