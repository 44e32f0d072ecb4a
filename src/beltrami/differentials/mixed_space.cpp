#include <beltrami/differentials/mixed_space.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/differentials/orthonormal_columns.h>
#include <beltrami/differentials/pulled_back.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/linear/dense.h>

namespace beltrami {

namespace {

/// A function of which less than this part is new is left out.
constexpr double kDependentMixed = 1e-6;
/// Singular values up to this belong to the space where the condition changes along a loop. They rise from rounding
/// ever faster to a quarter and more within five or so: what is left out is what the next degree describes better.
constexpr double kCut = 0.03;
/// A and B of a Puiseux pair have at most this degree: from 25 on they hardly differ from one another to rounding
/// (coefficients of 1e10 at 18, 1e14 at 27), at 18 differentials known in closed form are met to 1e-8.
constexpr int kLargestBranched = 20;
/// Where their number is known the space is of use up to this residual …
constexpr double kLargestMixedResidual = 1e-3, kLeastMixedGap = 30;
/// … and loops that slide have more powers, up to so many, until it is below that.
constexpr double kWantedResidual = 1e-7;
constexpr int kMoreMixedPowers = 12, kMostPowers = 120;
/// New directions of a larger space: what is left of them without the smaller one.
constexpr double kNew = 0.3;
/// Mirror images of poles so many radii away or further are left to the powers.
constexpr double kFarMixedImage = 3;

}  // namespace

std::shared_ptr<const MixedSpace::Family> MixedSpace::family(MixedDomain domain, int largest_degree,
                                                             std::vector<int> largest_powers, int resolving) {
    Family result{std::move(domain), {}, largest_degree, std::move(largest_powers), resolving, {}};
    int degree = resolving;
    for (std::size_t l = 0; l < result.domain.loops.size(); ++l) {
        const MixedDomain::Loop& loop = result.domain.loops[l];
        std::vector<Complex>& roots = result.roots.emplace_back();
        for (const Complex p : loop.transitions) {
            const Complex from = p - loop.centre;
            roots.push_back(l == 0 ? std::conj(from) / loop.radius : from / loop.radius);
        }
        int& largest = l == 0 ? result.largest_degree : result.largest_powers[l - 1];
        if (!loop.transitions.empty()) largest = std::min(largest, kLargestBranched);
        degree = std::max(degree, largest);
    }
    result.samples = boundary_samples(result.domain, degree, false);
    return std::make_shared<const Family>(std::move(result));
}

MixedSpace::MixedSpace(MixedDomain domain, int degree, int largest_degree, const std::vector<int>& largest_powers) {
    int resolving = largest_degree + kMoreMixedPowers;
    for (const int power : largest_powers) resolving = std::max(resolving, power + kMoreMixedPowers);
    const bool slides = std::any_of(domain.loops.begin(), domain.loops.end(),
                                    [](const MixedDomain::Loop& loop) { return !loop.prescribed(); });
    for (;; resolving = std::min(2 * resolving, kMostPowers)) {
        MixedSpace space(family(domain, largest_degree, largest_powers, resolving));
        const bool clear = space.raise(std::min(degree, largest_degree), std::max(degree / 2, 1));
        const bool better = !family_ || space.fit_.residual < fit_.residual;
        if (clear && better) *this = space;
        if (!slides || space.fit_.residual <= kWantedResidual || resolving >= kMostPowers || (clear && !better)) break;
    }
    if (!family_)
        throw Error(Cause::not_solved, "the quadratic differentials of the mixed problem are not found",
                    "circles that nearly touch, or marks very near each other, need a finer mesh");
}

std::vector<MixedSpace::Function> MixedSpace::functions_up_to(int degree, int power) {
    std::vector<Function> more;
    const MixedDomain& domain = family_->domain;
    const bool first = degree_ < 0;
    for (int l = 0; l < static_cast<int>(domain.loops.size()); ++l) {
        const MixedDomain::Loop& loop = domain.loops[l];
        int from = l == 0 ? degree_ + 1 : power_ + 1, to = degree;
        if (l > 0) to = std::min(power, family_->largest_powers[l - 1]);
        if (!loop.prescribed()) {
            if (!first) continue;
            to = family_->resolving;
        }
        if (first) from = l == 0 ? 0 : 1;
        for (int j = from; j <= to; ++j) {
            if (loop.transitions.empty()) {
                more.push_back({l, j, 0, 0.0, 1.0});
            } else {
                more.push_back({l, j, 2, 0.0, 1.0});
                more.push_back({l, j, 1, 0.0, 1.0});
            }
        }
    }
    if (first) {
        // φ continues by reflection across what slides, with poles at mirror images; those near their circle would take
        // many powers.
        const auto add = [&](Complex p, int own_loop, double scale) {
            more.push_back({-1, 1, 0, p, scale});
            for (int l = 0; l < static_cast<int>(domain.loops.size()); ++l) {
                const MixedDomain::Loop& loop = domain.loops[l];
                const double ratio = std::abs(p - loop.centre) / loop.radius;
                if (l == own_loop || loop.prescribed() || ratio > kFarMixedImage || ratio * kFarMixedImage < 1)
                    continue;
                const Complex image = loop.centre + loop.radius * loop.radius / std::conj(p - loop.centre);
                more.push_back({-1, 1, 0, image, std::abs(std::abs(image - loop.centre) - loop.radius)});
            }
        };
        for (const auto& mark : domain.marks) add(mark.at, mark.loop, domain.loops[mark.loop].radius);
        for (const Complex pin : domain.pins) add(pin, -1, 1.0);
        for (const auto& point : domain.held) add(point.at, -1, 1.0);
    }
    degree_ = std::max(degree_, degree);
    power_ = std::max(power_, power);
    return more;
}

Eigen::MatrixXcd MixedSpace::values(const std::vector<Function>& functions, const Eigen::VectorXcd& points) const {
    const Eigen::Index count = points.size();
    Eigen::MatrixXcd result(count, static_cast<Eigen::Index>(functions.size()));
    int loop_of_powers = -1;
    int largest = 0;
    for (const Function& f : functions) largest = std::max(largest, f.power);
    Eigen::MatrixXcd powers(count, largest + 1);
    Eigen::ArrayXcd q, q_squared;
    for (std::size_t j = 0; j < functions.size(); ++j) {
        const Function& f = functions[j];
        const auto column = static_cast<Eigen::Index>(j);
        if (f.loop < 0) {
            for (Eigen::Index i = 0; i < count; ++i) result(i, column) = f.scale / (points[i] - f.centre);
            continue;
        }
        if (f.loop != loop_of_powers) {
            loop_of_powers = f.loop;
            const MixedDomain::Loop& loop = family_->domain.loops[f.loop];
            const Eigen::ArrayXcd from = points.array() - loop.centre;
            const Eigen::ArrayXcd w = f.loop == 0 ? Eigen::ArrayXcd(from / loop.radius)
                                                  : Eigen::ArrayXcd(loop.radius * from.conjugate() / from.abs2());
            powers.col(0).setOnes();
            for (int p = 1; p <= largest; ++p) powers.col(p) = powers.col(p - 1).array() * w;
            q = Eigen::ArrayXcd::Ones(count);
            for (const Complex root : family_->roots[f.loop])
                for (Eigen::Index i = 0; i < count; ++i) q[i] *= std::sqrt(1.0 - w[i] * root);
            q_squared = q * q;
        }
        result.col(column) = powers.col(f.power);
        if (f.root == 1) result.col(column).array() /= q;
        if (f.root == 2) result.col(column).array() /= q_squared;
    }
    return result;
}

/// Appends to the orthonormal basis what functions add to it.
void MixedSpace::orthonormalise(const std::vector<Function>& more) {
    const BoundarySamples& samples = family_->samples;
    const Eigen::MatrixXcd given = samples.root_weights.cast<Complex>().asDiagonal() * values(more, samples.places);
    const auto old_functions = static_cast<Eigen::Index>(functions_.size());
    const Eigen::Index added = given.cols(), old = orthonormal_.cols();
    functions_.insert(functions_.end(), more.begin(), more.end());
    Eigen::MatrixXcd Q(given.rows(), old + added), T = Eigen::MatrixXcd::Zero(old_functions + added, old + added);
    if (old > 0) {
        Q.leftCols(old) = orthonormal_;
        T.topLeftCorner(old_functions, old) = triangle_;
    }
    lengths_.conservativeResize(old_functions + added);
    Eigen::Index size = old;
    for (Eigen::Index j = 0; j < added; ++j) {
        const double length = given.col(j).norm();
        lengths_[old_functions + j] = length;
        Eigen::VectorXcd v = given.col(j) / length, in_functions = Eigen::VectorXcd::Zero(T.rows());
        in_functions[old_functions + j] = 1 / length;
        detail::append_orthonormal(std::move(v), std::move(in_functions), kDependentMixed, Q, T, size);
    }
    orthonormal_ = Q.leftCols(size);
    triangle_ = T.leftCols(size);
}

/// Rows that vanish for what is wanted, for real and imaginary coefficients of the orthonormal basis.
Eigen::MatrixXd MixedSpace::conditions() const {
    const BoundarySamples& samples = family_->samples;
    const Eigen::Index n = orthonormal_.cols();
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < samples.slides.size(); ++i)
        if (samples.slides[i]) rows.push_back(static_cast<Eigen::Index>(i));
    const auto& held = family_->domain.held;
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(std::max<Eigen::Index>(1, static_cast<Eigen::Index>(rows.size() + held.size())), 2 * n);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Eigen::RowVectorXcd turned = samples.squared_tangents[rows[i]] * orthonormal_.row(rows[i]);
        const auto row = static_cast<Eigen::Index>(i);
        result.row(row).head(n) = turned.imag();
        result.row(row).tail(n) = turned.real();
    }
    // The residue at a point held to a line has a direction.
    for (std::size_t h = 0; h < held.size(); ++h) {
        const auto row = static_cast<Eigen::Index>(rows.size() + h);
        for (std::size_t j = 0; j < functions_.size(); ++j) {
            if (functions_[j].loop >= 0 || functions_[j].centre != held[h].at) continue;
            const auto function = static_cast<Eigen::Index>(j);
            const Complex turn = lengths_[function] * std::conj(held[h].residue) / std::abs(held[h].residue);
            const Eigen::RowVectorXcd turned = turn * triangle_.row(function);
            result.row(row).head(n) = turned.imag();
            result.row(row).tail(n) = turned.real();
        }
    }
    return result;
}

