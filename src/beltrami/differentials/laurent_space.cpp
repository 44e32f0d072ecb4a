#include <beltrami/differentials/laurent_space.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/differentials/gauss_rule.h>
#include <beltrami/differentials/pulled_back.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/linear/dense.h>

namespace beltrami {

namespace {

/// A power of which less than this part is new is left out.
constexpr double kDependentLaurent = 1e-11;
/// Cholesky factors orthonormalise columns of which so much is new.
constexpr double kCholesky = 1e-5;
/// Singular values below this are rounding.
constexpr double kRounding = 1e-14;
/// The space is of use up to this residual, and clear of the others by this factor.
constexpr double kLargestResidual = 1e-3, kLeastGap = 30;
/// Below this residual a degree that does not improve on the last by this factor has met rounding.
constexpr double kNearRounding = 1e-7, kImproves = 0.1;
/// Mirror images this many radii away or further are left to the powers.
constexpr double kFarImage = 3;
/// Singular values reported on either side of the gap, at most.
constexpr int kReported = 6;
/// Inverse iteration: further vectors in the block, steps, and the shift as part of the mean square.
constexpr int kExtra = 8, kInverseSteps = 6;
constexpr double kLaurentShift = 1e-13;
/// Powers are added beyond those that the fall of the residual so far asks for: as part of them, and in any case.
constexpr double kMorePowers = 1.1;
constexpr int kLeastMorePowers = 4;

/// Boundary points with the square of the tangent, −exp(2iθ), and the root of their weight in the mean square.
struct BoundaryPoints {
    std::vector<Complex> places, squared_tangents;
    std::vector<double> root_weights;

    Eigen::VectorXcd positions() const {
        return Eigen::Map<const Eigen::VectorXcd>(places.data(), static_cast<Eigen::Index>(places.size()));
    }
};

/// Angles of a circle's marks, ascending, and how far each is from the next one.
struct Marks {
    std::vector<double> angles, rooms;
};
Marks marks_on(const RoundDomain& domain, int circle) {
    Marks marks;
    for (const Complex p : domain.boundary_marks)
        if (domain.circle_of(p) == circle) marks.angles.push_back(std::arg(p - domain.circle(circle).centre));
    std::sort(marks.angles.begin(), marks.angles.end());
    const std::size_t n = marks.angles.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double next = i + 1 < n ? marks.angles[i + 1] : marks.angles[0] + kTurn;
        const double last = i > 0 ? marks.angles[i - 1] : marks.angles[n - 1] - kTurn;
        marks.rooms.push_back(std::min({1.0, next - marks.angles[i], marks.angles[i] - last}));
    }
    return marks;
}

/// Points on every circle that resolve powers up to a degree. On a circle without marks they are evenly spaced; else in
/// panels that shrink towards the marks, where the weight falls like the square of the distance.
/// @param shifted places between those of the fit
BoundaryPoints boundary_points(const RoundDomain& domain, int degree, bool shifted) {
    BoundaryPoints result;
    const auto add = [&](int circle, const Marks& marks, double angle, double weight) {
        const RoundDomain::Disk& c = domain.circle(circle);
        const Complex direction = std::polar(1.0, angle);
        double tame = 1;
        for (std::size_t i = 0; i < marks.angles.size(); ++i) {
            const double distance = 2 * std::sin(0.5 * (angle - marks.angles[i])), room = marks.rooms[i];
            tame *= distance * distance / (distance * distance + room * room);
        }
        result.places.push_back(c.centre + c.radius * direction);
        result.squared_tangents.push_back(-direction * direction);
        result.root_weights.push_back(std::sqrt(weight * tame / kTurn));
    };
    const int density = degree + 4;
    for (int circle = 0; circle < domain.circle_count(); ++circle) {
        const Marks marks = marks_on(domain, circle);
        if (marks.angles.empty()) {
            const int count = shifted ? 6 * density + 1 : 4 * density;
            for (int i = 0; i < count; ++i)
                add(circle, marks, kTurn * (i + (shifted ? 0.3 : 0)) / count, kTurn / count);
            continue;
        }
        const double longest = (shifted ? 3.7 : 6.0) / density;
        for (std::size_t i = 0; i < marks.angles.size(); ++i) {
            const double begin = marks.angles[i],
                         end = i + 1 < marks.angles.size() ? marks.angles[i + 1] : marks.angles[0] + kTurn;
            const double near_begin = marks.rooms[i], near_end = marks.rooms[(i + 1) % marks.rooms.size()];
            std::vector<double> edges{begin};
            while (edges.back() < end) {
                // As long as the distance to either mark allows, at least a quarter of its room.
                const double at = edges.back();
                const double length = std::min({longest, std::max(0.25 * near_begin, 0.5 * (at - begin)),
                                                std::max(0.25 * near_end, 0.35 * (end - at))});
                edges.push_back(at + 1.5 * length > end ? end : at + length);
            }
            for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
                const double length = edges[e + 1] - edges[e];
                for (const GaussNode& node : kGauss)
                    add(circle, marks, edges[e] + node.place * length, node.weight * length);
            }
        }
    }
    return result;
}

