#include <beltrami/certificate/period_pair.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Cholesky>

#include <beltrami/certificate/pair_iteration.h>
#include <beltrami/mesh/strip.h>
#include <beltrami/solve/laplacian.h>

namespace beltrami {

namespace {

using detail::Laplacian;

/// Holes up to which the functions that change sign around some of them are tried, 2ⁿ − 1 of them.
constexpr std::size_t kMostSigned = 3;

/// Functions that grow by 1 around one hole each, at the corners of faces (#corners).
using Jumps = std::vector<std::vector<double>>;

Jumps jumps_of(const Surface& source) {
    Jumps jumps;
    for (int l = 1; l < static_cast<int>(source.topology.boundary_loops.size()); ++l)
        jumps.push_back(jumps_across_strip(source.mesh, source.topology, l, 0));
    return jumps;
}

std::vector<char> first_held(const Operators& operators) {
    std::vector<char> held(static_cast<std::size_t>(operators.vertex_count), 0);
    held[operators.vertices.front()] = 1;
    return held;
}

/// Functions u of the vertices plus c_h times a harmonic one of period 1 around hole h and none around the others: the
/// coordinates are u, then c. No u of the vertices has a part along the harmonic ones in the energy.
class PeriodEnergy final : public PairEnergy {
  public:
    /// @pre triangles, whose corners are those of operators.vertices
    PeriodEnergy(const Operators& operators, Jumps jumps)
        : operators_(operators), form_(operators, first_held(operators)), harmonic_(std::move(jumps)) {
        for (std::vector<double>& one : harmonic_) {
            Eigen::VectorXd force = Eigen::VectorXd::Zero(operators.vertex_count);
            for (int s = 0; s < operators.sample_count(); ++s) {
                const Complex along = operators.weights[s] * gradient(s, one);
                for (int j = operators.offsets[s]; j < operators.offsets[s + 1]; ++j)
                    force[operators.vertices[j]] -= std::real(std::conj(operators.gradients[j]) * along);
            }
            const Eigen::VectorXd u = form_.solve(force);
            for (std::size_t j = 0; j < one.size(); ++j) one[j] += u[operators.vertices[j]];
        }
        const auto holes = static_cast<Eigen::Index>(harmonic_.size());
        gram_.setZero(holes, holes);
        for (int s = 0; s < operators.sample_count(); ++s)
            for (Eigen::Index h = 0; h < holes; ++h)
                for (Eigen::Index g = 0; g < holes; ++g)
                    gram_(h, g) += operators.weights[s] *
                                   std::real(std::conj(gradient(s, harmonic_[h])) * gradient(s, harmonic_[g]));
        inverse_ = gram_.llt().solve(Eigen::MatrixXd::Identity(holes, holes));
    }

    /// The values at the corners of faces.
    std::vector<double> at_corners(const Eigen::VectorXd& x) const {
        std::vector<double> values(operators_.vertices.size());
        for (std::size_t j = 0; j < values.size(); ++j) {
            values[j] = x[operators_.vertices[j]];
            for (std::size_t h = 0; h < harmonic_.size(); ++h)
                values[j] += x[operators_.vertex_count + static_cast<Eigen::Index>(h)] * harmonic_[h][j];
        }
        return values;
    }
    /// The transpose: from numbers at corners to coordinates.
    Eigen::VectorXd collected(const std::vector<double>& at_corners) const {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
        for (std::size_t j = 0; j < at_corners.size(); ++j) {
            x[operators_.vertices[j]] += at_corners[j];
            for (std::size_t h = 0; h < harmonic_.size(); ++h)
                x[operators_.vertex_count + static_cast<Eigen::Index>(h)] += harmonic_[h][j] * at_corners[j];
        }
        return x;
    }
    Eigen::Index size() const { return operators_.vertex_count + gram_.rows(); }

