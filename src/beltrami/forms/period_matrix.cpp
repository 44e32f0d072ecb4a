#include <beltrami/forms/period_matrix.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/linear/decomposition.h>

namespace beltrami {

namespace {

/// A function of a symmetric matrix.
template <class Function>
Eigen::MatrixXd applied(const SymmetricEigen& eigen, const Function& f) {
    return eigen.vectors * eigen.values.unaryExpr(f).asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

PeriodMatrix period_matrix(const Surface& surface, const HarmonicBasis& basis) {
    const int g = surface.topology.genus;
    if (g == 0) throw Error(Cause::bad_mesh, "the surface has genus 0, and no periods", "take one with handles");
    if (!surface.topology.boundary_loops.empty())
        throw Error(Cause::bad_mesh, "the surface has a boundary, and periods are those of closed surfaces",
                    "fill its holes");
    PeriodMatrix result;
    result.basis = symplectic_basis(basis.homology.intersections);
    // Forms dual to the columns of P are combined by the inverse of P, transposed; its entries are integers.
    const Eigen::MatrixXd dual = matrix_inverse(result.basis.cast<double>()).transpose().array().round().matrix();
    const Eigen::MatrixXd energies = dual.transpose() * basis.energies * dual;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * g, 2 * g);
    J.topRightCorner(g, g).setIdentity();
    J.bottomLeftCorner(g, g) = -Eigen::MatrixXd::Identity(g, g);

    // A = √E J⁻¹ √E is antisymmetric and similar to the star; −A² = AᵀA would be 1 of holomorphic forms. What makes it
    // so turns E = √E J⁻¹ √E (…) into √E (AᵀA)^{-1/2} √E, which is symplectic.
    const Eigen::MatrixXd root = applied(symmetric_eigen(energies), [](double value) { return std::sqrt(value); });
    const Eigen::MatrixXd A = root * J.transpose() * root;
    const SymmetricEigen square = symmetric_eigen(A.transpose() * A);
    result.defect = (square.values.array() - 1).abs().maxCoeff();
    const Eigen::MatrixXd symplectic = root * applied(square, [](double value) { return 1 / std::sqrt(value); }) * root;

    const Eigen::MatrixXd imaginary = matrix_inverse(symplectic.bottomRightCorner(g, g));
    const Eigen::MatrixXd real = -symplectic.topRightCorner(g, g) * imaginary;
    result.periods = real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary;
    const Eigen::MatrixXd forms = basis.forms * dual;
    result.forms = forms.leftCols(g).cast<std::complex<double>>() +
                   forms.rightCols(g).cast<std::complex<double>>() * result.periods.transpose();
    return result;
}

}  // namespace beltrami
