#include <beltrami/linear/symmetric_solver.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

#include <beltrami/base/effort.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/backend.h>

namespace beltrami::detail {

namespace {

// Below this ratio of pivots a factor says nothing about its matrix. Cotangent Laplacians of valid meshes, slivers
// included, stay far above it; a component without any fixed vertex falls to the rounding level.
constexpr double kSingularPivotRatio = 1e-15;
constexpr double kRefineAbove = 1e-13;
constexpr double kAcceptBelow = 1e-6;
constexpr int kRowsNamed = 10;

double infinity_norm(const SymmetricSolver::Matrix& lower) {
    Eigen::VectorXd row_sums = Eigen::VectorXd::Zero(lower.rows());
    for (int column = 0; column < lower.outerSize(); ++column)
        for (SymmetricSolver::Matrix::InnerIterator it(lower, column); it; ++it) {
            row_sums[it.row()] += std::abs(it.value());
            if (it.row() != column) row_sums[column] += std::abs(it.value());
        }
    return row_sums.size() ? row_sums.maxCoeff() : 0.0;
}

using Vectors = Eigen::MatrixXd;

/// Sums of products of the columns of two matrices.
Eigen::RowVectorXd columnwise(const Vectors& x, const Vectors& y) {
    const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(x.cols());
    return parallel_sum<Eigen::RowVectorXd>(
        static_cast<int>(x.rows()), zero, [&](int first, int last) -> Eigen::RowVectorXd {
            return x.middleRows(first, last - first).cwiseProduct(y.middleRows(first, last - first)).colwise().sum();
        });
}

}  // namespace

/// The pattern of a whole symmetric matrix by rows, and where the lower triangle has the values: products then write
/// each row by itself.
class WholePattern {
  public:
    explicit WholePattern(const SymmetricSolver::Matrix& lower) {
        const auto n = static_cast<int>(lower.rows());
        const int *begin = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
        begins_.assign(static_cast<std::size_t>(n) + 1, 0);
        for (int c = 0; c < n; ++c)
            for (int e = begin[c]; e < begin[c + 1]; ++e) {
                ++begins_[row[e] + 1];
                if (row[e] != c) ++begins_[c + 1];
            }
        std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
        entries_.resize(static_cast<std::size_t>(begins_.back()));
        std::vector<int> place(begins_.begin(), begins_.end() - 1);
        for (int c = 0; c < n; ++c)
            for (int e = begin[c]; e < begin[c + 1]; ++e) {
                entries_[place[row[e]]++] = {c, e};
                if (row[e] != c) entries_[place[c]++] = {row[e], e};
            }
    }
    void multiply(const double* values, const Vectors& x, Vectors& result) const {
        result.resize(x.rows(), x.cols());
        for (Eigen::Index j = 0; j < x.cols(); j += 2)
            j + 1 < x.cols() ? columns<2>(values, x, j, result) : columns<1>(values, x, j, result);
    }

  private:
    struct Entry {
        int column, slot;
    };
    template <int C>
    void columns(const double* values, const Vectors& x, Eigen::Index first_column, Vectors& result) const {
        const Eigen::Index n = x.rows();
        const double* const from = x.data() + first_column * n;
        double* const to = result.data() + first_column * n;
        parallel_for(0, static_cast<int>(n), [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                double sum[C] = {};
                for (int e = begins_[i]; e < begins_[i + 1]; ++e) {
                    const double value = values[entries_[e].slot];
                    for (int c = 0; c < C; ++c) sum[c] += value * from[c * n + entries_[e].column];
                }
                for (int c = 0; c < C; ++c) to[c * n + i] = sum[c];
            }
        });
    }

    std::vector<int> begins_;
    std::vector<Entry> entries_;
};

struct SymmetricSolver::Backend {
    Matrix lower;
    int expected_factorizations;
    std::unique_ptr<CholeskyBackend> cholesky;
    int factorizations = 0;
    bool factorized = false;  ///< the factor belongs to the present values
    bool has_factor = false;  ///< … or to earlier ones
    double norm = 0;
    mutable double residual = 0;
    mutable std::optional<WholePattern> whole;  ///< once conjugate gradients have been asked for