/// Of the space with its present functions; −1 where it is not known.
int MixedSpace::known_dimension() const {
    const MixedDomain& domain = family_->domain;
    if (!domain.closed()) return -1;
    int result = 2 * static_cast<int>(domain.pins.size()) + static_cast<int>(domain.held.size()) +
                 static_cast<int>(domain.marks.size());
    bool prescribed = false;
    for (std::size_t l = 0; l < domain.loops.size(); ++l) {
        if (domain.loops[l].prescribed()) {
            prescribed = true;
            result += 2 * (l == 0 ? degree_ + 1 : std::min(power_, family_->largest_powers[l - 1]));
        } else {
            result += l == 0 ? -3 : 3;
        }
    }
    const int least = !prescribed && domain.loops.size() == 2 ? 1 : 0;
    return std::max(result, least);
}

bool MixedSpace::raise(int degree, int power) {
    const Eigen::Index before = orthonormal_.cols();
    orthonormalise(functions_up_to(degree, power));
    const Eigen::Index n = orthonormal_.cols();
    Eigen::MatrixXd earlier = Eigen::MatrixXd::Zero(2 * n, space_.cols());
    if (space_.cols() > 0) {
        earlier.topRows(before) = space_.topRows(before);
        earlier.middleRows(n, before) = space_.bottomRows(before);
    }
    const auto [squares, vectors] = symmetric_eigen(gram_lower(conditions()));
    const Eigen::VectorXd singular = squares.cwiseMax(0.0).cwiseSqrt();
    const int known = known_dimension();
    Eigen::Index dimension = known;
    if (known < 0) {
        dimension = 0;
        while (dimension < singular.size() && singular[dimension] <= kCut) ++dimension;
    }
    if (dimension > singular.size()) return false;
    fit_.last = dimension > 0 ? singular[dimension - 1] : 0;
    fit_.next = dimension < singular.size() ? singular[dimension] : 1;

    // The functions there were, and what the larger space has besides.
    space_ = earlier;
    if (dimension > 0) {
        Eigen::MatrixXd others = vectors.leftCols(dimension);
        others -= earlier * (earlier.transpose() * others);
        const auto [parts, turns] = symmetric_eigen(gram_lower(others));  // ascending
        Eigen::Index count = std::max<Eigen::Index>(0, dimension - earlier.cols());
        if (known < 0) count = std::count_if(parts.begin(), parts.end(), [](double p) { return p > kNew * kNew; });
        space_.conservativeResize(2 * n, earlier.cols() + count);
        if (count > 0) space_.rightCols(count) = orthonormal_columns(others * turns.rightCols(count));
    }
    Eigen::MatrixXcd combinations(n, space_.cols());
    combinations.real() = space_.topRows(n);
    combinations.imag() = space_.bottomRows(n);
    coefficients_ = triangle_ * combinations;
    measure();
    return known < 0 || (fit_.residual < kLargestMixedResidual && fit_.next > kLeastMixedGap * fit_.residual);
}

