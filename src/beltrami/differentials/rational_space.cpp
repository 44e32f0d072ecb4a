#include <beltrami/differentials/rational_space.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/parallel.h>
#include <beltrami/linear/dense.h>

namespace beltrami {

namespace {

constexpr int kFirstDegree = 8, kFirstPower = 4;
/// A function of which less than this part is new is left out.
constexpr double kDependentRational = 1e-4;
/// Points worked through at a time where densities are.
constexpr int kPointsPerRationalChunk = 512;

}  // namespace

std::unique_ptr<RationalSpace> RationalSpace::empty_space(const Singularities& singularities, Quadrature quadrature,
                                                          int largest_degree) {
    int largest_power = 0;
    for (const auto& hole : singularities.holes) largest_power = std::max(largest_power, hole.largest_power);
    Family family{singularities, std::move(quadrature), largest_degree, largest_power, {}};
    for (const auto& curve : singularities.curves) {
        family.curves.emplace_back(curve);
        family.levels = std::max(family.levels, family.curves.back().levels());
    }
    return std::unique_ptr<RationalSpace>(new RationalSpace(std::make_shared<const Family>(std::move(family))));
}

std::unique_ptr<DifferentialSpace> RationalSpace::starting_space(const Singularities& singularities,
                                                                 Quadrature quadrature, int largest_degree) {
    auto space = empty_space(singularities, std::move(quadrature), largest_degree);
    space->add(space->take_first());
    return space;
}

std::unique_ptr<DifferentialSpace> RationalSpace::largest_space(const Singularities& singularities,
                                                                Quadrature quadrature, int largest_degree) {
    auto space = empty_space(singularities, std::move(quadrature), largest_degree);
    std::vector<Generator> all = space->take_first();
    const auto take = [&](const std::vector<Generator>& next) { all.insert(all.end(), next.begin(), next.end()); };
    take(space->take_corner_poles());
    while (space->levels_ < space->family_->levels) take(space->take_densities());
    take(space->raise(largest_degree, space->family_->largest_power));
    space->add(all);
    return space;
}

std::vector<RationalSpace::Generator> RationalSpace::take_first() {
    std::vector<Generator> first =
        raise(std::min(kFirstDegree, family_->largest_degree), std::min(kFirstPower, family_->largest_power));
    for (const Complex pin : family_->singularities.pins) first.push_back(Pole{pin, 1.0, 1});
    for (const auto& held : family_->singularities.held) first.push_back({Pole{held.at, 1.0, 1}, held.residue});
    return first;
}

std::vector<RationalSpace::Generator> RationalSpace::take_corner_poles() {
    std::vector<Generator> poles;
    for (const auto& corner : family_->singularities.corners)
        for (int j = 0; j < corner_poles; ++j) {
            const double distance =
                corner.reach * std::exp(-4 * (std::sqrt(corner_poles) - std::sqrt(corner_poles - j)));
            if (distance < corner.finest && j > 0) break;
            poles.push_back(Pole{corner.vertex + distance * corner.outward, distance, 1});
        }
    with_corners_ = true;
    return poles;
}

std::vector<RationalSpace::Generator> RationalSpace::take_densities() {
    std::vector<Generator> more;
    for (std::size_t c = 0; c < family_->curves.size(); ++c) {
        const CurveDensities& curve = family_->curves[c];
        if (levels_ >= curve.levels()) continue;
        for (int j = levels_ > 0 ? curve.size_up_to(levels_ - 1) : 0; j < curve.size_up_to(levels_); ++j)
            more.push_back({static_cast<int>(c), j, curve.real(j)});
    }
    ++levels_;
    return more;
}

std::vector<RationalSpace::Generator> RationalSpace::raise(int degree, int power) {
    std::vector<Generator> more;
    for (int j = degree_ + 1; j <= degree; ++j) more.push_back(Pole{0.0, 1.0, -j});
    for (const auto& hole : family_->singularities.holes)
        for (int j = power_ + 1; j <= std::min(power, hole.largest_power); ++j)
            more.push_back(Pole{hole.centre, hole.radius, j});
    degree_ = std::max(degree_, degree);
    power_ = std::max(power_, power);
    return more;
}

void RationalSpace::add(const std::vector<Generator>& more) {
    if (more.empty()) return;
    const auto old_generators = static_cast<Eigen::Index>(generators_.size()), old_size = transform_.cols();
    for (const Generator& generator : more) {
        if (generator.curve < 0) {
            pole_at_.push_back(static_cast<Eigen::Index>(generators_.size()));
            poles_.push_back(generator.pole);
        }
        generators_.push_back(generator);
    }
    const bool real = !complex_coefficients();
    const auto generators_count = static_cast<Eigen::Index>(generators_.size());
    Eigen::Index added = 0;
    for (const Generator& generator : more) added += real && !generator.real ? 2 : 1;
    const Quadrature& quadrature = family_->quadrature;
    Eigen::MatrixXcd values = generators({quadrature.points, Eigen::VectorXcd::Ones(quadrature.points.size())});
    values = quadrature.weights.cwiseSqrt().cast<Complex>().asDiagonal() * values;

    // Coefficients of the new functions, made orthonormal twice (Cholesky QR loses half of the digits each time); a
    // pivot that vanishes marks a function that depends on those before it. The first time products of the generators
    // will do: what the earlier functions lose by cancellation in their own products is not looked at.
    Eigen::MatrixXcd transform = Eigen::MatrixXcd::Zero(generators_count, old_size + added);
    if (old_size) transform.topLeftCorner(old_generators, old_size) = transform_;
    for (Eigen::Index j = old_generators, column = old_size; j < generators_count; ++j) {
        const Generator& generator = generators_[j];
        const double length = values.col(j).norm();
        const Complex unit = length > 0 ? generator.factor / length : 0.0;
        transform(j, column++) = unit;
        if (real && !generator.real) transform(j, column++) = Complex(0, 1) * unit;
    }
    const Eigen::MatrixXcd products = complex_gram_upper(values);
    Eigen::Index size = old_size + added;
    for (int pass = 0; pass < 2; ++pass) {
        Eigen::MatrixXcd gram =
            pass == 0 ? Eigen::MatrixXcd(transform.adjoint() * (products.selfadjointView<Eigen::Upper>() * transform))
                      : complex_gram_upper(complex_product(values, transform.leftCols(size)));
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
            if (!(square > kDependentRational * kDependentRational * gram(j, j).real())) continue;
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
    Eigen::MatrixXcd values = pole_values(poles_, points.positions);
    if (poles_.size() < generators_.size()) values = with_densities(values, points.positions);
    const Eigen::VectorXcd square = points.derivatives.cwiseProduct(points.derivatives);
    parallel_for(
        0, static_cast<int>(values.cols()),
        [&](int first, int last) {
            for (int g = first; g < last; ++g) values.col(g).array() *= square.array();
        },
        1);
    return values;
}

/// Values of all generators from those of the poles.
Eigen::MatrixXcd RationalSpace::with_densities(const Eigen::MatrixXcd& of_poles, const Eigen::VectorXcd& z) const {
    Eigen::MatrixXcd values(z.size(), static_cast<Eigen::Index>(generators_.size()));
    for (std::size_t j = 0; j < pole_at_.size(); ++j)
        values.col(pole_at_[j]) = of_poles.col(static_cast<Eigen::Index>(j));
    parallel_for(
        0, static_cast<int>(z.size()),
        [&](int begin, int end) {
            const int count = end - begin;
            Eigen::MatrixXcd weights;  // of the last curve
            int curve = -1;
            for (std::size_t g = 0; g < generators_.size(); ++g) {
                const Generator& f = generators_[g];
                if (f.curve < 0) continue;
                const CurveDensities& densities = family_->curves[f.curve];
                if (curve != f.curve) weights = densities.weights(z.segment(begin, count));
                curve = f.curve;
                values.col(static_cast<Eigen::Index>(g)).segment(begin, count) =
                    weights * densities.densities().col(f.density);
            }
        },
        kPointsPerRationalChunk);
    return values;
}

Eigen::VectorXcd RationalSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    const Eigen::VectorXcd c = of_generators(coefficients);
    Eigen::VectorXcd phi = pole_combination(poles_, points.positions, c(pole_at_));
    std::vector<Eigen::VectorXcd> jumps;  // at the points of the curves; empty before there are any
    for (std::size_t g = 0; g < generators_.size(); ++g) {
        const Generator& f = generators_[g];
        if (f.curve < 0) continue;
        for (std::size_t i = jumps.size(); i <= static_cast<std::size_t>(f.curve); ++i)
            jumps.emplace_back(Eigen::VectorXcd::Zero(family_->curves[i].densities().rows()));
        jumps[f.curve] += c[static_cast<Eigen::Index>(g)] * family_->curves[f.curve].densities().col(f.density);
    }
    if (!jumps.empty())
        parallel_for(
            0, static_cast<int>(phi.size()),
            [&](int begin, int end) {
                const int count = end - begin;
                for (std::size_t j = 0; j < jumps.size(); ++j)
                    phi.segment(begin, count) +=
                        family_->curves[j].integral(points.positions.segment(begin, count), jumps[j]);
            },
            kPointsPerRationalChunk);
    return phi.cwiseProduct(points.derivatives.cwiseProduct(points.derivatives));
}

Eigen::MatrixXcd RationalSpace::pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const {
    if (poles_.size() < generators_.size()) return DifferentialSpace::pair(points, weights);
    const Eigen::VectorXcd square = points.derivatives.cwiseProduct(points.derivatives);
    return from_generators(pole_pairing(poles_, points.positions, square.asDiagonal() * weights));
}

std::unique_ptr<DifferentialSpace> RationalSpace::refined() const {
    const bool raises = degree_ < family_->largest_degree || power_ < family_->largest_power;
    if (!raises && !preliminary() && levels_ >= family_->levels) return nullptr;
    auto larger = std::unique_ptr<RationalSpace>(new RationalSpace(*this));
    std::vector<Generator> more;
    const auto take = [&](const std::vector<Generator>& next) { more.insert(more.end(), next.begin(), next.end()); };
    if (preliminary()) take(larger->take_corner_poles());
    if (levels_ < family_->levels) take(larger->take_densities());
    take(larger->raise(std::min(degree_ + std::max(4, degree_ / 2), family_->largest_degree),
                       std::min(power_ + std::max(2, power_ / 2), family_->largest_power)));
    larger->add(more);
    return larger;
}

}  // namespace beltrami
