#include <beltrami/differentials/rational_space.h>

#include <algorithm>
#include <cmath>

#include <beltrami/linear/dense.h>
#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

constexpr int kFirstDegree = 8, kFirstPower = 4;
/// A function of which less than this part is new is left out.
constexpr double kDependent = 1e-5;
/// Points worked through at a time.
constexpr int kPointsPerChunk = 512;

}  // namespace

std::unique_ptr<DifferentialSpace> RationalSpace::starting_space(const Singularities& singularities,
                                                                 Quadrature quadrature, int largest_degree) {
    int largest_power = 0;
    for (const auto& hole : singularities.holes) largest_power = std::max(largest_power, hole.largest_power);
    auto space = std::unique_ptr<RationalSpace>(new RationalSpace(
        std::make_shared<const Family>(Family{singularities, std::move(quadrature), largest_degree, largest_power})));
    space->raise(std::min(kFirstDegree, largest_degree), std::min(kFirstPower, largest_power));
    std::vector<Generator> poles;
    for (const Complex pin : singularities.pins) poles.push_back({pin, 1.0, 1});
    space->add(std::move(poles));
    return space;
}

void RationalSpace::add_corner_poles() {
    std::vector<Generator> poles;
    for (const auto& corner : family_->singularities.corners)
        for (int j = 0; j < corner_poles; ++j) {
            const double distance =
                corner.reach * std::exp(-4 * (std::sqrt(corner_poles) - std::sqrt(corner_poles - j)));
            if (distance < corner.finest && j > 0) break;
            poles.push_back({corner.vertex + distance * corner.outward, distance, 1});
        }
    add(std::move(poles));
    with_corners_ = true;
}

void RationalSpace::raise(int degree, int power) {
    std::vector<Generator> more;
    for (int j = degree_ + 1; j <= degree; ++j) more.push_back({0.0, 1.0, -j});
    for (const auto& hole : family_->singularities.holes)
        for (int j = power_ + 1; j <= std::min(power, hole.largest_power); ++j)
            more.push_back({hole.centre, hole.radius, j});
    degree_ = std::max(degree_, degree);
    power_ = std::max(power_, power);
    add(std::move(more));
}

void RationalSpace::add(std::vector<Generator> more) {
    if (more.empty()) return;
    const auto old_generators = static_cast<Eigen::Index>(generators_.size()), old_size = transform_.cols();
    generators_.insert(generators_.end(), more.begin(), more.end());
    const auto generators_count = static_cast<Eigen::Index>(generators_.size()),
               added = static_cast<Eigen::Index>(more.size());
    const Quadrature& quadrature = family_->quadrature;
    Eigen::MatrixXcd values = generators({quadrature.points, Eigen::VectorXcd::Ones(quadrature.points.size())});
    values = quadrature.weights.cwiseSqrt().cast<Complex>().asDiagonal() * values;

    // Coefficients of the new functions, made orthonormal twice (Cholesky QR loses half of the digits each time); a
    // pivot that vanishes marks a function that depends on those before it.
    Eigen::MatrixXcd transform = Eigen::MatrixXcd::Zero(generators_count, old_size + added);
    if (old_size) transform.topLeftCorner(old_generators, old_size) = transform_;
    for (Eigen::Index j = 0; j < added; ++j) {
        const double length = values.col(old_generators + j).norm();
        transform(old_generators + j, old_size + j) = length > 0 ? 1 / length : 0.0;
    }
    Eigen::Index size = old_size + added;
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::MatrixXcd gram = complex_gram_upper(complex_product(values, transform.leftCols(size)));
        // Columns of the inverse factor, one after another: r = gram(0..j, j) against those kept so far.
        Eigen::MatrixXcd kept(generators_count, size);
        Eigen::MatrixXcd inverse = Eigen::MatrixXcd::Zero(size, size);  // kept functions in terms of the given ones
        Eigen::Index count = 0;
        for (Eigen::Index j = 0; j < size; ++j) {
            if (j < old_size) {
                inverse(j, count++) = 1;
                continue;
            }
            const Eigen::VectorXcd along = inverse.topLeftCorner(j, count).adjoint() * gram.col(j).head(j);
            const double square = gram(j, j).real() - along.squaredNorm();
            if (!(square > kDependent * kDependent * gram(j, j).real())) continue;
            inverse.col(count) = -(inverse.leftCols(count) * along);
            inverse(j, count) += 1;
            inverse.col(count++) /= std::sqrt(square);
        }
        kept.leftCols(count) = transform.leftCols(size) * inverse.leftCols(count);
        transform.leftCols(count) = kept.leftCols(count);
        size = count;
    }
    transform_ = transform.leftCols(size);
}

