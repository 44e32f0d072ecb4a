#include <beltrami/forms/period_matrix.h>

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// A function of a symmetric matrix.
template <class Function>
Eigen::MatrixXd applied(const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& eigen, const Function& f) {
    return eigen.eigenvectors() * eigen.eigenvalues().unaryExpr(f).asDiagonal() * eigen.eigenvectors().transpose();
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
    const Eigen::MatrixXd dual = result.basis.cast<double>().inverse().transpose().array().round().matrix();
    const Eigen::MatrixXd energies = dual.transpose() * basis.energies * dual;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * g, 2 * g);
    J.topRightCorner(g, g).setIdentity();
    J.bottomLeftCorner(g, g) = -Eigen::MatrixXd::Identity(g, g);

    // A = √E J⁻¹ √E is antisymmetric and similar to the star; −A² = AᵀA would be 1 of holomorphic forms. What makes it
    // so turns E = √E J⁻¹ √E (…) into √E (AᵀA)^{-1/2} √E, which is symplectic.
    const Eigen::MatrixXd root = applied(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(energies),
                                         [](double value) { return std::sqrt(value); });
    const Eigen::MatrixXd A = root * J.transpose() * root;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> square(A.transpose() * A);
    result.defect = (square.eigenvalues().array() - 1).abs().maxCoeff();
    const Eigen::MatrixXd symplectic = root * applied(square, [](double value) { return 1 / std::sqrt(value); }) * root;

    const Eigen::MatrixXd imaginary = symplectic.bottomRightCorner(g, g).inverse();
    const Eigen::MatrixXd real = -symplectic.topRightCorner(g, g) * imaginary;
    result.periods = real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary;
    const Eigen::MatrixXd forms = basis.forms * dual;
    result.forms = forms.leftCols(g).cast<std::complex<double>>() +
                   forms.rightCols(g).cast<std::complex<double>>() * result.periods.transpose();
    return result;
}

}  // namespace beltrami