/// Im φ τ² of functions given on points, as a real matrix of their real and imaginary coefficients.
Eigen::MatrixXd imaginary_parts(const Eigen::MatrixXcd& functions, const BoundaryPoints& points) {
    const auto tangents = Eigen::Map<const Eigen::VectorXcd>(points.squared_tangents.data(),
                                                             static_cast<Eigen::Index>(points.squared_tangents.size()));
    const Eigen::MatrixXcd turned = tangents.asDiagonal() * functions;
    Eigen::MatrixXd result(turned.rows(), 2 * turned.cols());
    result << turned.imag(), turned.real();
    return result;
}

/// A = Q R with orthonormal columns in place of A: by Cholesky factors of AᴴA, twice, or where these fail by
/// reflections.
/// @return flags of the columns that do not depend on earlier ones; Q and R are of use if all are set
std::vector<char> orthonormalise(Eigen::MatrixXcd& A, Eigen::MatrixXcd& R) {
    const Eigen::Index n = A.cols();
    std::vector<char> kept(static_cast<std::size_t>(n), 1);
    const Eigen::VectorXd lengths = A.colwise().norm();
    Eigen::MatrixXcd Q = A * lengths.cwiseInverse().cast<Complex>().asDiagonal();
    R = lengths.cast<Complex>().asDiagonal();
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::MatrixXcd gram = complex_gram_upper(Q);
        const Eigen::LLT<Eigen::MatrixXcd, Eigen::Upper> factor(gram);
        const Eigen::MatrixXcd own = factor.matrixU();
        const double least = own.diagonal().real().minCoeff();
        if (factor.info() != Eigen::Success || !(least > (pass == 0 ? kCholesky : 0.5))) break;
        Q = complex_product(Q, own.triangularView<Eigen::Upper>().solve(Eigen::MatrixXcd::Identity(n, n)));
        R = own * R;
        if (pass == 0) continue;
        A = std::move(Q);
        return kept;
    }
    ComplexQr qr = complex_qr(A);
    A = std::move(qr.Q);
    R = std::move(qr.R);
    for (Eigen::Index j = 0; j < n; ++j)
        kept[static_cast<std::size_t>(j)] = std::abs(R(j, j)) > kDependentLaurent * lengths[j];
    return kept;
}

struct Singular {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< right ones, in columns
};

/// The smallest singular values: inverse iteration with a block, then the singular values of A on the block itself, so
/// that AᵀA costs no digits. Those next to the gap are right to a few per cent, the vanishing ones to rounding.
Singular smallest_singular(const Eigen::MatrixXd& A, Eigen::Index count) {
    const Eigen::Index n = A.cols(), width = std::min(n, count + kExtra);
    Eigen::MatrixXd gram = gram_lower(A);
    gram.diagonal().array() += kLaurentShift * gram.trace() / static_cast<double>(n);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(gram);
    // Any start that is regular will do.
    Eigen::MatrixXd block(n, width);
    for (Eigen::Index j = 0; j < width; ++j)
        for (Eigen::Index i = 0; i < n; ++i) {
            const double turns =
                0.6180339887498949 * static_cast<double>((i + 1) * (j + 1)) + 0.1 * static_cast<double>(i);
            block(i, j) = turns - std::floor(turns) - 0.5;
        }
    for (int step = 0; step < kInverseSteps; ++step) block = orthonormal_columns(factor.solve(block));
    const auto [values, vectors] = right_singular(A * block);
    return {values.reverse().head(count), block * vectors.rowwise().reverse().leftCols(count)};
}

