#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <complex>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/linear/backend.h>
#include <beltrami/linear/dense.h>
#include <beltrami/linear/linear_backend.h>
#include <beltrami/linear/multifrontal.h>
#include <beltrami/linear/supernodal_factor.h>
#include <beltrami/linear/vector_gram.h>

// NOLINTBEGIN(readability-identifier-naming): the names of BLAS
extern "C" void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
                       const double* a, const int* lda, const double* beta, double* c, const int* ldc);
extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
extern "C" void dtrsm_(const char* side, const char* uplo, const char* transa, const char* diag, const int* m,
                       const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
extern "C" void zherk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
                       const std::complex<double>* a, const int* lda, const double* beta, std::complex<double>* c,
                       const int* ldc);
extern "C" void zgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
                       const std::complex<double>* alpha, const std::complex<double>* a, const int* lda,
                       const std::complex<double>* b, const int* ldb, const std::complex<double>* beta,
                       std::complex<double>* c, const int* ldc);
// NOLINTEND(readability-identifier-naming)

namespace beltrami {

namespace detail {
void use_one_blas_thread();
}

namespace {

/// Held while BLAS works: a serial OpenBLAS built without locks, Debian's for one, hands the same packing buffers to
/// every thread that calls it, and two calls at once spoil each other's products now and then.
class BlasLock {
  public:
    explicit BlasLock(bool needed = true) : lock_(mutex(), std::defer_lock) {
        if (needed) lock_.lock();
    }