Eigen::MatrixXcd RationalSpace::generators(const ChartPoints& points) const {
    Eigen::MatrixXcd values(points.positions.size(), static_cast<Eigen::Index>(generators_.size()));
    parallel_for(
        0, static_cast<int>(points.positions.size()),
        [&](int begin, int end) {
            const int count = end - begin;
            const Eigen::ArrayXcd square = points.derivatives.segment(begin, count).array().square();
            const Eigen::ArrayXcd z = points.positions.segment(begin, count).array();
            Eigen::ArrayXcd base(count), power(count);
            for (std::size_t g = 0; g < generators_.size(); ++g) {
                const Generator& f = generators_[g];
                // Powers of one base follow each other, so each is one product.
                if (!follows(g)) {
                    if (f.power > 0)
                        base = f.scale * (z - f.centre).conjugate() / (z - f.centre).abs2();
                    else
                        base = (z - f.centre) / f.scale;
                    power = square;
                    for (int i = 0; i < std::abs(f.power); ++i) power *= base;
                } else {
                    power *= base;
                }
                values.col(static_cast<Eigen::Index>(g)).segment(begin, count) = power.matrix();
            }
        },
        kPointsPerChunk);
    return values;
}

Eigen::VectorXcd RationalSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    const Eigen::VectorXcd c = of_generators(coefficients);
    Eigen::VectorXcd phi(points.positions.size());
    parallel_for(
        0, static_cast<int>(points.positions.size()),
        [&](int begin, int end) {
            using Array = Eigen::ArrayXd;
            const int count = end - begin;
            const Array x = points.positions.segment(begin, count).real(),
                        y = points.positions.segment(begin, count).imag();
            Array re = Array::Zero(count), im = Array::Zero(count);
            Array base_re(count), base_im(count), power_re(count), power_im(count), size(count), next(count);
            const auto times_base = [&] {
                next = power_re * base_re - power_im * base_im;
                power_im = power_re * base_im + power_im * base_re;
                power_re = next;
            };
            for (std::size_t g = 0; g < generators_.size(); ++g) {
                const Generator& f = generators_[g];
                if (!follows(g)) {
                    base_re = x - f.centre.real();
                    base_im = y - f.centre.imag();
                    if (f.power > 0) {
                        size = f.scale / (base_re.square() + base_im.square());
                        base_re *= size;
                        base_im *= -size;
                    } else {
                        base_re /= f.scale;
                        base_im /= f.scale;
                    }
                    power_re.setOnes();
                    power_im.setZero();
                    for (int i = 0; i < std::abs(f.power); ++i) times_base();
                } else {
                    times_base();
                }
                const Complex a = c[static_cast<Eigen::Index>(g)];
                re += a.real() * power_re - a.imag() * power_im;
                im += a.real() * power_im + a.imag() * power_re;
            }
            for (int i = 0; i < count; ++i) {
                const Complex derivative = points.derivatives[begin + i];
                phi[begin + i] = Complex(re[i], im[i]) * derivative * derivative;
            }
        },
        kPointsPerChunk);
    return phi;
}

/// Whether a generator is the next power of the base of the one before.
bool RationalSpace::follows(std::size_t g) const {
    return g > 0 && generators_[g - 1].centre == generators_[g].centre &&
           generators_[g - 1].scale == generators_[g].scale &&
           std::abs(generators_[g - 1].power) == std::abs(generators_[g].power) - 1;
}

std::unique_ptr<DifferentialSpace> RationalSpace::refined() const {
    const bool raises = degree_ < family_->largest_degree || power_ < family_->largest_power;
    if (!raises && !preliminary()) return nullptr;
    auto larger = std::unique_ptr<RationalSpace>(new RationalSpace(*this));
    if (preliminary()) larger->add_corner_poles();
    larger->raise(std::min(degree_ + std::max(4, degree_ / 2), family_->largest_degree),
                  std::min(power_ + std::max(2, power_ / 2), family_->largest_power));
    return larger;
}

}  // namespace beltrami
