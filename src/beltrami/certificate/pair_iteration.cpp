#include <beltrami/certificate/pair_iteration.h>

#include <algorithm>
#include <cmath>

#include <beltrami/linear/decomposition.h>

namespace beltrami {

namespace {

/// Lanczos' iteration for the largest eigenvalue of L_S⁻¹ Wᵀ L_T⁻¹ W, in the energy product of L_S.
class Lanczos {
  public:
    Lanczos(const PairEnergy& source, const PairEnergy& image, const Pairing& pairing)
        : source_(source), image_(image), pairing_(pairing) {}

    /// The Ritz vector v after as many steps as needed.
    Eigen::VectorXd run(const PairBoundOptions& options) {
        start();
        while (static_cast<int>(basis_.size()) < options.most_steps && step())
            if (const std::size_t n = values_.size();
                n > 4 && values_[n - 1] <= (1 + options.tolerance) * values_[n - 4])
                break;
        return ritz();
    }
    int steps() const { return static_cast<int>(values_.size()); }

  private:
    /// v that pairs with the start. Two rounds of the power iteration smooth it.
    void start() {
        const Eigen::VectorXd v = source_.solve(pairing_.with_u(pairing_.start()));
        push(source_.solve(pairing_.with_u(image_.solve(pairing_.with_v(v)))));
    }
    void push(const Eigen::VectorXd& v) {
        Eigen::VectorXd applied = source_.apply(v);
        const double size = std::sqrt(std::max(0.0, v.dot(applied)));
        if (!(size > 0) || !std::isfinite(size)) return;
        basis_.push_back(v / size);
        applied_.push_back(applied / size);
    }
    /// @return false where the space is exhausted
    bool step() {
        const std::size_t n = values_.size();
        if (n >= basis_.size()) return false;
        Eigen::VectorXd next = source_.solve(pairing_.with_u(image_.solve(pairing_.with_v(basis_[n]))));
        double diagonal = 0;
        for (int pass = 0; pass < 2; ++pass)  // twice: orthogonal to rounding
            for (std::size_t i = basis_.size(); i-- > 0;) {
                const double part = next.dot(applied_[i]);
                if (i == n) diagonal += part;
                next -= part * basis_[i];
            }
        diagonal_.push_back(diagonal);
        Eigen::VectorXd applied = source_.apply(next);
        const double size = std::sqrt(std::max(0.0, next.dot(applied)));
        beside_.push_back(size);
        values_.push_back(eigen().values[static_cast<Eigen::Index>(n)]);
        if (!(size > 1e-12 * values_[0])) return false;
        basis_.push_back(next / size);
        applied_.push_back(applied / size);
        return true;
    }
    SymmetricEigen eigen() const {
        const auto n = static_cast<Eigen::Index>(diagonal_.size());
        Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            T(i, i) = diagonal_[i];
            if (i > 0) T(i, i - 1) = beside_[i - 1];
        }
        return symmetric_eigen(T);
    }
    Eigen::VectorXd ritz() const {
        if (diagonal_.empty()) return basis_.empty() ? pairing_.with_u(pairing_.start()) : basis_[0];
        Eigen::VectorXd v = Eigen::VectorXd::Zero(basis_[0].size());
        const SymmetricEigen all = eigen();
        const Eigen::Index n = all.values.size();
        for (Eigen::Index i = 0; i < n; ++i) v += all.vectors(i, n - 1) * basis_[i];
        return v;
    }

    const PairEnergy &source_, &image_;
    const Pairing& pairing_;
    std::vector<Eigen::VectorXd> basis_, applied_;
    std::vector<double> diagonal_, beside_, values_;
};

}  // namespace

PairBound best_pair(const PairEnergy& source, const PairEnergy& image, const Pairing& pairing,
                    const PairBoundOptions& options) {
    PairBound result;
    result.factorizations = source.factorization_count() + image.factorization_count();
    Lanczos lanczos(source, image, pairing);
    result.v = lanczos.run(options);
    result.steps = lanczos.steps();
    const Eigen::VectorXd paired = pairing.with_v(result.v);
    result.u = image.solve(paired);
    const double pairs = result.u.dot(paired), energies = image.energy(result.u) * source.energy(result.v);
    if (energies > 0 && std::isfinite(energies)) result.K = std::max(1.0, pairs * pairs / energies);
    return result;
}

}  // namespace beltrami
