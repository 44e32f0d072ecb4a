#include <beltrami/differentials/rational_space.h>

#include <algorithm>
#include <cmath>

#include <beltrami/linear/dense.h>
#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

constexpr int kFirstDegree = 8, kFirstPower = 4;
/// A function of which less than this part is new is left out.
constexpr double kDependent = 1e-4;

}  // namespace

std::unique_ptr<DifferentialSpace> RationalSpace::starting_space(const Singularities& singularities,
                                                                 Quadrature quadrature, int largest_degree) {
    int largest_power = 0;
    for (const auto& hole : singularities.holes) largest_power = std::max(largest_power, hole.largest_power);
    auto space = std::unique_ptr<RationalSpace>(new RationalSpace(
        std::make_shared<const Family>(Family{singularities, std::move(quadrature), largest_degree, largest_power})));
    std::vector<Pole> first =
        space->raise(std::min(kFirstDegree, largest_degree), std::min(kFirstPower, largest_power));
    for (const Complex pin : singularities.pins) first.push_back({pin, 1.0, 1});
    space->add(first);
    return space;
}

std::vector<Pole> RationalSpace::take_corner_poles() {
    std::vector<Pole> poles;
    for (const auto& corner : family_->singularities.corners)
        for (int j = 0; j < corner_poles; ++j) {
            const double distance =
                corner.reach * std::exp(-4 * (std::sqrt(corner_poles) - std::sqrt(corner_poles - j)));
            if (distance < corner.finest && j > 0) break;
            poles.push_back({corner.vertex + distance * corner.outward, distance, 1});
        }
    with_corners_ = true;
    return poles;
}

std::vector<Pole> RationalSpace::raise(int degree, int power) {
    std::vector<Pole> more;
    for (int j = degree_ + 1; j <= degree; ++j) more.push_back({0.0, 1.0, -j});
    for (const auto& hole : family_->singularities.holes)
        for (int j = power_ + 1; j <= std::min(power, hole.largest_power); ++j)
            more.push_back({hole.centre, hole.radius, j});
    degree_ = std::max(degree_, degree);
    power_ = std::max(power_, power);
    return more;
}

void RationalSpace::add(const std::vector<Pole>& more) {
    if (more.empty()) return;
    const auto old_generators = static_cast<Eigen::Index>(generators_.size()), old_size = transform_.cols();
    generators_.insert(generators_.end(), more.begin(), more.end());
    const auto generators_count = static_cast<Eigen::Index>(generators_.size()),
               added = static_cast<Eigen::Index>(more.size());
    const Quadrature& quadrature = family_->quadrature;
    Eigen::MatrixXcd values = generators({quadrature.points, Eigen::VectorXcd::Ones(quadrature.points.size())});
    values = quadrature.weights.cwiseSqrt().cast<Complex>().asDiagonal() * values;

    // Coefficients of the new functions, made orthonormal twice (Cholesky QR loses half of the digits each time); a
    // pivot that vanishes marks a function that depends on those before it. The first time products of the generators
    // will do: what the earlier functions lose by cancellation in their own products is not looked at.
    Eigen::MatrixXcd transform = Eigen::MatrixXcd::Zero(generators_count, old_size + added);
    if (old_size) transform.topLeftCorner(old_generators, old_size) = transform_;
    for (Eigen::Index j = 0; j < added; ++j) {
        const double length = values.col(old_generators + j).norm();
        transform(old_generators + j, old_size + j) = length > 0 ? 1 / length : 0.0;
    }
    const Eigen::MatrixXcd products = complex_gram_upper(values);
    Eigen::Index size = old_size + added;
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::MatrixXcd gram =
            pass == 0 ? Eigen::MatrixXcd(transform.adjoint() * (products.selfadjointView<Eigen::Upper>() * transform))
                      : complex_gram_upper(complex_product(values, transform.leftCols(size)));
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
    Eigen::MatrixXcd values = pole_values(generators_, points.positions);
    const Eigen::VectorXcd square = points.derivatives.cwiseProduct(points.derivatives);
    parallel_for(
        0, static_cast<int>(values.cols()),
        [&](int first, int last) {
            for (int g = first; g < last; ++g) values.col(g).array() *= square.array();
        },
        1);
    return values;
}

Eigen::VectorXcd RationalSpace::combination(const ChartPoints& points, const Eigen::VectorXcd& coefficients) const {
    return pole_combination(generators_, points.positions, of_generators(coefficients))
        .cwiseProduct(points.derivatives.cwiseProduct(points.derivatives));
}

Eigen::MatrixXcd RationalSpace::pair(const ChartPoints& points, const Eigen::MatrixXcd& weights) const {
    const Eigen::VectorXcd square = points.derivatives.cwiseProduct(points.derivatives);
    return from_generators(pole_pairing(generators_, points.positions, square.asDiagonal() * weights));
}

std::unique_ptr<DifferentialSpace> RationalSpace::refined() const {
    const bool raises = degree_ < family_->largest_degree || power_ < family_->largest_power;
    if (!raises && !preliminary()) return nullptr;
    auto larger = std::unique_ptr<RationalSpace>(new RationalSpace(*this));
    std::vector<Pole> more = larger->raise(std::min(degree_ + std::max(4, degree_ / 2), family_->largest_degree),
                                           std::min(power_ + std::max(2, power_ / 2), family_->largest_power));
    if (preliminary()) {
        const std::vector<Pole> poles = larger->take_corner_poles();
        more.insert(more.begin(), poles.begin(), poles.end());
    }
    larger->add(more);
    return larger;
}

}  // namespace beltrami
