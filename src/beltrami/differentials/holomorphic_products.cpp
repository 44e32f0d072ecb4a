#include <beltrami/differentials/holomorphic_products.h>

#include <cmath>

#include <beltrami/linear/decomposition.h>

namespace beltrami {

namespace {

constexpr double kLeastSingularValue = 2e-2;  // of the largest

/// ω = a dz on every face, from its values along edges: #F×g.
Eigen::MatrixXcd on_faces(const Surface& source, const Eigen::MatrixXcd& forms) {
    const FaceList& faces = source.mesh.faces;
    Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(faces.size(), forms.cols());
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f);
        const auto gradients = source.operators.gradient(f);
        Eigen::RowVectorXcd value = Eigen::RowVectorXcd::Zero(forms.cols());
        for (int k = 0; k < 3; ++k) {
            result.row(f) += 0.5 * std::conj(gradients[static_cast<std::size_t>(k)]) * value;
            const int edge = source.topology.corner_edges[first + k];
            const bool along = source.topology.edges[edge][0] == faces.vertices()[first + k];
            value += (along ? 1.0 : -1.0) * forms.row(edge);
        }
    }
    return result;
}

}  // namespace

std::optional<TabulatedSpace> holomorphic_products(const Surface& source, const PeriodMatrix& periods) {
    if (periods.forms.cols() != 2) return {};
    const Eigen::MatrixXcd forms = on_faces(source, periods.forms);
    const Eigen::VectorXd roots =
        Eigen::Map<const Eigen::VectorXd>(source.operators.weights.data(), forms.rows()).cwiseSqrt();
    Eigen::MatrixXcd products(forms.rows(), 3);
    for (int i = 0, count = 0; i < 2; ++i)
        for (int j = i; j < 2; ++j)
            products.col(count++) = (roots.asDiagonal() * forms.col(i).cwiseProduct(forms.col(j))).normalized();
    const HermitianEigen gram = hermitian_eigen(products.adjoint() * products);
    const Eigen::VectorXd& squares = gram.values;
    if (!(squares[0] > kLeastSingularValue * kLeastSingularValue * squares[2])) return {};
    const Eigen::MatrixXcd orthonormal = products * gram.vectors * squares.cwiseSqrt().cwiseInverse().asDiagonal();
    return TabulatedSpace(roots.cwiseInverse().asDiagonal() * orthonormal, Coefficients::complex);
}

}  // namespace beltrami