Eigen::VectorXd roots_of_weights(const BoundaryPoints& points) {
    return Eigen::Map<const Eigen::VectorXd>(points.root_weights.data(),
                                             static_cast<Eigen::Index>(points.root_weights.size()));
}

std::string listed(const Eigen::VectorXd& values) {
    std::ostringstream out;
    out.precision(2);
    for (Eigen::Index i = 0; i < values.size(); ++i) out << (i ? ", " : "") << values[i];
    return out.str();
}

}  // namespace

void LaurentOptions::validate() const {
    if (!(tolerance > 0) || first_degree < 4 || largest_degree < first_degree)
        throw Error(Cause::bad_option, "impossible options of a Laurent space",
                    "the tolerance has to be positive, the first degree at least 4 and at most the largest");
}

LaurentSpace::LaurentSpace(RoundDomain domain, const LaurentOptions& options) : domain_(std::move(domain)) {
    options.validate();
    domain_.validate();
    for (Complex& p : domain_.boundary_marks) {
        const RoundDomain::Disk& on = domain_.circle(domain_.circle_of(p));
        p = on.centre + on.radius * (p - on.centre) / std::abs(p - on.centre);
    }
    const int dimension = dimension_of_differentials(static_cast<int>(domain_.holes.size()),
                                                     static_cast<int>(domain_.boundary_marks.size()),
                                                     static_cast<int>(domain_.interior_marks.size()));
    if (dimension == 0) return;
    LaurentSpace best = *this;
    best.fit_.residual = INFINITY;
    double last = INFINITY;
    for (int degree = options.first_degree, last_degree = 0;;) {
        const bool clear = find(degree, dimension);
        const double residual = fit_.residual;
        const bool at_rounding = residual > kImproves * best.fit_.residual && best.fit_.residual < kNearRounding;
        if (clear && residual < best.fit_.residual) best = *this;
        if (best.fit_.residual <= options.tolerance || at_rounding || degree >= options.largest_degree) break;
        // Residuals fall geometrically, once they do.
        int next = 2 * degree;
        if (residual < kImproves * last && std::isfinite(last)) {
            const double wanted =
                std::log(residual / options.tolerance) / std::log(last / residual) * (degree - last_degree);
            next = std::min(next, degree + kLeastMorePowers + static_cast<int>(kMorePowers * wanted));
        }
        last = residual;
        last_degree = degree;
        degree = std::min(next, options.largest_degree);
    }
    if (!(best.fit_.residual <= kLargestResidual))
        throw Error(Cause::not_solved,
                    "the quadratic differentials of the circle domain are not found: " + std::to_string(dimension) +
                        " functions should stand apart, and the singular values are " + listed(fit_.singular_values),
                    "circles that nearly touch, or marks very near each other, need a larger degree");
    *this = std::move(best);
}

std::vector<LaurentSpace::Power> LaurentSpace::powers_up_to(int degree) const {
    std::vector<Power> powers;
    const auto add_pole = [&](Complex p, int own_circle) {
        powers.push_back({p, own_circle >= 0 ? domain_.circle(own_circle).radius : 1.0, 1});
        // φ continues across every circle by reflection, with poles at the mirror images of the marks; those near their
        // circle would take many powers.
        for (int i = 0; i < domain_.circle_count(); ++i) {
            const RoundDomain::Disk& circle = domain_.circle(i);
            const double ratio = std::abs(p - circle.centre) / circle.radius;
            if (i == own_circle || ratio > kFarImage || ratio * kFarImage < 1) continue;
            const Complex image = circle.centre + circle.radius * circle.radius / std::conj(p - circle.centre);
            powers.push_back({image, std::abs(std::abs(image - circle.centre) - circle.radius), 1});
        }
    };
    for (const Complex p : domain_.boundary_marks) add_pole(p, domain_.circle_of(p));
    for (const Complex p : domain_.interior_marks) add_pole(p, -1);
    for (int j = 0; j <= degree; ++j) powers.push_back({domain_.outer.centre, domain_.outer.radius, -j});
    for (const RoundDomain::Disk& hole : domain_.holes)
        for (int j = 1; j <= degree; ++j) powers.push_back({hole.centre, hole.radius, j});
    return powers;
}