    void multiply(const Eigen::MatrixXd& x, Eigen::MatrixXd& result) const {
        if (!whole) whole.emplace(lower);
        whole->multiply(lower.valuePtr(), x, result);
    }

    /// Rows that carry the null vector: a few steps of inverse iteration on the slightly shifted matrix.
    std::vector<int> unconstrained_rows() const {
        Matrix shifted = lower;
        const double scale = lower.diagonal().cwiseAbs().maxCoeff();
        for (int column = 0; column < shifted.outerSize(); ++column) shifted.coeffRef(column, column) += 1e-10 * scale;
        auto inverse = make_backend(shifted, 1, 1);
        if (!(scale > 0) || !inverse->factorize(shifted)) return {};
        Eigen::MatrixXd vector(lower.rows(), 1), next;
        for (Eigen::Index i = 0; i < vector.rows(); ++i)
            vector(i) = 1.0 + 0.5 * std::sin(static_cast<double>(i + 1));  // any vector that is not special
        for (int step = 0; step < 3; ++step) {
            inverse->solve(vector, next);
            vector = next / next.cwiseAbs().maxCoeff();
        }
        std::vector<int> rows(static_cast<std::size_t>(vector.rows()));
        std::iota(rows.begin(), rows.end(), 0);
        std::erase_if(rows, [&](int row) { return std::abs(vector(row)) < 0.5; });
        std::stable_sort(rows.begin(), rows.end(),
                         [&](int a, int b) { return std::abs(vector(a)) > std::abs(vector(b)); });
        return rows;
    }

    [[noreturn]] void report_singular() const {
        std::vector<int> rows = unconstrained_rows();
        std::string named;
        for (std::size_t i = 0; i < std::min<std::size_t>(rows.size(), kRowsNamed); ++i)
            named += (i ? ", " : "") + std::to_string(rows[i]);
        if (rows.size() > kRowsNamed) named += " and " + std::to_string(rows.size() - kRowsNamed) + " more";
        throw Error(Cause::not_solved,
                    "a linear system is singular or not positive definite" +
                        (named.empty() ? std::string() : "; unconstrained unknowns: " + named),
                    "fix at least one vertex of every component and look for degenerate faces",
                    {Things::unknowns, std::move(rows)});
    }
};

SymmetricSolver::SymmetricSolver(Matrix lower, int expected_factorizations, int block)
    : backend_(std::make_unique<Backend>()) {
    lower.makeCompressed();
    backend_->lower.swap(lower);  // Eigen's sparse matrices are not moved by assignment
    backend_->expected_factorizations = expected_factorizations;
    if (backend_->lower.rows() > 0) backend_->cholesky = make_backend(backend_->lower, expected_factorizations, block);
}

SymmetricSolver::~SymmetricSolver() = default;
SymmetricSolver::SymmetricSolver(SymmetricSolver&&) noexcept = default;
SymmetricSolver& SymmetricSolver::operator=(SymmetricSolver&&) noexcept = default;

SymmetricSolver::Matrix& SymmetricSolver::matrix() {
    backend_->factorized = false;
    return backend_->lower;
}
const SymmetricSolver::Matrix& SymmetricSolver::matrix() const {
    return backend_->lower;
}
double SymmetricSolver::last_residual() const {
    return backend_->residual;
}
int SymmetricSolver::factorization_count() const {
    return backend_->factorizations;
}

void SymmetricSolver::factorize() {
    count(Work::factorization);
    Backend& b = *backend_;
    if (b.cholesky) {
        ++b.factorizations;
        if (!b.lower.coeffs().allFinite())
            throw Error(Cause::not_solved, "a linear system has entries that are not finite",
                        "look for degenerate faces and coordinates that are not numbers");
        b.has_factor = false;
        b.norm = infinity_norm(b.lower);
        if (!b.cholesky->factorize(b.lower) || !(b.cholesky->pivot_ratio() > kSingularPivotRatio)) b.report_singular();
    }
    b.factorized = b.has_factor = true;
}