  private:
    static std::mutex& mutex() {
        static std::mutex only;
        return only;
    }
    std::unique_lock<std::mutex> lock_;
};

}  // namespace

Eigen::MatrixXd gram_lower(const Eigen::Ref<const Eigen::MatrixXd>& A) {
    if (detail::has_vector_gram()) return detail::vector_gram(A);
    const int n = static_cast<int>(A.cols()), k = static_cast<int>(A.rows()),
              stride = static_cast<int>(A.outerStride());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    if (n == 0 || k == 0) return result;
    detail::use_one_blas_thread();
    const BlasLock lock;
    const double one = 1, zero = 0;
    dsyrk_("L", "T", &n, &k, &one, A.data(), &stride, &zero, result.data(), &n);
    return result;
}

Eigen::MatrixXcd complex_product(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B) {
    const int m = static_cast<int>(A.rows()), n = static_cast<int>(B.cols()), k = static_cast<int>(A.cols());
    Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(m, n);
    if (m == 0 || n == 0 || k == 0) return result;
    detail::use_one_blas_thread();
    const BlasLock lock;
    const std::complex<double> one = 1, zero = 0;
    zgemm_("N", "N", &m, &n, &k, &one, A.data(), &m, B.data(), &k, &zero, result.data(), &m);
    return result;
}

Eigen::MatrixXcd complex_gram_upper(const Eigen::MatrixXcd& A) {
    const int n = static_cast<int>(A.cols()), k = static_cast<int>(A.rows());
    Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(n, n);
    if (n == 0 || k == 0) return result;
    detail::use_one_blas_thread();
    const BlasLock lock;
    const double one = 1, zero = 0;
    zherk_("U", "C", &n, &k, &one, A.data(), &k, &zero, result.data(), &n);
    return result;
}

const char* linear_backend() {
    static const std::string name = "CHOLMOD " + std::to_string(CHOLMOD_MAIN_VERSION) + "." +
                                    std::to_string(CHOLMOD_SUB_VERSION) + "." + std::to_string(CHOLMOD_SUBSUB_VERSION);
    return name.c_str();
}

namespace detail {
namespace {

/// A function of a library that may or may not be loaded.
template <class Function>
Function* loaded_function(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

/// One BLAS thread keeps results the same on any number of threads.
void use_one_blas_thread() {
    static std::once_flag once;
    std::call_once(once, [] {
        if (auto* set = loaded_function<void(int)>("openblas_set_num_threads")) set(1);
    });
}

namespace {

/// Keeps CHOLMOD's own OpenMP loops serial while it lives: they open a team of four threads for every supernode, which
/// costs more than it gives (measured: half the time of a factorisation without them; docs/performance.md).
class SerialOpenMp {
  public:
    SerialOpenMp() {
        if (!kLevels || !kSetLevels) return;
        const std::scoped_lock lock(mutex_);
        if (inside_++ > 0) return;
        saved_ = kLevels();
        kSetLevels(0);
    }
    ~SerialOpenMp() {
        if (!kLevels || !kSetLevels) return;
        const std::scoped_lock lock(mutex_);
        if (--inside_ == 0) kSetLevels(saved_);
    }
    SerialOpenMp(const SerialOpenMp&) = delete;
    SerialOpenMp& operator=(const SerialOpenMp&) = delete;

  private:
    inline static const auto kLevels = loaded_function<int()>("omp_get_max_active_levels");
    inline static const auto kSetLevels = loaded_function<void(int)>("omp_set_max_active_levels");
    // The number of levels is that of the program: the last thread to leave restores what the first has found.
    inline static std::mutex mutex_;
    inline static int inside_ = 0, saved_ = 0;
};

/// Supernodes are merged where they have so many columns and their union so small a part of zeros, more freely than
/// CHOLMOD does by itself (4, 16, 48 columns and .8, .1, .05): of planar meshes its supernodes are so small that
/// calls of BLAS and of OpenMP take longer than the arithmetic (docs/performance.md).
constexpr std::array<std::size_t, 3> kMergedColumns{8, 24, 64};
constexpr std::array<double, 3> kMergedZeros{0.8, 0.2, 0.08};

// METIS orders better than AMD but its own time is only repaid over several factorisations (docs/performance.md).
constexpr int kMetisPaysFrom = 16;

/// See MultifrontalCholesky. @pre BLAS is locked
bool dense_part(int rows, int columns, double* panel, double* update) {
    const double one = 1, minus_one = -1;
    int info = 0;
    dpotrf_("L", &columns, panel, &rows, &info);
    if (info != 0) return false;
    const int rest = rows - columns;
    if (rest == 0) return true;
    dtrsm_("R", "L", "T", "N", &rest, &columns, &one, panel, &rows, panel + columns, &rows);
    dsyrk_("L", "N", &rest, &columns, &minus_one, panel + columns, &rows, &one, update, &rest);
    return true;
}

class CholmodBackend final : public CholeskyBackend {
  public:
    CholmodBackend(const Matrix& lower, int expected_factorizations, int block) {
        use_one_blas_thread();
        cholmod_start(&common_);
        common_.print = 0;
        common_.nmethods = 1;
        common_.postorder = 1;
        std::copy(kMergedColumns.begin(), kMergedColumns.end(), common_.nrelax);
        std::copy(kMergedZeros.begin(), kMergedZeros.end(), common_.zrelax);
        common_.final_ll = 1;
        cholmod_sparse view = view_of(lower);
        if (block == 1) {
            common_.method[0].ordering = expected_factorizations >= kMetisPaysFrom ? CHOLMOD_METIS : CHOLMOD_AMD;
            factor_ = cholmod_analyze(&view, &common_);
        } else {
            std::vector<int> order = order_of_blocks(lower, block, expected_factorizations >= kMetisPaysFrom);
            common_.method[0].ordering = CHOLMOD_GIVEN;
            factor_ = cholmod_analyze_p(&view, order.data(), nullptr, 0, &common_);
        }
        if (!factor_) fail("the symbolic analysis of a sparse system failed");
        by_fronts_ = block > 1;
    }

    ~CholmodBackend() override {
        cholmod_free_dense(&solution_, &common_);
        cholmod_free_dense(&workspace_y_, &common_);
        cholmod_free_dense(&workspace_e_, &common_);
        cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }
    CholmodBackend(const CholmodBackend&) = delete;
    CholmodBackend& operator=(const CholmodBackend&) = delete;

    bool factorize(const Matrix& lower) override {
        const SerialOpenMp serial;
        const BlasLock lock(factor_->is_super);
        rough_ = Rough::not_made;
        if (by_fronts_ && factor_->is_super) return factorize_fronts(lower);
        by_fronts_ = true;
        cholmod_sparse view = view_of(lower);
        const int done = cholmod_factorize(&view, factor_, &common_);
        if (!done || common_.status < CHOLMOD_OK) fail("the factorisation of a sparse system failed");
        return common_.status != CHOLMOD_NOT_POSDEF && factor_->minor == factor_->n;
    }

    double pivot_ratio() const override { return cholmod_rcond(factor_, const_cast<cholmod_common*>(&common_)); }

    void solve(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) override {
        const SerialOpenMp serial;
        const BlasLock lock(factor_->is_super);
        cholmod_dense b{};
        b.nrow = b.d = static_cast<std::size_t>(rhs.rows());
        b.ncol = static_cast<std::size_t>(rhs.cols());
        b.nzmax = b.nrow * b.ncol;
        b.x = const_cast<double*>(rhs.data());
        b.xtype = CHOLMOD_REAL;
        b.dtype = CHOLMOD_DOUBLE;
        if (!cholmod_solve2(CHOLMOD_A, factor_, &b, nullptr, &solution_, nullptr, &workspace_y_, &workspace_e_,
                            &common_))
            fail("the solution of a factorised sparse system failed");
        solution = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution_->x), rhs.rows(), rhs.cols());
    }

    void solve_roughly(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) override {
        if (rough_ == Rough::not_made) {
            rough_ = Rough::impossible;
            if (factor_->is_super && factor_->is_ll) {
                const SupernodalView view = supernodal_view();
                if (!rough_factor_) rough_factor_ = std::make_unique<SupernodalFactor>(view);
                if (rough_factor_->load(view)) rough_ = Rough::ready;
            }
        }
        if (rough_ == Rough::ready)
            rough_factor_->solve(rhs, solution);
        else
            solve(rhs, solution);
    }

  private:
    /// Values of the factor that CHOLMOD has analysed; it solves with them as with its own.
    bool factorize_fronts(const Matrix& lower) {
        if (!multifrontal_) multifrontal_.emplace(supernodal_view(), lower.outerIndexPtr(), lower.innerIndexPtr());
        if (factor_->xtype == CHOLMOD_PATTERN && !cholmod_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, factor_, &common_))
            fail("the factorisation of a sparse system failed");
        const bool definite = multifrontal_->factorize(lower.valuePtr(), static_cast<double*>(factor_->x), dense_part);
        factor_->minor = definite ? factor_->n : 0;
        return definite;
    }

