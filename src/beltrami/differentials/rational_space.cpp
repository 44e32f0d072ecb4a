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
    Family family{singularities, std::move(quadrature), largest_degree, largest_power, {}};
    for (const auto& curve : singularities.curves) {
        family.curves.emplace_back(curve);
        family.levels = std::max(family.levels, family.curves.back().levels());
    }
    auto space = std::unique_ptr<RationalSpace>(new RationalSpace(std::make_shared<const Family>(std::move(family))));
    space->raise(std::min(kFirstDegree, largest_degree), std::min(kFirstPower, largest_power));
    std::vector<Generator> poles;
    for (const Complex pin : singularities.pins) poles.push_back({pin, 1.0, 1});
    for (const auto& held : singularities.held) poles.push_back({held.at, 1.0, 1, true, held.residue});
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

void RationalSpace::add_densities() {
    std::vector<Generator> more;
    for (std::size_t c = 0; c < family_->curves.size(); ++c) {
        const CurveDensities& curve = family_->curves[c];
        if (levels_ >= curve.levels()) continue;
        for (int j = levels_ > 0 ? curve.size_up_to(levels_ - 1) : 0; j < curve.size_up_to(levels_); ++j)
            more.push_back({0.0, -1.0, 0, curve.real(j), 1.0, static_cast<int>(c), j});
    }
    ++levels_;
    add(std::move(more));
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
    const bool real = !complex_coefficients();
    const auto generators_count = static_cast<Eigen::Index>(generators_.size());
    Eigen::Index added = 0;
    for (const Generator& generator : more) added += real && !generator.real ? 2 : 1;
    const Quadrature& quadrature = family_->quadrature;
    Eigen::MatrixXcd values = generators({quadrature.points, Eigen::VectorXcd::Ones(quadrature.points.size())});
    values = quadrature.weights.cwiseSqrt().cast<Complex>().asDiagonal() * values;

    // Coefficients of the new functions, made orthonormal twice (Cholesky QR loses half of the digits each time); a
    // pivot that vanishes marks a function that depends on those before it.
    Eigen::MatrixXcd transform = Eigen::MatrixXcd::Zero(generators_count, old_size + added);
    if (old_size) transform.topLeftCorner(old_generators, old_size) = transform_;
    for (Eigen::Index j = old_generators, column = old_size; j < generators_count; ++j) {
        const Generator& generator = generators_[j];
        const double length = values.col(j).norm();
        const Complex unit = length > 0 ? generator.factor / length : 0.0;
        transform(j, column++) = unit;
        if (real && !generator.real) transform(j, column++) = Complex(0, 1) * unit;
    }
    Eigen::Index size = old_size + added;
    for (int pass = 0; pass < 2; ++pass) {
        Eigen::MatrixXcd gram = complex_gram_upper(complex_product(values, transform.leftCols(size)));
        if (real) gram.imag().setZero();
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
            Eigen::MatrixXcd weights;  // of the last curve
            int curve = -1;
            for (std::size_t g = 0; g < generators_.size(); ++g) {
                const Generator& f = generators_[g];
                if (f.curve >= 0) {
                    const CurveDensities& densities = family_->curves[f.curve];
                    if (curve != f.curve) weights = densities.weights(points.positions.segment(begin, count));
                    curve = f.curve;
                    values.col(static_cast<Eigen::Index>(g)).segment(begin, count) =
                        square.matrix().cwiseProduct(weights * densities.densities().col(f.density));
                    continue;
                }
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
    std::vector<Eigen::VectorXcd> jumps;  // at the points of the curves; empty before there are any
    for (std::size_t g = 0; g < generators_.size(); ++g) {
        const Generator& f = generators_[g];
        if (f.curve < 0) continue;
        for (std::size_t i = jumps.size(); i <= static_cast<std::size_t>(f.curve); ++i)
            jumps.emplace_back(Eigen::VectorXcd::Zero(family_->curves[i].densities().rows()));
        jumps[f.curve] += c[static_cast<Eigen::Index>(g)] * family_->curves[f.curve].densities().col(f.density);
    }
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
                if (f.curve >= 0) continue;
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
            for (int i = 0; i < count; ++i) phi[begin + i] = Complex(re[i], im[i]);
            for (std::size_t j = 0; j < jumps.size(); ++j)
                phi.segment(begin, count) +=
                    family_->curves[j].integral(points.positions.segment(begin, count), jumps[j]);
            for (int i = 0; i < count; ++i)
                phi[begin + i] *= points.derivatives[begin + i] * points.derivatives[begin + i];
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
    if (!raises && !preliminary() && levels_ >= family_->levels) return nullptr;
    auto larger = std::unique_ptr<RationalSpace>(new RationalSpace(*this));
    if (preliminary()) larger->add_corner_poles();
    if (levels_ < family_->levels) larger->add_densities();
    larger->raise(std::min(degree_ + std::max(4, degree_ / 2), family_->largest_degree),
                  std::min(power_ + std::max(2, power_ / 2), family_->largest_power));
    return larger;
}

}  // namespace beltrami