Eigen::MatrixXd SymmetricSolver::solve(const Eigen::MatrixXd& rhs) const {
    const Backend& b = *backend_;
    if (!b.factorized) throw std::logic_error("SymmetricSolver::solve before factorize");
    if (rhs.rows() != b.lower.rows()) throw std::logic_error("SymmetricSolver::solve: wrong number of rows");
    b.residual = 0;
    Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(rhs.rows(), rhs.cols());
    if (!b.cholesky || rhs.cols() == 0) return solution;

    b.cholesky->solve(rhs, solution);
    const auto residual_of = [&](const Eigen::MatrixXd& x, Eigen::MatrixXd& r) {
        r = rhs;
        r.noalias() -= b.lower.selfadjointView<Eigen::Lower>() * x;
        const double scale = b.norm * x.cwiseAbs().maxCoeff() + rhs.cwiseAbs().maxCoeff();
        return scale > 0 ? r.cwiseAbs().maxCoeff() / scale : 0.0;
    };
    Eigen::MatrixXd remainder;
    b.residual = residual_of(solution, remainder);
    if (b.residual > kRefineAbove) {
        Eigen::MatrixXd correction;
        b.cholesky->solve(remainder, correction);
        correction += solution;
        const double refined = residual_of(correction, remainder);
        if (refined < b.residual) {
            solution.swap(correction);
            b.residual = refined;
        }
    }
    if (!(b.residual <= kAcceptBelow))
        throw Error(Cause::not_solved,
                    "a linear system was solved only to a relative residual of " + std::to_string(b.residual),
                    "look for degenerate faces");
    return solution;
}

bool SymmetricSolver::solve_near(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution, double tolerance,
                                 int max_steps) const {
    const Backend& b = *backend_;
    if (!b.cholesky) {
        solution.resize(rhs.rows(), rhs.cols());
        return true;
    }
    if (!b.has_factor) return false;
    Eigen::MatrixXd residual;
    b.multiply(solution, residual);
    // ‖x‖²_A of the guess measures the solution; every column on its own.
    const Eigen::RowVectorXd reference = columnwise(solution, residual).cwiseMax(0.0);
    residual = rhs - residual;
    Eigen::MatrixXd z, direction, image;
    b.cholesky->solve_roughly(residual, z);
    Eigen::RowVectorXd rz = columnwise(residual, z);
    const Eigen::RowVectorXd target = tolerance * tolerance * reference;
    const auto excess = [&] {  // how far the worst column is from its target
        double worst = 0;
        for (Eigen::Index j = 0; j < rz.size(); ++j)
            if (rz[j] > target[j])
                worst = std::max(worst, target[j] > 0 ? rz[j] / target[j] : std::numeric_limits<double>::infinity());
        return worst;
    };
    const auto by_rows = [&](const std::function<void(int, int)>& body) {
        parallel_for(0, static_cast<int>(rhs.rows()), body);
    };
    const double at_start = excess();
    direction = z;
    for (int step = 1; excess() > 1; ++step) {
        if (step > max_steps || !std::isfinite(excess())) return false;
        b.multiply(direction, image);
        const Eigen::RowVectorXd curvature = columnwise(direction, image);
        by_rows([&](int first, int last) {
            for (Eigen::Index j = 0; j < rz.size(); ++j) {
                if (!(rz[j] > target[j])) continue;
                const double length = rz[j] / curvature[j];
                solution.col(j).segment(first, last - first) += length * direction.col(j).segment(first, last - first);
                residual.col(j).segment(first, last - first) -= length * image.col(j).segment(first, last - first);
            }
        });
        b.cholesky->solve_roughly(residual, z);
        const Eigen::RowVectorXd next = columnwise(residual, z);
        by_rows([&](int first, int last) {
            for (Eigen::Index j = 0; j < rz.size(); ++j)
                if (rz[j] > target[j])
                    direction.col(j).segment(first, last - first) =
                        z.col(j).segment(first, last - first) +
                        (next[j] / rz[j]) * direction.col(j).segment(first, last - first);
        });
        rz = next.cwiseMax(0.0);
        // At the rate so far, would the steps suffice?
        if (const double left = excess(); left > 1 && step >= 2 && std::isfinite(left)) {
            const double per_step = std::log(at_start / left) / step;
            if (!(per_step > 0) || std::log(left) / per_step > max_steps - step + 0.5) return false;
        }
    }
    return solution.allFinite();
}

}  // namespace beltrami::detail