    SupernodalView supernodal_view() const {
        return {static_cast<int>(factor_->n),
                static_cast<int>(factor_->nsuper),
                static_cast<const int*>(factor_->super),
                static_cast<const int*>(factor_->pi),
                static_cast<const int*>(factor_->px),
                static_cast<const int*>(factor_->s),
                static_cast<const double*>(factor_->x),
                static_cast<const int*>(factor_->Perm)};
    }

    /// An ordering that keeps blocks of unknowns together: that of the graph of the blocks.
    std::vector<int> order_of_blocks(const Matrix& lower, int block, bool by_metis) {
        const int count = static_cast<int>(lower.rows()) / block;
        std::vector<int> begins{0}, rows;
        rows.reserve(static_cast<std::size_t>(lower.nonZeros() / (block * block)) + static_cast<std::size_t>(count));
        for (int c = 0; c < count; ++c) {
            for (Matrix::InnerIterator entry(lower, c * block); entry; ++entry) {
                const int row = static_cast<int>(entry.row()) / block;
                if (static_cast<int>(rows.size()) == begins.back() || rows.back() != row) rows.push_back(row);
            }
            begins.push_back(static_cast<int>(rows.size()));
        }
        cholmod_sparse graph = lower_view(count, begins.data(), rows.data(), nullptr);
        std::vector<int> blocks(static_cast<std::size_t>(count)), order;
        if (!(by_metis ? cholmod_metis(&graph, nullptr, 0, 1, blocks.data(), &common_)
                       : cholmod_amd(&graph, nullptr, 0, blocks.data(), &common_)))
            fail("the ordering of a sparse system failed");
        order.reserve(static_cast<std::size_t>(lower.rows()));
        for (const int b : blocks)
            for (int i = 0; i < block; ++i) order.push_back(b * block + i);
        return order;
    }

    static cholmod_sparse view_of(const Matrix& lower) {
        return lower_view(static_cast<int>(lower.rows()), lower.outerIndexPtr(), lower.innerIndexPtr(),
                          lower.valuePtr());
    }

    /// A compressed lower triangle as CHOLMOD sees it; a pattern where there are no values.
    static cholmod_sparse lower_view(int size, const int* begins, const int* rows, const double* values) {
        cholmod_sparse view{};
        view.nrow = view.ncol = static_cast<std::size_t>(size);
        view.nzmax = static_cast<std::size_t>(begins[size]);
        view.p = const_cast<int*>(begins);
        view.i = const_cast<int*>(rows);
        view.x = const_cast<double*>(values);
        view.stype = -1;
        view.itype = CHOLMOD_INT;
        view.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
        view.dtype = CHOLMOD_DOUBLE;
        view.sorted = 1;
        view.packed = 1;
        return view;
    }

    [[noreturn]] void fail(const char* sentence) const {
        if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
        if (common_.status == CHOLMOD_TOO_LARGE)
            throw Error(Cause::not_solved, std::string(sentence) + ": it is too large for 32-bit indices",
                        "use a coarser mesh");
        throw Error(Cause::not_solved,
                    std::string(sentence) + " (CHOLMOD status " + std::to_string(common_.status) + ")");
    }

    cholmod_common common_{};
    cholmod_factor* factor_ = nullptr;
    cholmod_dense* solution_ = nullptr;
    cholmod_dense* workspace_y_ = nullptr;
    cholmod_dense* workspace_e_ = nullptr;
    enum class Rough { not_made, ready, impossible };
    Rough rough_ = Rough::not_made;  ///< state of the copy of the present factor
    std::unique_ptr<SupernodalFactor> rough_factor_;
    /// With two unknowns a node, and with one from the second factorisation on, whose preparation costs as much as a
    /// factorisation saves.
    bool by_fronts_ = false;
    std::optional<MultifrontalCholesky> multifrontal_;
};

}  // namespace

std::unique_ptr<CholeskyBackend> make_backend(const CholeskyBackend::Matrix& lower, int expected_factorizations,
                                              int block) {
    return std::make_unique<CholmodBackend>(lower, expected_factorizations, block);
}

}  // namespace detail
}  // namespace beltrami