    Eigen::VectorXd solve(const Eigen::VectorXd& force) const override {
        Eigen::VectorXd x(size());
        x << form_.solve(force.head(operators_.vertex_count)), inverse_ * force.tail(gram_.rows());
        return x;
    }
    Eigen::VectorXd apply(const Eigen::VectorXd& x) const override {
        Eigen::VectorXd result(size());
        result << form_.apply(x.head(operators_.vertex_count)), gram_ * x.tail(gram_.rows());
        return result;
    }
    double energy(const Eigen::VectorXd& x) const override {
        const std::vector<double> values = at_corners(x);
        double sum = 0;
        for (int s = 0; s < operators_.sample_count(); ++s)
            sum += operators_.weights[s] * std::norm(gradient(s, values));
        return sum;
    }
    int factorization_count() const override { return form_.factorization_count(); }

  private:
    Complex gradient(int sample, const std::vector<double>& at_corners) const {
        const int first = operators_.offsets[sample], last = operators_.offsets[sample + 1];
        Complex sum = 0;
        for (int j = first + 1; j < last; ++j) sum += (at_corners[j] - at_corners[first]) * operators_.gradients[j];
        return sum;
    }

    const Operators& operators_;
    Laplacian form_;
    std::vector<std::vector<double>> harmonic_;  // per hole, #corners
    Eigen::MatrixXd gram_, inverse_;             // of the harmonic ones
};

/// ∫ du ∧ dv = ½ Σ ((u1 − u0)(v2 − v0) − (u2 − u0)(v1 − v0)), face by face.
class FacePairing final : public Pairing {
  public:
    FacePairing(const Surface& source, const PeriodEnergy& of_source, const PeriodEnergy& of_image)
        : source_(source), of_source_(of_source), of_image_(of_image) {}

    Eigen::VectorXd with_v(const Eigen::VectorXd& v) const override {
        return of_image_.collected(turned(of_source_.at_corners(v), 0.5));
    }
    Eigen::VectorXd with_u(const Eigen::VectorXd& u) const override {
        return of_source_.collected(turned(of_image_.at_corners(u), -0.5));
    }
    Eigen::VectorXd start() const override {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(of_image_.size());
        double turn = 0;
        for (const auto& loop : source_.topology.boundary_loops)
            for (const int v : loop) u[v] = std::sin(turn += 2.399963);
        for (Eigen::Index h = source_.operators.vertex_count; h < u.size(); ++h) u[h] = std::cos(turn += 2.399963);
        return u;
    }

  private:
    /// Of every corner the difference of the other two, one after minus one before.
    static std::vector<double> turned(const std::vector<double>& values, double factor) {
        std::vector<double> result(values.size());
        for (std::size_t c = 0; c < values.size(); c += 3)
            for (std::size_t i = 0; i < 3; ++i)
                result[c + i] = factor * (values[c + (i + 1) % 3] - values[c + (i + 2) % 3]);
        return result;
    }

    const Surface& source_;
    const PeriodEnergy &of_source_, &of_image_;
};

/// Signs of functions that change theirs around the holes of a set (bits).
std::vector<signed char> signs_around(const Jumps& jumps, std::uint32_t holes) {
    std::vector<signed char> signs(jumps[0].size(), 1);
    for (std::size_t h = 0; h < jumps.size(); ++h)
        for (std::size_t c = 0; c < signs.size() && (holes >> h & 1U) != 0; ++c)
            if (jumps[h][c] != 0) signs[c] = static_cast<signed char>(-signs[c]);
    return signs;
}

}  // namespace

PairBound period_pair_bound(const Surface& source, const BoundaryImage& image, const PairBoundOptions& options) {
    const Jumps jumps = jumps_of(source);
    const PeriodEnergy of_source(source.operators, jumps), of_image(image.operators, jumps);
    PairBound best = best_pair(of_source, of_image, FacePairing(source, of_source, of_image), options);
    for (std::uint32_t holes = 1; jumps.size() <= kMostSigned && holes < (1U << jumps.size()); ++holes) {
        PairBound other = pair_bound_up_to_sign(source, image, signs_around(jumps, holes), options);
        other.factorizations += best.factorizations;
        if (other.K > best.K)
            best = std::move(other);
        else
            best.factorizations = other.factorizations;
    }
    return best;
}

}  // namespace beltrami