Eigen::MatrixXcd LaurentSpace::values(const std::vector<Power>& powers, const Eigen::VectorXcd& points) {
    Eigen::MatrixXcd result(points.size(), static_cast<Eigen::Index>(powers.size()));
    Eigen::ArrayXcd base(points.size());
    for (std::size_t j = 0; j < powers.size(); ++j) {
        const Power& p = powers[j];
        const auto column = static_cast<Eigen::Index>(j);
        const bool follows = j > 0 && powers[j - 1].centre == p.centre && powers[j - 1].scale == p.scale &&
                             std::abs(p.power) == std::abs(powers[j - 1].power) + 1;
        if (!follows) {
            const Eigen::ArrayXcd from = points.array() - p.centre;
            base = p.power > 0 ? Eigen::ArrayXcd(p.scale * from.conjugate() / from.abs2())
                               : Eigen::ArrayXcd(from / p.scale);
            result.col(column) = p.power == 0 ? Eigen::ArrayXcd(Eigen::ArrayXcd::Ones(points.size()))
                                              : Eigen::ArrayXcd(base.pow(std::abs(p.power)));
        } else {
            if (powers[j - 1].power == 0) base = (points.array() - p.centre) / p.scale;
            result.col(column) = result.col(column - 1).array() * base;
        }
    }
    return result;
}

bool LaurentSpace::find(int degree, int dimension) {
    const BoundaryPoints points = boundary_points(domain_, degree, false);
    std::vector<Power> powers = powers_up_to(degree);
    Eigen::MatrixXcd functions, triangle;
    for (bool dependent = true; dependent;) {
        functions = roots_of_weights(points).cast<Complex>().asDiagonal() * values(powers, points.positions());
        const std::vector<char> kept = orthonormalise(functions, triangle);
        std::vector<Power> independent;
        for (std::size_t j = 0; j < powers.size(); ++j)
            if (kept[j]) independent.push_back(powers[j]);
        dependent = independent.size() < powers.size();
        powers = std::move(independent);
    }
    const Eigen::Index n = functions.cols();
    const Eigen::MatrixXd parts = imaginary_parts(functions, points);
    const Eigen::Index shown = std::min<Eigen::Index>(2 * n, dimension + kReported);
    const auto [singular, lowest] = smallest_singular(parts, shown);
    // The widest gap; or, while the last of the wanted functions are not resolved as well as the others, the last one:
    // above it the values lie close together.
    Eigen::Index at_widest = 0, at_last = 0;
    double widest = 0;
    for (Eigen::Index i = 1; i < shown; ++i) {
        const double ratio = singular[i] / std::max(singular[i - 1], kRounding);
        if (ratio > widest) widest = ratio, at_widest = i;
        if (ratio > kLeastGap) at_last = i;
    }

    Eigen::MatrixXcd combinations(n, dimension);
    combinations.real() = lowest.topLeftCorner(n, dimension);
    combinations.imag() = lowest.bottomLeftCorner(n, dimension);
    coefficients_ = triangle.triangularView<Eigen::Upper>().solve(combinations);
    powers_ = std::move(powers);

    const BoundaryPoints between = boundary_points(domain_, degree, true);
    const Eigen::MatrixXcd space =
        roots_of_weights(between).cast<Complex>().asDiagonal() * (values(powers_, between.positions()) * coefficients_);
    const Eigen::MatrixXd residuals = imaginary_parts(space, between).leftCols(dimension);
    Eigen::MatrixXd both(2 * space.rows(), dimension);
    both << space.real(), space.imag();
    const double largest = singular_values(residuals)[0], least = singular_values(both)[dimension - 1];
    fit_.degree = degree;
    fit_.residual = least > 0 ? largest / least : INFINITY;
    fit_.next = singular[dimension];
    fit_.singular_values = singular;
    return (at_widest == dimension || at_last == dimension) && fit_.next > kLeastGap * fit_.residual;
}

Eigen::MatrixXcd LaurentSpace::generators(const ChartPoints& points) const {
    return pulled_back(points, size(), [&](const Eigen::VectorXcd& places) {
        return Eigen::MatrixXcd(values(powers_, places) * coefficients_);
    });
}

}  // namespace beltrami
