#include <Eigen/SparseCholesky>

#include <beltrami/linear/backend.h>
#include <beltrami/linear/dense.h>
#include <beltrami/linear/linear_backend.h>

namespace beltrami {

Eigen::MatrixXd gram_lower(const Eigen::Ref<const Eigen::MatrixXd>& A) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(A.cols(), A.cols());
    result.selfadjointView<Eigen::Lower>().rankUpdate(A.transpose());
    return result;
}

Eigen::MatrixXcd complex_product(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B) {
    return A * B;
}

Eigen::MatrixXcd complex_gram_upper(const Eigen::MatrixXcd& A) {
    Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(A.cols(), A.cols());
    result.selfadjointView<Eigen::Upper>().rankUpdate(A.adjoint());
    return result;
}

const char* linear_backend() {
    return "Eigen SimplicialLDLT";
}

namespace detail {
namespace {

class EigenBackend final : public CholeskyBackend {
  public:
    explicit EigenBackend(const Matrix& lower) { cholesky_.analyzePattern(lower); }

    bool factorize(const Matrix& lower) override {
        cholesky_.factorize(lower);
        return cholesky_.info() == Eigen::Success && cholesky_.vectorD().minCoeff() > 0;
    }

    double pivot_ratio() const override {
        const auto d = cholesky_.vectorD();
        return d.size() ? d.minCoeff() / d.maxCoeff() : 1.0;
    }

    void solve(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) override { solution = cholesky_.solve(rhs); }

  private:
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower> cholesky_;
};

}  // namespace

std::unique_ptr<CholeskyBackend> make_backend(const CholeskyBackend::Matrix& lower, int, int) {
    return std::make_unique<EigenBackend>(lower);
}

}  // namespace detail
}  // namespace beltrami