/// The residual on points between those of the fit.
void MixedSpace::measure() {
    int degree = std::max(degree_, power_);
    for (const auto& loop : family_->domain.loops)
        if (!loop.prescribed()) degree = std::max(degree, family_->resolving);
    const BoundarySamples between = boundary_samples(family_->domain, degree, true);
    const Eigen::MatrixXcd space =
        between.root_weights.cast<Complex>().asDiagonal() * (values(functions_, between.places) * coefficients_);
    Eigen::MatrixXd residuals(space.rows(), space.cols());
    for (Eigen::Index i = 0; i < space.rows(); ++i)
        residuals.row(i) = between.slides[static_cast<std::size_t>(i)]
                               ? Eigen::RowVectorXd((between.squared_tangents[i] * space.row(i)).imag())
                               : Eigen::RowVectorXd::Zero(space.cols());
    fit_.residual = 0;
    for (Eigen::Index j = 0; j < space.cols(); ++j)
        fit_.residual = std::max(fit_.residual, residuals.col(j).norm() / space.col(j).norm());
}

Eigen::MatrixXcd MixedSpace::generators(const ChartPoints& points) const {
    return pulled_back(points, size(), [&](const Eigen::VectorXcd& places) {
        return Eigen::MatrixXcd(values(functions_, places) * coefficients_);
    });
}

std::unique_ptr<DifferentialSpace> MixedSpace::refined() const {
    int largest_power = 0;
    bool raises = false;
    for (std::size_t l = 0; l < family_->domain.loops.size(); ++l) {
        if (!family_->domain.loops[l].prescribed()) continue;
        const int most = l == 0 ? family_->largest_degree : family_->largest_powers[l - 1];
        raises = raises || (l == 0 ? degree_ : power_) < most;
        if (l > 0) largest_power = std::max(largest_power, most);
    }
    if (!raises) return nullptr;
    const int degree = std::min(degree_ + std::max(4, degree_ / 2), std::max(degree_, family_->largest_degree));
    const int power = std::min(power_ + std::max(2, power_ / 2), std::max(power_, largest_power));
    std::unique_ptr<MixedSpace> larger(new MixedSpace(*this));
    if (!larger->raise(degree, power) || larger->size() <= size()) return nullptr;
    return larger;
}

}  // namespace beltrami
